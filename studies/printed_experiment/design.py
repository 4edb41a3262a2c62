"""Where in the ranges the arm is tried: one number at a time, spread over all, and at corners."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from lyapcheck._types import Array
from studies.printed_experiment.assumptions import Assumption

LEVELS = 5
"""Values of each number that is changed alone, both ends included."""


@dataclass(frozen=True, eq=False)
class Design:
    """Points of the unit cube, one row each; `values` turns them into numbers of the arm.

    Args:
        nominal: (d,) the arm as it is taken to be.
        alone: (d, LEVELS, d) one number changed from its low end to its high one.
        spread: (N, d) a Latin hypercube: every number meets each of N slices of its range once.
        corners: (K, d) every number at an end of its range.
    """

    nominal: Array
    alone: Array
    spread: Array
    corners: Array

    @property
    def points(self) -> Array:
        """All points, in the order of the fields."""
        alone = self.alone.reshape(-1, self.nominal.size)
        return np.vstack([self.nominal[None], alone, self.spread, self.corners])


def design(assumed: Sequence[Assumption], spread: int, corners: int, seed: int) -> Design:
    """The design for some assumptions; ``spread`` and ``corners`` say how many points."""
    draw = np.random.default_rng(seed)
    nominal = np.array([one.share(one.nominal) for one in assumed])
    size = nominal.size
    alone = np.tile(nominal, (size, LEVELS, 1))
    for i in range(size):
        alone[i, :, i] = np.linspace(0.0, 1.0, LEVELS)
    slices = draw.permuted(np.tile(np.arange(spread), (size, 1)), axis=1).T
    return Design(
        nominal,
        alone,
        (slices + draw.uniform(size=slices.shape)) / max(spread, 1),
        draw.integers(0, 2, size=(corners, size)).astype(np.float64),
    )


def values(assumed: Sequence[Assumption], points: Array) -> Array:
    """Points of the unit cube as numbers of the arm, (R, d)."""
    low, high = (np.array([getattr(one, end) for one in assumed]) for end in ("low", "high"))
    return np.asarray(low + points * (high - low))
