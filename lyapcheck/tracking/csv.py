"""Tracking runs as comma-separated values, full precision, one row a sample."""

from __future__ import annotations

import csv
import io
from collections.abc import Sequence

import numpy as np

from lyapcheck.output.escapes import csv_text
from lyapcheck.tracking.run import TrackingRun

SIGNALS = (
    ("q", "rad"),
    ("qd", "rad"),
    ("e", "rad"),
    ("v", "rad/s"),
    ("vd", "rad/s"),
    ("tau", "N.m"),
)
"""Angles, reference, error, rates, rates of the reference, torques."""


def tracking_csv(runs: Sequence[TrackingRun]) -> str:
    """The samples of runs on one arm, see `SIGNALS`, then V, dV and the bound that dV must not exceed.

    Units are in the header. Every number is the shortest decimal that reads back as the same double. A run
    that was cut short says ``no`` under ``complete``; without a bound its column is empty.
    """
    text = io.StringIO()
    writer = csv.writer(text, lineterminator="\n")
    joints = range(1, len(runs[0].joints) + 1) if runs else range(0)
    per_joint = [f"{signal}{i} [{unit}]" for signal, unit in SIGNALS for i in joints]
    writer.writerow(["gains", "complete", "t [s]", *per_joint, "V [J]", "dV [W]", "bound [W]"])
    for run in runs:
        m = run.motion
        table = np.column_stack((m.t, m.q, m.goal, m.e, m.velocity, m.speed, m.tau, run.V, run.dV))
        complete = "yes" if run.complete else "no"
        bound = [""] * m.t.size if run.bound is None else [repr(x) for x in run.bound.tolist()]
        for row, last in zip(table.tolist(), bound, strict=True):
            writer.writerow([csv_text(run.name), complete, *map(repr, row), last])
    return text.getvalue()
