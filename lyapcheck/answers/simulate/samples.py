"""Runs as comma-separated values, full precision, one row a sample."""

from __future__ import annotations

import csv
import io
from collections.abc import Sequence

import numpy as np

from lyapcheck.output.escapes import csv_text
from lyapcheck.simulate.run import Run

SIGNALS = (("q", "rad"), ("w", "rad/s"), ("e", "rad"), ("tau", "N.m"))


def run_csv(run: Run) -> str:
    """The samples of one run as CSV text, see `runs_csv`."""
    return runs_csv([run])


def runs_csv(runs: Sequence[Run]) -> str:
    """The samples of runs on one arm: gain set, whether its run is complete, t, q, w, e, tau, V, dV.

    Units are in the header. Every number is the shortest decimal that reads back as the same double. A run
    that was cut short says ``no`` under ``complete`` and ends with the last sample it reached.
    """
    text = io.StringIO()
    writer = csv.writer(text, lineterminator="\n")
    joints = range(1, runs[0].q.shape[1] + 1) if runs else range(0)
    per_joint = [f"{signal}{i} [{unit}]" for signal, unit in SIGNALS for i in joints]
    writer.writerow(["gains", "complete", "t [s]", *per_joint, "V [J]", "dV [W]"])
    for run in runs:
        table = np.column_stack((run.t, run.q, run.w, run.e, run.tau, run.V, run.dV))
        complete = "yes" if run.complete else "no"
        writer.writerows([csv_text(run.name), complete, *map(repr, row)] for row in table.tolist())
    return text.getvalue()
