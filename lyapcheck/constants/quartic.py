"""Upper bounds of ‖C(q,x)x‖² = Σ_i (xᵀS_i x)² over unit vectors x: a quartic form as a quadratic one.

With s_i the vector of the entries of S_i and X that of x xᵀ, both scaled so that ‖X‖ = ‖x‖²,

    Σ_i (xᵀS_i x)² = Xᵀ (WᵀW + N) X ≤ λmax(WᵀW + N) ‖x‖⁴,     W = (s_1, …, s_n)ᵀ,

for every N in the span of the relations x_a x_b · x_c x_d = x_a x_c · x_b x_d. Up to three joints the best N
leaves no gap, because nonnegative quartic forms in three variables are sums of squares.

References: hilbert1888darstellung, for three variables.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import lru_cache
from itertools import combinations_with_replacement

import numpy as np
from numpy.typing import NDArray

from lyapcheck._types import Array

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
