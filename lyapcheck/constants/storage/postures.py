"""What the first joints of a chain ask of a bound of k_c at all postures, in doubles.

Their matrix H of `lyapcheck.check.loop.head` is a trigonometric polynomial of their angles: from its values
at nodes it is known at every posture, and so are its control points.
"""

from __future__ import annotations

from collections.abc import Sequence
from fractions import Fraction
from itertools import product

import numpy as np
from flint import arb_mat, fmpq
from numpy.typing import NDArray

from lyapcheck._types import SEED, Array
from lyapcheck.check.loop.control_points import MOST_AROUND, children, control_weights
from lyapcheck.check.loop.head import PARTS, Head, relation, splits
from lyapcheck.check.loop.storage import Hinge

Asked = tuple[float, Array, Array]
"""κ, F and N."""
_SOME, _WORST, _APART = 40, 12, 0.35
"""Postures to begin with, more of them at a time, and how far they are apart, rad."""
_GRID, _NARROWED = 24, 8
"""Points of a circle on which the worst postures are sought, and how often the step around them shrinks."""
_MOST_LEFT, _HALVINGS = 20_000, 24
_BLOCK = 4000
"""Matrices that are held at a time."""


class Postures:
    """The matrix of the first joints.

    Args:
        links: as `Head` takes them.
        joints: K.
    """

    def __init__(self, links: Sequence[Hinge], joints: int) -> None:
        self.joints, self.angles = joints, joints - 1
        pairs = joints * (joints + 1) // 2
        self.size = joints + pairs
        nothing = arb_mat(self.size, self.size)
        head = Head(links, joints, Fraction(0), arb_mat(PARTS, PARTS), nothing)
        self.degree = head.degree
        self._size = 2 * self.degree + 1
        nodes = [fmpq(2 * j, self._size) for j in range(self._size)]
        values = [head.posture(angles) for angles in product(nodes, repeat=self.angles)]
        self._power = np.array([_doubles(power) for power, _ in values])
        self._state = np.array([_doubles(state) for _, state in values])
        ways = splits(joints)
        units = np.eye(len(ways), dtype=np.intp).tolist()
        self.relations = np.array(
            [_doubles(relation([Fraction(c) for c in unit], joints)) for unit in units]
        ).reshape(-1, self.size, self.size)
        squares = [1.0 if a == b else 2.0 for a, b in head.products]
        self._scale = 1 / np.sqrt(np.array([1.0] * joints + squares))
        self.fourth = np.array([2.0 if a == b and c == d else 0.0 for ((a, b), (c, d)), _ in ways])
        """Coefficients of the relations that make of N² the sum of the squares of all products, as ‖x‖⁴."""
        self._triangle = np.tril_indices(self.size)

    def some(self) -> Array:
        """Postures to begin with, (count, K − 1)."""
        return np.random.default_rng(SEED).uniform(-np.pi, np.pi, (_SOME, self.angles))

    def form(self, q: Array, kappa: float, stored: Array) -> Array:
        """H without N at one posture."""
        weights = np.ones(1)
        for angle in q:
            weights = np.multiply.outer(weights, self._weights(angle)).ravel()
        power = np.tensordot(weights, self._power, 1)
        state = np.tensordot(weights, self._state, 1)
        return np.asarray(self._assembled(power[None], state[None], kappa, stored)[0])

    def _assembled(self, power: Array, state: Array, kappa: float, stored: Array) -> Array:
        n, result = self.joints, -np.swapaxes(state, 1, 2) @ stored @ state
        result[:, range(n), range(n)] += kappa
        result[:, :n, n:] -= power
        result[:, n:, :n] -= np.swapaxes(power, 1, 2)
        return np.asarray(result)

    def _at_nodes(self, asked: Asked) -> Array:
        """H, scaled so that κ and N² with `fourth` are the identity, (nodes of each angle, entries)."""
        kappa, stored, relations = asked
        matrices = self._assembled(self._power, self._state, kappa, stored) + relations
        matrices *= self._scale[:, None] * self._scale
        return matrices[:, self._triangle[0], self._triangle[1]].reshape((self._size,) * self.angles + (-1,))

    def worst(self, asked: Asked) -> list[tuple[float, Array]]:
        """Postures apart from each other at which H is not positive, and by how much κ is too small there."""
        table = self._at_nodes(asked)
        found: list[tuple[float, Array]] = []
        circle = 2 * np.pi * np.arange(_GRID) / _GRID
        grid = np.stack(np.meshgrid(*[circle] * self.angles, indexing="ij"), axis=-1).reshape(-1, self.angles)
        least = self._least(table, [self._weights(circle)] * self.angles, np.indices((_GRID,) * self.angles))
        around = np.array(list(product((-1, 0, 1), repeat=self.angles)))
        for place in np.argsort(least, kind="stable")[: 50 * _WORST]:
            q, low = grid[place], least[place]
            if any(np.linalg.norm((q - other + np.pi) % (2 * np.pi) - np.pi) < _APART for _, other in found):
                continue
            for k in range(_NARROWED):
                tried = q + around * (np.pi / _GRID / 1.7**k)
                lows = self._least(
                    table, list(map(self._weights, tried.T)), np.tile(np.arange(len(tried)), (self.angles, 1))
                )
                q, low = tried[np.argmin(lows)], float(lows.min())
            found.append((-low, q))
            if len(found) == _WORST:
                break
        return [(lack, q) for lack, q in found if lack > 0]

    def refined(self, asked: Asked) -> tuple[tuple[int, ...], tuple[int, ...]] | None:
        """Numbers of control points, and angles to halve until all are positive; ``None`` if many are not."""
        table = self._at_nodes(asked)
        bend = np.array([self._bend(table, axis) for axis in range(self.angles)])
        counts = np.maximum(9, np.ceil(_GRID * np.sqrt(bend / bend.max()))).astype(np.intp)
        start = tuple(counts.tolist())
        halvings: list[int] = []
        points = np.indices(counts).reshape(self.angles, -1).T
        for _ in range(_HALVINGS):
            weights = [
                np.array(control_weights(count, self.degree), dtype=np.float64) for count in counts.tolist()
            ]
            left = points[self._least(table, weights, points.T) <= 0]
            if not len(left):
                return start, tuple(halvings)
            if len(left) > _MOST_LEFT:
                return None
            axis = int(np.argmax(bend / counts**2))
            halvings.append(axis)
            counts[axis] *= 2
            if counts[axis] > MOST_AROUND:
                return None
            points = np.array(children(map(tuple, left.tolist()), axis, self.degree, int(counts[axis])))
        return None

    def _least(self, table: Array, weights: Sequence[Array], places: NDArray[np.intp]) -> Array:
        """The least eigenvalues at places of a grid, given the rows of weights of each angle."""
        places = np.asarray(places).reshape(self.angles, -1)
        result = np.empty(places.shape[1])
        first, back = np.unique(places[:-1], axis=1, return_inverse=True)
        order = np.argsort(back.ravel(), kind="stable")
        ends = np.searchsorted(back.ravel()[order], np.arange(first.shape[1] + 1))
        lines: dict[tuple[int, ...], Array] = {(): table}
        for k in range(first.shape[1]):
            key = tuple(first[:, k].tolist())
            for depth in range(1, len(key) + 1):
                if key[:depth] not in lines:
                    lines = {other: value for other, value in lines.items() if other == key[: len(other)]}
                    lines[key[:depth]] = np.tensordot(
                        weights[depth - 1][key[depth - 1]], lines[key[: depth - 1]], 1
                    )
            for start in range(ends[k], ends[k + 1], _BLOCK):
                chosen = order[start : min(start + _BLOCK, ends[k + 1])]
                result[chosen] = self._eigenvalues(weights[-1][places[-1, chosen]] @ lines[key])
        return result

    def _eigenvalues(self, entries: Array) -> Array:
        matrices = np.zeros((len(entries), self.size, self.size))
        matrices[:, self._triangle[0], self._triangle[1]] = entries
        return np.asarray(np.linalg.eigvalsh(matrices, UPLO="L")[:, 0])

    def _weights(self, angles: Array) -> Array:
        """What the nodes count for at angles, (..., nodes)."""
        apart = np.asarray(angles)[..., None] - 2 * np.pi * np.arange(self._size) / self._size
        return np.asarray((1 + 2 * sum(np.cos(k * apart) for k in range(1, self.degree + 1))) / self._size)

    def _bend(self, table: Array, axis: int) -> float:
        """How large second derivatives by an angle are."""
        values = np.fft.rfft(np.moveaxis(table, axis, 0), axis=0)
        squares = np.arange(self.degree + 1) ** 2
        return float(np.linalg.norm(values * squares.reshape(-1, *[1] * (table.ndim - 1))))


def _doubles(matrix: arb_mat) -> Array:
    return np.array([[float(x.mid()) for x in row] for row in matrix.tolist()])
