"""Bounds of eigenvalues and norms of matrices that are known within a radius, over arrays of matrices.

A symmetric matrix with A = V D Vᵀ computed in floating point has its eigenvalues within κ ‖(A V − V D) V⁻¹‖
of those of D (Bauer and Fike); both factors are bounded by what is left of A V − V D and VᵀV − I.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from functools import cached_property, lru_cache
from itertools import combinations_with_replacement, product
from math import sqrt

import numpy as np
from numpy.typing import NDArray

from lyapcheck._types import SEED, Array
from lyapcheck.check.numbers.harmonics import Harmonics, christoffel, derivative, harmonics
from lyapcheck.constants.constant import AffineForms, SupremumTask, Torus
from lyapcheck.robots import trig
from lyapcheck.robots.plant import RobotModel

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

    def __init__(self, model: RobotModel) -> None:
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


# --- k_c = sup ‖C(q,x)y‖ / (‖x‖‖y‖) over boxes of angles, from the Christoffel symbols S_i = (c_ijk)_jk.
#
# C(q,x)y = (xᵀS_i y)_i is symmetric in x and y, so that for a unit vector z the largest zᵀC(q,x)y is the
# spectral radius of Σ_i z_i S_i, reached with x = y its eigenvector: k_c is reached with x = y.
#
# At one q the bound is that of `lyapcheck.constants.spectrum`, for each box with one relation N. As
# λmax(WᵀW + N) is convex in the symbols, it is largest at a corner of their linear part; what the linear part
# leaves adds at most its own ‖C(q,x)y‖, which the two unfoldings of its entries bound:
#
#     ‖C(q,x)y‖² ≤ λmax(Σ_i S_i²)     and     ‖C(q,x)y‖ ≤ ‖(c_i,jk)‖     for ‖x‖ = ‖y‖ = 1.
#
# References: property 2.6 of reyes2019family.

# --- Upper bounds of ‖C(q,x)x‖² = Σ_i (xᵀS_i x)² over unit vectors x: a quartic form as a quadratic one.
#
# With s_i the vector of the entries of S_i and X that of x xᵀ, both scaled so that ‖X‖ = ‖x‖²,
#
#     Σ_i (xᵀS_i x)² = Xᵀ (WᵀW + N) X ≤ λmax(WᵀW + N) ‖x‖⁴,     W = (s_1, …, s_n)ᵀ,
#
# for every N in the span of the relations x_a x_b · x_c x_d = x_a x_c · x_b x_d. Up to three joints the best
# N leaves no gap, because nonnegative quartic forms in three variables are sums of squares.
#
# References: hilbert1888darstellung, for three variables.


Pair = tuple[int, int]
_STEPS, _STEPS_OF_MANY, _MANY = 30, 10, 4
"""Subgradient steps; those of many joints cost more and are needed less."""
_TINY = 1e-300


@dataclass(frozen=True, eq=False)
class Quartic:
    """Pairs of indices, and an orthonormal basis of the relations between their products.

    Args:
        rows: first indices a of the pairs a ≤ b.
        columns: second indices.
        scale: 1 where a = b, else √2.
        relations: symmetric matrices (count, pairs, pairs).
    """

    rows: NDArray[np.intp]
    columns: NDArray[np.intp]
    scale: Array
    relations: Array

    def stack(self, tensor: Array) -> Array:
        """W of the c_ijk, (..., n, pairs)."""
        return np.asarray(tensor[..., self.rows, self.columns] * self.scale)

    def relation(self, square: Array, target: Array) -> Array:
        """For each matrix WᵀW an N with a small λmax(WᵀW + N), by subgradients of a smoothed λmax.

        Args:
            square: WᵀW, (boxes, pairs, pairs).
            target: a lower bound of what λmax can become, (boxes,).
        """
        flat = self.relations.reshape(len(self.relations), len(self.scale) ** 2)
        weights = np.zeros((len(square), len(flat)))
        best, least = weights.copy(), np.full(len(square), np.inf)
        for _ in range(_STEPS if self.rows[-1] + 1 < _MANY else _STEPS_OF_MANY):
            d, v = np.linalg.eigh(square + (weights @ flat).reshape(square.shape))
            better = d[:, -1] < least
            best[better], least[better] = weights[better], d[better, -1]
            gap = np.maximum(d[:, -1] - target, 1e-12 * np.abs(d[:, -1]) + _TINY)
            share = np.exp((d - d[:, -1:]) / gap[:, None])
            share /= share.sum(axis=1, keepdims=True)
            mean = (v * share[:, None]) @ np.swapaxes(v, -1, -2)
            slope = mean.reshape(len(square), -1) @ flat.T
            weights -= (gap / np.maximum(np.sum(slope**2, axis=1), _TINY))[:, None] * slope
        return np.asarray((best @ flat).reshape(square.shape))


@lru_cache(maxsize=16)
def quartic(n: int) -> Quartic:
    """The quartic forms of n variables."""
    pairs = list(combinations_with_replacement(range(n), 2))
    place = {pair: i for i, pair in enumerate(pairs)}
    scale = np.array([1.0 if a == b else np.sqrt(2.0) for a, b in pairs])

    def product(first: Pair, second: Pair) -> Array:
        """The matrix of the product of two pairs as a quadratic form in the scaled pairs."""
        result = np.zeros((len(pairs), len(pairs)))
        i, j = place[first], place[second]
        result[i, j] += 0.5
        result[j, i] += 0.5
        return result / np.outer(scale, scale)

    differences = [
        product(*first) - product(*other)
        for first, *others in map(_splits, combinations_with_replacement(range(n), 4))
        for other in others
    ]
    flat = np.array(differences).reshape(len(differences), len(pairs) ** 2)
    # the differences are independent, so that no column of Q is arbitrary
    relations = np.linalg.qr(flat.T)[0].T.reshape(-1, len(pairs), len(pairs))
    rows, columns = np.array(pairs, dtype=np.intp).T
    return Quartic(rows, columns, scale, relations)


def _splits(four: tuple[int, ...]) -> list[tuple[Pair, Pair]]:
    """The different ways to part four indices in rising order into two pairs in rising order."""
    a, b, c, d = four
    ways = [((a, b), (c, d)), ((a, c), (b, d)), ((a, d), (b, c))]
    return list(dict.fromkeys((min(way), max(way)) for way in ways))


_TURNS = 6
_STARTS = 3


def coriolis_task(arm: ArmHarmonics) -> SupremumTask:
    """k_c as a supremum over the angles."""
    torus = arm.symbols

    def value(entries: Array) -> Array:
        return _pushed(arm.tensor(entries))[0] * (1 - 1e-12) - 2 * arm.n * torus.lost

    def shown(q: Array) -> tuple[float, ...]:
        tensor = arm.tensor(torus.at(q[None]))
        return (*torus.angles_at(q).tolist(), *_pushed(tensor)[1][0].tolist())

    weight = np.ones(len(arm.triples))
    return SupremumTask(
        "k_c", "kg·m²", torus, value, lambda affine: _most(arm, affine), weight, shown=shown, cost=arm.n
    )


def _most(arm: ArmHarmonics, affine: AffineForms) -> Array:
    """What ‖C(q,x)y‖ is at most over boxes of angles, for unit vectors."""
    forms, tensor = quartic(arm.n), arm.tensor(affine.middle)
    relation = forms.relation(_square(forms.stack(tensor)), _pushed(tensor)[0] ** 2)
    corners = forms.stack(arm.tensor(affine.corners()))
    values, distance, _ = eigenvalues(_square(corners) + relation[:, None])
    size = np.sum(corners**2, axis=(-2, -1)) + np.sqrt(np.sum(relation**2, axis=(-2, -1)))[:, None]
    square = values[..., -1] + distance + ROUNDING * arm.n**2 * size
    rest = _unfolded(arm.tensor(affine.radius))
    return np.asarray((np.sqrt(np.max(np.maximum(square, 0.0), axis=1)) + rest) * (1 + 1e-12))


def _square(stack: Array) -> Array:
    return np.asarray(np.swapaxes(stack, -1, -2) @ stack)


def _unfolded(tensor: Array) -> Array:
    """An upper bound of ‖C(q,x)y‖ for unit x and y: the smaller norm of the two unfoldings."""
    n = tensor.shape[-1]
    tall = [t.reshape(-1, n * n, n) for t in (tensor, np.moveaxis(tensor, -3, -1))]
    return np.minimum(*[largest_norm(t, np.zeros_like(t)) for t in tall])


def _pushed(tensor: Array) -> tuple[Array, Array]:
    """For each tensor a large ‖C(q,x)x‖ and its unit vector x: the best of alternating between z and x.

    The starts are the singular vectors of the unfolding, which symmetry can make stationary, and others.
    """
    vectors = np.linalg.eigh(np.einsum("bijk,bijl->bkl", tensor, tensor))[1]
    x = np.swapaxes(vectors, -1, -2)[:, -_STARTS:]
    others = np.random.default_rng(SEED).standard_normal(x.shape[1:])
    x = np.concatenate([x, np.broadcast_to(others, x.shape)], axis=1)
    for _ in range(_TURNS):
        z = np.einsum("bijk,bsj,bsk->bsi", tensor, x, x)
        z /= np.maximum(np.linalg.norm(z, axis=2, keepdims=True), 1e-300)
        values, vectors = np.linalg.eigh(np.einsum("bsi,bijk->bsjk", z, tensor))
        last = np.argmax(np.abs(values), axis=2)
        x = np.take_along_axis(vectors, last[..., None, None], axis=3)[..., 0]
    x = x / np.linalg.norm(x, axis=2, keepdims=True)
    size = np.linalg.norm(np.einsum("bijk,bsj,bsk->bsi", tensor, x, x), axis=2)
    best = np.argmax(size, axis=1)
    rows = np.arange(len(best))
    return np.asarray(size[rows, best]), np.asarray(x[rows, best])
