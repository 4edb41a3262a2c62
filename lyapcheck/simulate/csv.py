"""A run as comma-separated values, full precision, one row a sample."""

from __future__ import annotations

import numpy as np

from lyapcheck.simulate.run import Run


def run_csv(run: Run) -> str:
    """The samples of a run as CSV text: t, then q, w, e, tau of every joint, V and dV, units in the header.

    Every number is the shortest decimal that reads back as the same double. A run that was cut short ends
    with the last sample it reached.
    """
    joints = range(1, run.q.shape[1] + 1)
    signals = ("q", "w", "e", "tau")
    units = ("rad", "rad/s", "rad", "N.m")
    names = [f"{signal}{i} [{unit}]" for signal, unit in zip(signals, units, strict=True) for i in joints]
    header = ",".join(["t [s]", *names, "V [J]", "dV [W]"])
    table = np.column_stack((run.t, run.q, run.w, run.e, run.tau, run.V, run.dV))
    return "\n".join([header, *(",".join(map(repr, row)) for row in table.tolist())]) + "\n"
