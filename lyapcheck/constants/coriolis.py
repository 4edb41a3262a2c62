"""k_c = sup ‖C(q,x)y‖ / (‖x‖‖y‖) over boxes of angles, from the Christoffel symbols S_i = (c_ijk)_jk.

C(q,x)y = (xᵀS_i y)_i is symmetric in x and y, so that for a unit vector z the largest zᵀC(q,x)y is the
spectral radius of Σ_i z_i S_i, reached with x = y its eigenvector: k_c is reached with x = y.

At one q the bound is that of `lyapcheck.constants.coriolis`, for each box with one relation N. As
λmax(WᵀW + N) is convex in the symbols, it is largest at a corner of their linear part; what the linear part
leaves adds at most its own ‖C(q,x)y‖, which the two unfoldings of its entries bound:

    ‖C(q,x)y‖² ≤ λmax(Σ_i S_i²)     and     ‖C(q,x)y‖ ≤ ‖(c_i,jk)‖     for ‖x‖ = ‖y‖ = 1.

References: property 2.6 of reyes2019family.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import lru_cache
from itertools import combinations_with_replacement

import numpy as np
from numpy.typing import NDArray

from lyapcheck._types import SEED, Array
from lyapcheck.constants.constant import AffineForms, SupremumTask
from lyapcheck.constants.spectrum import ROUNDING, ArmHarmonics, eigenvalues, largest_norm

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
