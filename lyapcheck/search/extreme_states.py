"""Where λmin(M), λmax(M) and ‖C(q,x)‖ are extreme, and what each state found there proves.

A search in doubles proposes the state; the bound it gives is a Rayleigh quotient, evaluated in intervals at
that state and at the vectors found with it: for all v, λmin(M) ≤ vᵀMv/vᵀv ≤ λmax(M), and
‖C(q,x)v‖/(‖x‖‖v‖) ≤ k_c.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence

import numpy as np
from numpy.typing import NDArray

from lyapcheck.intervals import Interval, norm
from lyapcheck.intervals.arm import ArmIntervals, coriolis
from lyapcheck.robots.numeric import NumericModel

Array = NDArray[np.float64]

SAMPLES = 4096
SEED = 20190301
_ROUNDS = 60


class ExtremeStates:
    """The search for extreme states of one arm without parameters."""

    def __init__(self, arm: ArmIntervals) -> None:
        self.arm = arm
        self.numeric = NumericModel(arm.model)

    def eigenvalue(self, index: int) -> tuple[Array, Interval]:
        """The angles where an eigenvalue of M is extreme, and vᵀMv/vᵀv there.

        Args:
            index: 0 for the least eigenvalue and −1 for the largest one.
        """
        sign = -1.0 if index == 0 else 1.0

        def merit(x: Array) -> Array:
            return np.asarray(sign * np.linalg.eigvalsh(self.numeric.mass(self._angles(x)))[:, index])

        q = self._angles(climb(len(self.arm.angles), merit)[None])[0]
        v = _points(np.linalg.eigh(self.numeric.mass(q[None])[0])[1][:, index])
        M = self.arm.at(_points(q)).mass()
        square = sum((x * _dot(row, v) for x, row in zip(v, M, strict=True)), Interval.exact(0.0))
        return q, square * _sum_of_squares(v).reciprocal()

    def whirl(self) -> tuple[Array, Interval]:
        """The angles where ‖C(q,x)‖ is largest for unit x, and ‖C(q,x)v‖/(‖x‖‖v‖) there."""
        first = len(self.arm.angles)
        best = climb(first + self.arm.n, self._norms)
        q, direction = self._angles(best[None])[0], best[first:] / np.linalg.norm(best[first:])
        C = self.numeric.coriolis(q[None], direction[None])[0]
        x, v = _points(direction), _points(np.linalg.svd(C)[2][0])
        pushed = [_dot(row, v) for row in coriolis(self.arm.at(_points(q)).symbols(), x)]
        return q, norm(pushed) * (norm(x) * norm(v)).reciprocal()

    def _norms(self, x: Array) -> Array:
        """‖C(q, x)‖ for the unit vector along the last n columns."""
        first = len(self.arm.angles)
        direction = x[:, first:] / np.maximum(np.linalg.norm(x[:, first:], axis=1), 1e-9)[:, None]
        C = self.numeric.coriolis(self._angles(x), direction)
        return np.asarray(np.linalg.norm(C, ord=2, axis=(1, 2)))

    def _angles(self, x: Array) -> Array:
        """All joint angles from the columns that matter."""
        q = np.zeros((len(x), self.arm.n))
        q[:, list(self.arm.angles)] = x[:, : len(self.arm.angles)]
        return q


def climb(columns: int, merit: Callable[[Array], Array]) -> Array:
    """A point of large merit: the best of a sample, improved by random steps that shrink."""
    rng = np.random.default_rng(SEED)
    points = rng.uniform(-np.pi, np.pi, (SAMPLES, columns))
    best = points[np.argmax(merit(points))]
    step = 0.5
    for _ in range(_ROUNDS):
        around = best + step * rng.standard_normal((64, columns))
        around[0] = best
        best = around[np.argmax(merit(around))]
        step *= 0.75
    return np.asarray(best)


def _points(x: Array) -> list[Interval]:
    return [Interval.exact(float(value)) for value in x]


def _dot(row: Sequence[Interval | float], v: list[Interval]) -> Interval:
    return sum((x * entry for entry, x in zip(row, v, strict=True)), Interval.exact(0.0))


def _sum_of_squares(v: list[Interval]) -> Interval:
    return sum((x.square() for x in v), Interval.exact(0.0))
