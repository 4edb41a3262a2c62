"""What an integrator of many runs takes, and what it returns."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from lyapcheck._types import Array

Counts = NDArray[np.int32]

TOO_MANY_STEPS, STEP_TOO_SMALL, OUT_OF_RANGE = 1, 2, 3

FAILURES = (
    "",
    "the steps allowed were not enough",
    "the step became too small",
    "the state left every sensible range",
)
"""What a status means; 0 is a run that reached its end."""


@dataclass(frozen=True, eq=False)
class InitialValueProblems:
    """R runs of (11) on one arm with one family; arrays without gaps.

    Args:
        y0: (R, 2n + 2) q, w, dissipated energy, ∫‖e‖².
        parameters: (R, p) in the order of `Loop`.
        bands: (R, n) rad, of the settling times.
        T: s.
        points: samples at even times from 0 to T, at least 2.
        tolerance: relative error allowed per step; the absolute one is a hundredth of it.
        max_steps: a budget for each run.
    """

    y0: Array
    parameters: Array
    bands: Array
    T: float
    points: int
    tolerance: float
    max_steps: int


@dataclass(frozen=True, eq=False)
class Paths:
    """The samples of many runs: ``y`` (R, points, 2n + 2), NaN from where a run failed."""

    y: Array
    seen: Array
    """(R, 3n + 4) what was seen between samples too, NaN where a run failed.

    The largest |τ_i|, N·m; the largest −sign(e_i(0)) e_i, rad; when each |e_i| came into its band for good,
    s, NaN where it did not; in J the largest rise of V above what it had been, of |V + D − V(0)|, of |V| and
    of the dissipated energy D.
    """
    status: Counts
    """(R,) an index of `FAILURES`."""
    steps: Counts
    """(R,) steps tried."""


def empty_paths(problems: InitialValueProblems) -> Paths:
    """Arrays of the right size, not yet filled."""
    runs, size = problems.y0.shape
    n = size // 2 - 1
    return Paths(
        np.empty((runs, problems.points, size)),
        np.empty((runs, 3 * n + 4)),
        np.empty(runs, np.int32),
        np.empty(runs, np.int32),
    )
