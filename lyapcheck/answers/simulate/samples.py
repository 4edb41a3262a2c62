"""The samples of runs, and the indices of many, as comma-separated values with units in the header."""

from __future__ import annotations

import csv
import io
from collections.abc import Iterable, Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

from lyapcheck.output.escapes import csv_text

if TYPE_CHECKING:
    from lyapcheck.simulate.many import Sweep
    from lyapcheck.simulate.run import Motion

TRACKING = "tracking"
SIGNALS = (("q", "rad", "q"), ("w", "rad/s", "w"), ("e", "rad", "e"), ("tau", "N.m", "tau"))
"""Angles, rates, errors, torques of each joint, by their names in a `Motion`."""
TRACKING_SIGNALS = (
    *(("q", "rad", "q"), ("qd", "rad", "goal"), ("e", "rad", "e")),
    *(("v", "rad/s", "velocity"), ("vd", "rad/s", "speed"), ("tau", "N.m", "tau")),
)
"""Angles, reference, errors, rates, rates of the reference, torques."""


@dataclass(frozen=True, eq=False)
class Quantity:
    """One index of every run.

    Args:
        name: with the joint and the unit.
        values: (R,), NaN where a run has none.
        form: how a number of it is shown.
    """

    name: str
    values: NDArray[np.float64]
    form: str

    @property
    def without(self) -> int:
        """How many runs have no such number."""
        return int(np.count_nonzero(~np.isfinite(self.values)))


def quantities(result: Sweep) -> list[Quantity]:
    """L2, then each index joint by joint."""
    runs = result.runs
    tables = (
        ("settling [s]", runs.settling, "z.3f"),
        ("overshoot [%]", runs.overshoot, "z.2f"),
        ("peak torque [N·m]", runs.peak_torque, "z.2f"),
        ("final error [°]", runs.final_error, "z.4f"),
    )
    return [
        Quantity("L2 [°]", runs.L2, ".4f"),
        *(
            Quantity(f"{joint} {name}", table[:, i], form)
            for name, table, form in tables
            for i, joint in enumerate(result.joints)
        ),
    ]


def runs_csv(runs: Sequence[Motion]) -> str:
    """The samples of runs on one arm: gain set, whether its run is complete, t, q, w, e, tau, V, dV.

    Of tracking runs see `TRACKING_SIGNALS`; then also the bound that dV must not exceed, empty without one.
    Every number is the shortest decimal that reads back as the same double. A run that was cut short says
    ``no`` under ``complete`` and ends with the last sample it reached.
    """
    tracking = any(run.kind == TRACKING for run in runs)
    signals = TRACKING_SIGNALS if tracking else SIGNALS
    n = len(runs[0].joints) if runs else 0
    each = [f"{signal}{i} [{unit}]" for signal, unit, _ in signals for i in range(1, n + 1)]
    head = ["gains", "complete", "t [s]", *each, "V [J]", "dV [W]", *(["bound [W]"] if tracking else [])]
    rows: list[list[str]] = []
    for run in runs:
        table = np.column_stack((run.t, *(getattr(run, name) for *_, name in signals), run.V, run.dV))
        known = getattr(run, "bound", None)
        bound = [""] * run.t.size if known is None else map(repr, known.tolist())
        names = csv_text(run.name), "yes" if run.complete else "no"
        for row, last in zip(table.tolist(), bound, strict=True):
            rows.append([*names, *map(repr, row), *([last] if tracking else [])])
    return _text(head, rows)


def starts_csv(sweeps: Sequence[Sweep]) -> str:
    """One row a run from a random start: its start, whether it is complete, and its indices."""
    if not sweeps:
        return _text(["gains", "run", "complete"], ())
    starts = [f"q{i + 1}(0) [rad]" for i in range(len(sweeps[0].joints))]
    indices = [csv_text(one.name) for one in quantities(sweeps[0])]
    rows: list[list[object]] = []
    for result in sweeps:
        table = np.column_stack((result.q0, *(one.values for one in quantities(result)))).tolist()
        for number, (row, whole) in enumerate(zip(table, result.runs.complete, strict=True), start=1):
            rows.append([csv_text(result.name), number, "yes" if whole else "no", *map(repr, row)])
    return _text(["gains", "run", "complete", *starts, *indices], rows)


def _text(head: Sequence[str], rows: Iterable[Sequence[object]]) -> str:
    text = io.StringIO()
    writer = csv.writer(text, lineterminator="\n")
    writer.writerow(head)
    writer.writerows(rows)
    return text.getvalue()
