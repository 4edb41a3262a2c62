"""The results of many runs, one row a run."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from lyapcheck._types import Array
from lyapcheck.simulate.batch.integrator import FAILURES, Paths
from lyapcheck.simulate.indices import LEAST_STEP
from lyapcheck.simulate.results import LEAST_ENERGY


@dataclass(frozen=True, eq=False)
class Runs:
    """R motions of one arm; rows in the order of the starts, NaN where a run did not reach its end.

    Indices are those of a single `Run`: of the polynomials between the ends of the integrator's steps.
    """

    t: Array
    """(points,) s, of the samples."""
    L2: Array
    """(R,) degrees, (20)."""
    settling: Array
    """(R, n) s, 2 % of the step."""
    overshoot: Array
    """(R, n) per cent of the step."""
    peak_torque: Array
    """(R, n) N·m."""
    final_error: Array
    """(R, n) degrees."""
    energy_balance: Array
    """(R,) the largest |E(t) + dissipated(t) − E(0)| relative to the largest of these; NaN unless ε₀ = 0."""
    V_rise: Array
    """(R,) J, the most V was above what it had been, looked at four times a step; negative if it fell."""
    complete: NDArray[np.bool_]
    """(R,) whether the run reached T."""
    failure: tuple[str, ...]
    """Why it did not; empty if it did."""
    steps: NDArray[np.int32]
    """(R,) steps tried by the integrator."""
    engine: str
    """``compiled``, ``numpy``, or both if families differ in what they can use."""
    q: Array | None = None
    """(R, points, n) rad, where motions were asked for."""
    w: Array | None = None
    """(R, points, n) rad/s, where motions were asked for."""
    V: Array | None = None
    """(R, points) J for the ε₀ given, where motions were asked for."""


@dataclass(frozen=True, eq=False)
class IntegratedRuns:
    """Some of the runs as they come out of the integrator."""

    T: float
    q_d: Array
    """(R, n)"""
    paths: Paths
    energy: bool
    """Whether V is the energy."""

    def rows(self) -> dict[str, Any]:
        """The numbers of these runs by their name in `Runs`."""
        n, y = self.q_d.shape[1], self.paths.y
        torque, beyond, settling, rest = np.split(self.paths.seen, (n, 2 * n, 3 * n), axis=1)
        rise, error, energy, lost = rest.T
        step, squares = np.abs(self.q_d - y[:, 0, :n]), y[:, -1, -1]
        whole = np.where(step > LEAST_STEP, step, np.nan)
        scale = np.maximum(np.maximum(energy, lost), LEAST_ENERGY)
        return {
            "L2": np.degrees(np.sqrt(np.maximum(squares, 0.0) / self.T)),
            "settling": settling,
            "overshoot": 100.0 * beyond / whole,
            "peak_torque": torque,
            "final_error": np.degrees(self.q_d - y[:, -1, :n]),
            "energy_balance": error / scale if self.energy else np.full(len(y), np.nan),
            "V_rise": rise,
            "steps": self.paths.steps,
            "status": self.paths.status,
        }


def runs_of(t: Array, rows: dict[str, Any], engine: str) -> Runs:
    """The results of all runs from their rows."""
    status = rows.pop("status")
    reasons = tuple(FAILURES[code] for code in status)
    return Runs(t=t, complete=status == 0, failure=reasons, engine=engine, **rows)
