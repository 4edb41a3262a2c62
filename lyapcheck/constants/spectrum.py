"""Bounds of eigenvalues and norms of matrices that are known within a radius, over arrays of matrices.

A symmetric matrix with A = V D Vᵀ computed in floating point has its eigenvalues within κ ‖(A V − V D) V⁻¹‖
of those of D (Bauer and Fike); both factors are bounded by what is left of A V − V D and VᵀV − I.
"""

from __future__ import annotations

import numpy as np

from lyapcheck._types import Array

ROUNDING = 1e-13
"""Times n², above the rounding of sums of n products of doubles relative to the norms of the factors."""


def eigenvalues(a: Array) -> tuple[Array, Array, Array]:
    """Eigenvalues in rising order, the distance within which each is certain, and the eigenvectors.

    Args:
        a: symmetric matrices, (..., n, n).

    Soundness: the distance is computed from the residuals, so that a bad decomposition only makes it large.
    """
    n = a.shape[-1]
    d, v = np.linalg.eigh(a)
    residual = _norm(a @ v - v * d[..., None, :])
    skew = _norm(np.swapaxes(v, -1, -2) @ v - np.eye(n)) + ROUNDING * n * n
    size = _norm(a) + np.max(np.abs(d), axis=-1)
    safe = np.minimum(skew, 0.5)
    condition = np.sqrt((1 + safe) / (1 - safe))
    distance = condition / np.sqrt(1 - safe) * (residual + ROUNDING * n * n * size)
    return d, np.where(skew < 0.5, distance, np.inf), v


def largest_eigenvalue(a: Array, radius: Array) -> Array:
    """An upper bound of the largest eigenvalue of every symmetric matrix within ``radius`` of ``a``.

    For any w > 0 the difference E obeys xᵀE x ≤ Σ_i x_i² Σ_j radius_ij w_j/w_i; w follows the eigenvector.
    """
    v = eigenvalues(a)[2][..., -1]
    d, distance, _ = eigenvalues(a + _shift(radius, np.abs(v) + 0.02))
    return np.asarray(d[..., -1] + distance)


def smallest_eigenvalue(a: Array, radius: Array) -> Array:
    """A lower bound of the smallest eigenvalue of every symmetric matrix within ``radius`` of ``a``.

    Heavy joints can bear more uncertainty than light ones: w follows the eigenvector and the diagonal.
    """
    values, _, vectors = eigenvalues(a)
    diagonal = np.maximum(np.diagonal(a, axis1=-2, axis2=-1), 1e-300)
    light = np.sqrt(np.clip(values[..., :1] / diagonal, 1e-12, 1.0))
    d, distance, _ = eigenvalues(a - _shift(radius, np.abs(vectors[..., 0]) + 0.3 * light))
    return np.asarray(d[..., 0] - distance)


def largest_norm(a: Array, radius: Array) -> Array:
    """An upper bound of the spectral norm of every matrix (rows, columns) within ``radius`` of ``a``."""
    gram = np.swapaxes(a, -1, -2) @ a
    d, distance, _ = eigenvalues(gram)
    rounding = ROUNDING * a.shape[-2] * _norm(a) ** 2
    middle = np.sqrt(np.maximum(d[..., -1] + distance + rounding, 0.0))
    around = np.sqrt(np.max(np.sum(radius, axis=-1), axis=-1) * np.max(np.sum(radius, axis=-2), axis=-1))
    return np.asarray((middle + np.minimum(around, _norm(radius))) * (1 + 1e-12))


def _shift(radius: Array, w: Array) -> Array:
    """The diagonal matrix that outweighs every symmetric matrix within the radius."""
    rows = (radius @ w[..., None])[..., 0] / w * (1 + 1e-9)
    return np.asarray(rows[..., None] * np.eye(radius.shape[-1]))


def _norm(a: Array) -> Array:
    """The Frobenius norm, rounded up."""
    return np.asarray(np.sqrt(np.sum(a * a, axis=(-2, -1))) * (1 + 1e-12))
