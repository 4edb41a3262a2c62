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
    from lyapcheck.simulate.run import Run
    from lyapcheck.simulate.starts import Sweep
    from lyapcheck.tracking.run import TrackingRun

SIGNALS = (("q", "rad"), ("w", "rad/s"), ("e", "rad"), ("tau", "N.m"))
"""Angles, rates, errors, torques of each joint."""
TRACKING_SIGNALS = (
    *(("q", "rad"), ("qd", "rad"), ("e", "rad")),
    *(("v", "rad/s"), ("vd", "rad/s"), ("tau", "N.m")),
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


def runs_csv(runs: Sequence[Run]) -> str:
    """The samples of runs on one arm: gain set, whether its run is complete, t, q, w, e, tau, V, dV.

    Every number is the shortest decimal that reads back as the same double. A run that was cut short says
    ``no`` under ``complete`` and ends with the last sample it reached.
    """
    head = _head(runs[0].q.shape[1] if runs else 0, SIGNALS)
    tables = (np.column_stack((run.t, run.q, run.w, run.e, run.tau, run.V, run.dV)) for run in runs)
    rows = zip(runs, tables, strict=True)
    return _text(head, ([*_names(run), *map(repr, row)] for run, table in rows for row in table.tolist()))


def tracking_csv(runs: Sequence[TrackingRun]) -> str:
    """The same of tracking runs, see `TRACKING_SIGNALS`, then V, dV and the bound that dV must not exceed.

    Without a bound its column is empty.
    """
    rows: list[list[object]] = []
    for run in runs:
        m = run.motion
        table = np.column_stack((m.t, m.q, m.goal, m.e, m.velocity, m.speed, m.tau, run.V, run.dV))
        bound = [""] * m.t.size if run.bound is None else [repr(x) for x in run.bound.tolist()]
        rows += [
            [*_names(run), *map(repr, row), last] for row, last in zip(table.tolist(), bound, strict=True)
        ]
    return _text([*_head(len(runs[0].joints) if runs else 0, TRACKING_SIGNALS), "bound [W]"], rows)


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


def _head(n: int, signals: Sequence[tuple[str, str]]) -> list[str]:
    each = [f"{signal}{i} [{unit}]" for signal, unit in signals for i in range(1, n + 1)]
    return ["gains", "complete", "t [s]", *each, "V [J]", "dV [W]"]


def _names(run: Run | TrackingRun) -> tuple[str, str]:
    return csv_text(run.name), "yes" if run.complete else "no"


def _text(head: Sequence[str], rows: Iterable[Sequence[object]]) -> str:
    text = io.StringIO()
    writer = csv.writer(text, lineterminator="\n")
    writer.writerow(head)
    writer.writerows(rows)
    return text.getvalue()
