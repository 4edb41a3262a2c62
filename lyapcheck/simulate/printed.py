"""What the paper measured, to be put beside what the model does; nothing here is used to compute anything."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

from lyapcheck.simulate.task import PAPER_TASK, Gains, gains_for

if TYPE_CHECKING:
    from lyapcheck.control.gains import GainSet
    from lyapcheck.robots import RobotModel
    from lyapcheck.simulate.run import Run

PAPER_ARM = "buap3"


@dataclass(frozen=True)
class PrintedIndices:
    """The printed performance of one controller of the experiment.

    References: ``reyes2019family``, Section 4, Table 2 and Fig. 11.
    """

    m: int | None
    """``None`` for PD."""
    kp: tuple[float, ...]
    """N·m (PD: N·m/°)."""
    kv: tuple[float, ...]
    L2: float
    """degrees, (20)."""
    settling: tuple[float, ...] | None
    """s per joint; the band is not printed. For m = 1 the paper says only: below 1.4 s."""
    final_error: tuple[float, ...]
    """degrees."""


PRINTED = (
    PrintedIndices(1, (28, 60, 5), (0.233,) * 3, 25.4006, None, (-0.5774, 0.1272, -0.051)),
    PrintedIndices(2, (27, 50, 5), (0.223,) * 3, 24.6892, (0.994, 0.997, 0.929), (-0.1849, 0.4876, 0.1867)),
    PrintedIndices(3, (25, 50, 5), (0.223,) * 3, 23.4006, (0.892, 0.923, 0.867), (-0.3717, 0.3009, 0.2024)),
    PrintedIndices(
        None, (0.8, 2.5, 0.133), (0.4, 0.75, 0.01), 27.8546, (1.14, 0.959, 0.952), (-0.2566, -0.7238, -0.8646)
    ),
)


def printed_for(run: Run) -> PrintedIndices | None:
    """The printed numbers of the same gains, arm and task; none for anything the paper did not run."""
    if run.robot != PAPER_ARM or run.task != PAPER_TASK:
        return None
    return next((entry for entry in PRINTED if _same(entry, run.gains)), None)


def printed_entry(gain_set: GainSet, model: RobotModel) -> PrintedIndices | None:
    """What the paper prints of these gains on this arm; none for anything it did not run."""
    if model.name != PAPER_ARM:
        return None
    gains = gains_for(gain_set, model.n)
    return next((entry for entry in PRINTED if _same(entry, gains)), None)


def _same(entry: PrintedIndices, gains: Gains) -> bool:
    family = "linear" if entry.m is None else "hyperbolic"
    member = (gains.family.name, gains.family.m)
    return member == (family, entry.m) and gains.written == (entry.kp, entry.kv)
