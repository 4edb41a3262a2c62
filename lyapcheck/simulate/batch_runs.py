"""The results of many runs, one row a run."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from lyapcheck._types import Array
from lyapcheck.simulate.batch_paths import FAILURES, Paths
from lyapcheck.simulate.indices import LEAST_STEP, SETTLING_BAND
from lyapcheck.simulate.results import LEAST_ENERGY


@dataclass(frozen=True, eq=False)
class Runs:
    """R motions of one arm; rows in the order of the starts, NaN where a run did not reach its end.

    Indices are those of a single `Run`, at the samples ``t``.
    """

    t: Array
    """(points,) s."""
    L2: Array
    """(R,) degrees, (20)."""
    settling: Array
    """(R, n) s, 2 % of the step."""
    overshoot: Array
    """(R, n) per cent of the step."""
    peak_torque: Array
    """(R, n) N·m, between samples too: see `tops`."""
    final_error: Array
    """(R, n) degrees."""
    energy_balance: Array
    """(R,) the largest |E(t) + dissipated(t) − E(0)| relative to the largest of these; NaN unless ε₀ = 0."""
    V_rise: Array
    """(R,) J, the largest rise of V between two samples; negative if V always fell."""
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
class Part:
    """Some of the runs as they come out of the integrator."""

    t: Array
    q_d: Array
    """(R, n)"""
    paths: Paths
    signals: Array
    """(R, points, n + 1) torques and V."""
    energy: bool
    """Whether V is the energy."""

    @property
    def n(self) -> int:
        """Joints."""
        return int(self.q_d.shape[1])

    @property
    def q(self) -> Array:
        """(R, points, n) rad."""
        return self.paths.y[:, :, : self.n]

    @property
    def w(self) -> Array:
        """(R, points, n) rad/s."""
        return self.paths.y[:, :, self.n : 2 * self.n]

    @property
    def V(self) -> Array:
        """(R, points) J."""
        return self.signals[:, :, self.n]

    def rows(self, motions: bool) -> dict[str, Any]:
        """The numbers of these runs by their name in `Runs`."""
        e = self.q_d[:, None, :] - self.q
        squares = self.paths.y[:, -1, -1]
        columns = {
            "L2": np.degrees(np.sqrt(np.maximum(squares, 0.0) / self.t[-1])),
            "settling": settling_times(self.t, e),
            "overshoot": overshoots(e),
            "peak_torque": tops(np.abs(self.signals[:, :, : self.n])),
            "final_error": np.degrees(e[:, -1]),
            "energy_balance": self._imbalance(),
            "V_rise": np.max(np.diff(self.V, axis=1), axis=1),
            "steps": self.paths.steps,
            "status": self.paths.status,
        }
        return columns | ({"q": self.q, "w": self.w, "V": self.V} if motions else {})

    def _imbalance(self) -> Array:
        if not self.energy:
            return np.full(len(self.q), np.nan)
        lost = self.paths.y[:, :, -2]
        scale = np.maximum(np.max(np.abs(self.V), axis=1), np.max(np.abs(lost), axis=1))
        error = np.max(np.abs(self.V + lost - self.V[:, :1]), axis=1)
        return np.asarray(error / np.maximum(scale, LEAST_ENERGY))


def settling_times(t: Array, e: Array, band: float = SETTLING_BAND) -> Array:
    """`indices.settling_times` of many runs: (R, n) s from errors (R, points, n) in rad."""
    size, start = np.abs(e), np.abs(e[:, 0])
    width = band * np.where(start > LEAST_STEP, start, start.max(axis=1, keepdims=True))
    outside = size > width[:, None]
    last = t.size - 1 - np.argmax(outside[:, ::-1], axis=1)
    before = np.minimum(last, t.size - 2)
    a, b = (np.take_along_axis(size, (before + k)[:, None], axis=1)[:, 0] for k in (0, 1))
    fall = np.where(a > b, a - b, 1.0)
    crossing = t[before] + (a - width) / fall * (t[before + 1] - t[before])
    settled = np.where(outside.any(axis=1), np.where(last == t.size - 1, np.nan, crossing), t[0])
    return np.asarray(np.where(np.isnan(e[:, -1]), np.nan, settled))


def overshoots(e: Array) -> Array:
    """`indices.overshoots` of many runs: (R, n) per cent from errors (R, points, n) in rad."""
    start = e[:, 0]
    beyond = np.maximum(tops(-np.sign(start)[:, None] * e), 0.0)
    size = np.abs(start)
    return np.asarray(
        100.0 * np.divide(beyond, size, out=np.full_like(size, np.nan), where=size > LEAST_STEP)
    )


def tops(values: Array) -> Array:
    """(R, n) the largest of (R, points, n) smooth values, between samples too.

    It is the vertex of the parabola through the largest sample and its neighbours: of third order in the
    distance of samples, and never below the largest sample.
    """
    middle = np.clip(np.argmax(values, axis=1), 1, values.shape[1] - 2)
    before, top, after = (np.take_along_axis(values, (middle + k)[:, None], axis=1)[:, 0] for k in (-1, 0, 1))
    bend, slope = before - 2 * top + after, (after - before) / 2
    inside = (bend < 0) & (np.abs(slope) <= -bend)
    vertex = top - slope**2 / (2 * np.where(inside, bend, -1.0))
    return np.asarray(np.maximum(np.max(values, axis=1), np.where(inside, vertex, -np.inf)))


def runs_of(t: Array, rows: dict[str, Any], engine: str) -> Runs:
    """The results of all runs from their rows."""
    status = rows.pop("status")
    reasons = tuple(FAILURES[code] for code in status)
    return Runs(t=t, complete=status == 0, failure=reasons, engine=engine, **rows)
