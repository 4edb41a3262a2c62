"""What the first joints of a chain, or all of an arm, ask of a bound of k_c at all postures, in doubles.

Their matrix H of `lyapcheck.check.loop.head` or ``symbols`` is a trigonometric polynomial of their angles:
from its values at nodes it is known at every posture, and so are its control points. N is fitted to analytic
centres of many postures, which depend smoothly on the angles, and closest where there is least to spare.
"""

from __future__ import annotations

from collections.abc import Sequence
from fractions import Fraction
from itertools import combinations_with_replacement, product
from operator import itemgetter

import numpy as np
from flint import arb_mat
from numpy.typing import NDArray

from lyapcheck._types import SEED, Array
from lyapcheck.check.loop.control_points import MOST_AROUND, MOST_HALVINGS, children, control_weights
from lyapcheck.check.loop.head import relation, splits
from lyapcheck.constants.storage.centres import centres

_SOME, _WORST, _APART = 60, 20, 0.5
"""Postures to begin with, more of them at a time, and how far they are apart, rad."""
_GRID, _NARROWED = {1: 24, 2: 24, 3: 24, 4: 12}, 8
"""Points of a circle on which the worst postures are sought, by the number of angles, and how often the step
around them shrinks."""
_SAMPLES, _FITTED = {1: 48, 2: 24, 3: 10, 4: 4}, {4: 1}
"""Points of a circle at which relations are chosen, likewise, and their degree, if below that of H."""
_WIDTH, _SHARP = 0.003, 1e-4
"""Widths of centres relative to κ: of those relations, and where the least κ of a posture is sought."""
_MOST_LEFT = 20_000
_BITS = 14
"""To which relations are rounded, relative to κ."""
_BLOCK = 4000
"""Matrices that are held at a time."""


