"""Bounds of eigenvalues and norms of matrices that are known within a radius, over arrays of matrices.

A symmetric matrix with A = V D Vᵀ computed in floating point has its eigenvalues within κ ‖(A V − V D) V⁻¹‖
of those of D (Bauer and Fike); both factors are bounded by what is left of A V − V D and VᵀV − I.
"""

from __future__ import annotations

from collections.abc import Sequence
from functools import cached_property
from itertools import product
from math import sqrt

import numpy as np

from lyapcheck._types import Array
from lyapcheck.check.numbers.harmonics import Harmonics, christoffel, derivative, harmonics
from lyapcheck.constants.constant import AffineForms, SupremumTask, Torus
from lyapcheck.robots import trig
from lyapcheck.robots.plant import Plant

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
    return np.asarray(np.sqrt(np.sum(a * a, axis=(-2, -1))) * (1 + 1e-12))


# --- The inertia matrix, gravity and Christoffel symbols of an arm over boxes of angles.


class ArmHarmonics:
    """The polynomials of an arm, its parameters at nominal values, ready for boxes."""

    def __init__(self, model: Plant) -> None:
        self.n = n = model.n
        fixed = model.fixed()
        self.places = [(i, j) for i in range(n) for j in range(i + 1)]
        self.harmonics: dict[tuple[int, int], Harmonics] = {
            (i, j): harmonics(trig.to_terms(fixed.mass[i][j]), n) for i, j in self.places
        }
        potential = harmonics(trig.to_terms(fixed.potential), n)
        self.gravity = [derivative(potential, i) for i in range(n)]
        self.mass = Torus([self.harmonics[place] for place in self.places], n)

    @cached_property
    def triples(self) -> list[tuple[int, int, int]]:
        """The i, j, k with k ≤ j of the Christoffel symbols, in the order of ``symbols``."""
        return [(i, j, k) for i, j, k in product(range(self.n), repeat=3) if k <= j]

    @cached_property
    def symbols(self) -> Torus:
        """The Christoffel symbols c_ijk = c_ikj with k ≤ j."""
        joints = range(self.n)
        known = christoffel([[self.harmonics[max(i, j), min(i, j)] for j in joints] for i in joints])
        return Torus([known.get(place, {}) for place in self.triples], self.n)

    def matrix(self, entries: Array) -> Array:
        """The symmetric matrices of the entries on and below the diagonal."""
        result = np.empty((*entries.shape[:-1], self.n, self.n))
        for column, (i, j) in enumerate(self.places):
            result[..., i, j] = result[..., j, i] = entries[..., column]
        return result

    def tensor(self, entries: Array) -> Array:
        """The c_ijk of the symbols with k ≤ j, (..., n, n, n)."""
        result = np.empty((*entries.shape[:-1], self.n, self.n, self.n))
        for column, (i, j, k) in enumerate(self.triples):
            result[..., i, j, k] = result[..., i, k, j] = entries[..., column]
        return result


# --- The extreme eigenvalues of M(q) over boxes of angles.
#
# References: properties 2.1 and 2.2 of reyes2019family.


def lambda_max_task(arm: ArmHarmonics) -> SupremumTask:
    """β_M = sup λmax(M(q)), which is convex in M."""

    def value(entries: Array) -> Array:
        values, distance, _ = eigenvalues(arm.matrix(entries))
        return np.asarray(values[:, -1] - distance - arm.mass.lost)

    def most(affine: AffineForms) -> Array:
        high = largest_eigenvalue(arm.matrix(affine.corners()), arm.matrix(affine.radius)[:, None])
        return np.asarray(np.max(high, axis=1))

    return SupremumTask("lambda_max", "kg·m²", arm.mass, value, most, np.ones(len(arm.places)))


def lambda_min_task(arm: ArmHarmonics) -> SupremumTask:
    """inf λmin(M(q)), which is concave in M; entries of light joints matter most for the splits."""
    size = arm.matrix(arm.mass.slack[None])[0].diagonal()
    weight = np.array([1 / sqrt(size[i] * size[j]) if size[i] * size[j] > 0 else 1.0 for i, j in arm.places])

    def value(entries: Array) -> Array:
        values, distance, _ = eigenvalues(arm.matrix(entries))
        return np.asarray(-values[:, 0] - distance - arm.mass.lost)

    def most(affine: AffineForms) -> Array:
        low = smallest_eigenvalue(arm.matrix(affine.corners()), arm.matrix(affine.radius)[:, None])
        return np.asarray(-np.min(low, axis=1))

    return SupremumTask("lambda_min", "kg·m²", arm.mass, value, most, weight, sign=-1)


# --- The length of g(q), or of some of its components, over boxes of angles.
#
# References: property 2.8 of reyes2019family.


def gravity_task(arm: ArmHarmonics, name: str, joints: Sequence[int]) -> SupremumTask:
    """sup (Σ g_i(q)²)^½ over some joints, counted from 0."""
    torus = Torus([arm.gravity[i] for i in joints], arm.n)

    def value(entries: Array) -> Array:
        return np.asarray(np.sqrt(np.sum(entries**2, axis=1)) * (1 - 1e-14) - torus.lost)

    def most(affine: AffineForms) -> Array:
        squares = (np.abs(affine.corners()) + affine.radius[:, None]) ** 2
        return np.asarray(np.max(np.sqrt(np.sum(squares, axis=2)), axis=1) * (1 + 1e-14))

    return SupremumTask(name, "N·m", torus, value, most, np.ones(len(joints)))
