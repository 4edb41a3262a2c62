"""How much of a spread each assumption accounts for."""

from __future__ import annotations

import numpy as np

from lyapcheck._types import Array

BINS = 8
"""Slices of a range whose means are compared."""


def shares(points: Array, y: Array) -> Array | None:
    """(d,) the share of the variance of y that each coordinate accounts for by itself.

    With η² the variance of the means of y over `BINS` equal slices of a coordinate, divided by that of y:
    1 − (1 − η²)(N − 1)/(N − BINS), which is 0 on average where the coordinate has no effect, and is cut at 0.
    What the shares leave of 1 is due to coordinates acting together.

    Args:
        points: (N, d) in the unit cube, every slice equally full, as in a Latin hypercube.
        y: (N,) finite.

    Returns:
        None where nothing can be said: y is constant, or there are no more points than slices.

    References: the correlation ratio of Pearson with Kelley's correction; first-order index of Sobol.
    """
    count, scatter = len(y), float(np.sum((y - y.mean()) ** 2))
    if count <= BINS or scatter <= 1e-18 * max(1.0, float(np.sum(y * y))):
        return None
    explained = np.array([_between(points[:, i], y) for i in range(points.shape[1])]) / scatter
    return np.maximum(0.0, 1.0 - (1.0 - explained) * (count - 1) / (count - BINS))


def _between(x: Array, y: Array) -> float:
    """Σ over slices of size · (mean − mean of all)²."""
    slices = np.minimum((x * BINS).astype(np.intp), BINS - 1)
    sizes = np.bincount(slices, minlength=BINS)
    sums = np.bincount(slices, weights=y, minlength=BINS)
    return float(np.sum(np.square(sums - sizes * y.mean()) / np.maximum(sizes, 1)))
