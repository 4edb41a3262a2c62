"""The numbers that the paper prints of one controller's experiment, one by one."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from lyapcheck._types import Array
from lyapcheck.simulate.printed import PrintedIndices
from lyapcheck.simulate.task import Gains

if TYPE_CHECKING:
    from studies.printed_experiment.bench_runs import Outcomes


START_TORQUES: dict[int | None, tuple[str, tuple[float | None, ...]]] = {
    1: ("Fig. 4", (30.82, 78.69, 9.17)),
    2: ("Fig. 6", (None, 126.33, 10.12)),
    3: ("Fig. 8", (None, 122.16, None)),
    None: ("Fig. 10", (40.0, 120.0, 12.0)),
}
"""N·m at t = 0 as the figures print them; ``None`` is PD, or a joint without a number."""

SETTLED_BELOW = 1.4
"""s: all that is said about settling for m = 1."""


@dataclass(frozen=True)
class PrintedNumber:
    """One printed number and where `Outcomes` has it.

    Args:
        quantity: ``L2``, ``settling``, ``final_error`` or ``start_torque``.
        joint: index of the joint; none for the L2 index.
        value: as printed, in the unit.
        unit: °, s or N·m.
        at_most: the paper says only that the number is below ``value``.
        source: where it is printed.
    """

    quantity: str
    joint: int | None
    value: float
    unit: str
    at_most: bool
    source: str

    def column(self, outcomes: Outcomes) -> Array:
        """(R,) the same number of each run."""
        result: Array = getattr(outcomes, self.quantity)
        return result if self.joint is None else result[:, self.joint]


def printed_numbers(entry: PrintedIndices) -> tuple[PrintedNumber, ...]:
    """All of them: the index, settling times, errors in steady state, torques at t = 0."""
    settling = entry.settling or (SETTLED_BELOW,) * len(entry.kp)
    figure, torques = START_TORQUES[entry.m]
    return (
        PrintedNumber("L2", None, entry.L2, "°", False, "Section 4, Fig. 11"),
        *_joints("settling", settling, "s", "Section 4", entry.settling is None),
        *_joints("final_error", entry.final_error, "°", "Section 4"),
        *_joints("start_torque", torques, "N·m", figure),
    )


def _joints(
    quantity: str, values: Sequence[float | None], unit: str, source: str, at_most: bool = False
) -> Iterator[PrintedNumber]:
    for joint, value in enumerate(values):
        if value is not None:
            yield PrintedNumber(quantity, joint, value, unit, at_most, source)


def figure_gains(entry: PrintedIndices, gains: Gains, e: Sequence[float]) -> tuple[float, ...]:
    """k_pi (per rad where h is linear) with which the figure's torques start; Table 2's where none is given.

    τ_i(0) = k_pi h(e_i(0)) at rest at home, where gravity asks for nothing.

    Args:
        entry: what is printed.
        gains: the gains of Table 2.
        e: (n,) initial errors in rad.
    """
    response = gains.family.h(np.asarray(e))
    rows = zip(START_TORQUES[entry.m][1], response, gains.kp, strict=True)
    return tuple(kp if torque is None else torque / float(h) for torque, h, kp in rows)