class Postures:
    """The matrix H of some joints, in products √2 x_i x_j, i < j: so κ and κN² with some N add κ to it.

    Args:
        values: C_v and R of H, at each of the nodes of the angles that enter.
        degree: of both and of H in each of these angles, at most.
        angles: how many enter.
    """

    def __init__(self, values: Sequence[tuple[arb_mat, arb_mat]], degree: int, angles: int) -> None:
        self.degree, self.angles, self._nodes = degree, angles, 2 * degree + 1
        self.joints, self.size = values[0][0].nrows(), values[0][1].ncols()
        joints = self.joints
        squares = [1.0 if a == b else 2.0 for a, b in combinations_with_replacement(range(joints), 2)]
        self._scale = 1 / np.sqrt(np.array([1.0] * joints + squares))
        self._power = np.array([_doubles(power) for power, _ in values]) * self._scale[joints:]
        self._state = np.array([_doubles(state) for _, state in values]) * self._scale
        ways = splits(joints)
        units = np.eye(len(ways), dtype=np.intp).tolist()
        self.relations = np.array(
            [_doubles(relation([Fraction(c) for c in unit], joints)) for unit in units]
        ).reshape(-1, self.size, self.size)
        self.relations *= self._scale[:, None] * self._scale
        self.fourth = np.array([2.0 if a == b and c == d else 0.0 for ((a, b), (c, d)), _ in ways])
        """Coefficients of the N that makes of N² the sum of the squares of all products, as ‖x‖⁴."""
        self._triangle = np.tril_indices(self.size)

    def some(self) -> Array:
        """Postures to begin with, (count, angles)."""
        return np.random.default_rng(SEED).uniform(-np.pi, np.pi, (_SOME, self.angles))

    def parts(self, q: Array, forms: Array) -> tuple[Array, Array, Array]:
        """H without N at one posture: what there is with κ = 0 and F = 0, what κ adds, and what each F."""
        weights = self._at(q)
        power = np.tensordot(weights, self._power, 1)
        state = np.tensordot(weights, self._state, 1)
        nothing = np.zeros((state.shape[-2],) * 2)
        constant = self._assembled(power, state, 0.0, nothing)
        price = self._assembled(power, state, 1.0, nothing) - constant
        return constant, price, self._assembled(power, state, 0.0, forms) - constant

    def _assembled(self, power: Array, state: Array, kappa: float, forms: Array) -> Array:
        n, result = self.joints, -np.swapaxes(state, -1, -2) @ forms @ state
        result[..., range(n), range(n)] += kappa
        result[..., :n, n:] -= power
        result[..., n:, :n] -= np.swapaxes(power, -1, -2)
        return np.asarray(result)

    def at_nodes(self, kappa: float, form: Array, relations: Array | None = None) -> Array:
        """H, with an N or without, (nodes, size, size)."""
        matrices = self._assembled(self._power, self._state, kappa, form)
        return matrices if relations is None else matrices + np.tensordot(relations, self.relations, 1)

    def fitted(self, kappa: float, form: Array, others: Sequence[Array]) -> Array:
        """Coefficients of an N at each node, (nodes, ways), so that H is as positive as can be everywhere.

        Centres of many postures, and of some others, are fitted, the closer the less there is to spare.
        """
        count = _SAMPLES[self.angles]
        circle = 2 * np.pi * (np.arange(count) + 0.5) / count
        postures = np.array([*product(circle, repeat=self.angles), *others])
        matrices = np.tensordot(self._at(postures), self.at_nodes(kappa, form), 1)
        degree = _FITTED.get(self.angles, self.degree)
        weights = self._at(postures, degree)
        chosen = centres(matrices, self.relations, _WIDTH * kappa)
        slack = np.linalg.eigvalsh(matrices + np.tensordot(chosen, self.relations, 1))[:, 0]
        tight = weights / (np.maximum(slack, 0) + _WIDTH * kappa)[:, None] ** 2
        normal = weights.T @ tight
        normal += 1e-9 * np.trace(normal) / len(normal) * np.eye(len(normal))
        fitted = np.linalg.solve(normal, tight.T @ chosen)
        whole = 2 * np.pi * np.arange(self._nodes) / self._nodes
        return self._at(np.array([*product(whole, repeat=self.angles)]), degree) @ fitted

    def shown(self, kappa: float, form: Array) -> tuple[Array, tuple[int, ...], tuple[int, ...]] | None:
        """Relations at nodes with which control points show κ, and these; ``None`` where none are found."""
        relations = self.short(kappa, self.fitted(kappa, form, ()))
        if self.lack(kappa, form, relations) > 0:
            return None
        points = self.refined(self.at_nodes(kappa, form, relations))
        return None if points is None else (relations, *points)

    def short(self, kappa: float, relations: Array) -> Array:
        """The coefficients of N with fewer digits."""
        step = 2.0 ** (np.ceil(np.log2(kappa)) - _BITS)
        return np.asarray(np.round(relations / step) * step)

    def lack(self, kappa: float, form: Array, relations: Array) -> float:
        """By how much κ is too small with relations at nodes."""
        return max(0.0, -self._lowest(self._table(self.at_nodes(kappa, form, relations)))[0][0])

    def _table(self, matrices: Array) -> Array:
        """The entries of matrices at the nodes, (nodes of each angle, entries)."""
        entries = matrices[:, self._triangle[0], self._triangle[1]]
        return np.asarray(entries.reshape((self._nodes,) * self.angles + (-1,)))

    def worst(self, kappa: float, form: Array, seen: Sequence[Array]) -> list[tuple[float, Array]]:
        """Postures apart from each other for which no N is found, and by how much κ is too small there."""
        table = self._table(self.at_nodes(kappa, form, self.fitted(kappa, form, seen)))
        postures = [q for _, q in self._lowest(table)]
        found = []
        for q in postures:
            constant, price, stored = self.parts(q, form)
            found.append(constant + kappa * price + stored)
        there = np.array(found)
        there += np.tensordot(centres(there, self.relations, _SHARP * kappa), self.relations, 1)
        lacks = -np.linalg.eigvalsh(there)[:, 0]
        return [(float(lack), q) for lack, q in zip(lacks, postures, strict=True) if lack > 0]

    def _lowest(self, table: Array) -> list[tuple[float, Array]]:
        """Postures apart from each other at which the least eigenvalue is low, and these."""
        count = _GRID[self.angles]
        circle = 2 * np.pi * np.arange(count) / count
        grid = np.stack(np.meshgrid(*[circle] * self.angles, indexing="ij"), axis=-1).reshape(-1, self.angles)
        least = self._least(table, [self._weights(circle)] * self.angles, np.indices((count,) * self.angles))
        around = np.array(list(product((-1, 0, 1), repeat=self.angles)))
        entries = table.reshape(-1, table.shape[-1])
        found: list[tuple[float, Array]] = []
        for place in np.argsort(least, kind="stable")[: 50 * _WORST]:
            q, low = grid[place], float(least[place])
            if any(np.linalg.norm((q - other + np.pi) % (2 * np.pi) - np.pi) < _APART for _, other in found):
                continue
            for k in range(_NARROWED):
                tried = q + around * (np.pi / count / 1.7**k)
                lows = self._eigenvalues(self._at(tried) @ entries)
                q, low = tried[np.argmin(lows)], float(lows.min())
            found.append((low, q))
            if len(found) == _WORST:
                break
        return sorted(found, key=itemgetter(0))

    def refined(self, matrices: Array) -> tuple[tuple[int, ...], tuple[int, ...]] | None:
        """Numbers of control points, and angles to halve until all are positive; ``None`` if many are not.

        Args:
            matrices: H at the nodes.
        """
        table = self._table(matrices)
        bend = np.array([self._bend(table, axis) for axis in range(self.angles)])
        counts = np.maximum(
            self._nodes, np.ceil(_GRID[self.angles] * np.sqrt(bend / (bend.max() or 1.0)))
        ).astype(np.intp)
        start = tuple(counts.tolist())
        halvings: list[int] = []
        points = np.indices(counts).reshape(self.angles, -1).T
        for _ in range(MOST_HALVINGS):
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

    def _at(self, q: Array, degree: int | None = None) -> Array:
        """What all nodes count for at postures, (..., nodes)."""
        result = np.ones((*q.shape[:-1], 1))
        for angle in np.moveaxis(q, -1, 0):
            result = (result[..., None] * self._weights(angle, degree)[..., None, :]).reshape(
                *q.shape[:-1], -1
            )
        return result

    def _weights(self, angles: Array, degree: int | None = None) -> Array:
        """What the nodes of one angle count for at angles, (..., nodes); of H, or for another degree."""
        degree = self.degree if degree is None else degree
        size = 2 * degree + 1
        apart = np.asarray(angles)[..., None] - 2 * np.pi * np.arange(size) / size
        return np.asarray((1 + 2 * sum(np.cos(k * apart) for k in range(1, degree + 1))) / size)

    def _bend(self, table: Array, axis: int) -> float:
        """How large second derivatives by an angle are."""
        values = np.fft.rfft(np.moveaxis(table, axis, 0), axis=0)
        squares = np.arange(self.degree + 1) ** 2
        return float(np.linalg.norm(values * squares.reshape(-1, *[1] * (table.ndim - 1))))


def exact_rows(relations: Array) -> tuple[tuple[Fraction, ...], ...]:
    """The coefficients of N at each node as the rational numbers that doubles are."""
    return tuple(tuple(map(Fraction, row)) for row in relations.tolist())


def _doubles(matrix: arb_mat) -> Array:
    return np.array([[float(x.mid()) for x in row] for row in matrix.tolist()])
