"""The largest norm of a matrix of trigonometric polynomials, from points and bounds of second derivatives.

Let p(q) = zᵀ W(q) X for unit z, x and the products X of x. Linear interpolation between the corners of a box
with half widths r leaves at most ½ Σ_k r_k² sup |∂²p/∂q_k²|, and no mixed derivatives. So

    sup ‖W X‖ ≤ max over the corners of ‖W L‖ + ½ Σ_k r_k² b_k,     b_k ≥ sup ‖(∂²W/∂q_k²) X‖,

and each corner may have its own L of `lyapcheck.constants.products`. The first three angles are parted into
cells; of the others every corner sees a whole grid, as fine as the cells need.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass, field
from itertools import product

import numpy as np
from numpy.typing import NDArray

from lyapcheck._types import Array
from lyapcheck.constants.circles import Circles
from lyapcheck.constants.products import common_factor

FIRST = 3
"""Angles that are parted into cells."""
_PARTS = 4
"""Cells of a circle to begin with."""
_LARGE = 0.8
"""Share of the target from which what interpolation leaves is not worth a look at the corners."""
_TIGHT = 0.35
"""Share of the way from the target to what is reached: norms that come closer to the target call for an L."""
_LOOSE = 0.95
"""Share of what is reached from which other L are tried."""
_ALIKE = 150
"""Postures that share one more L."""
_TRIES = 4
"""More L at one width of the cells."""


@dataclass(frozen=True, eq=False)
class Postures:
    """The matrices W of an arm at any posture, and the L with which a search begins.

    Args:
        stacks: from angles (count, n), rad, to W (count, n, pairs).
        factor: L, (pairs, pairs).
        n: number of joints.
    """

    stacks: Callable[[Array], Array]
    factor: Array
    n: int


@dataclass(eq=False)
class Lattice:
    """A search for cells where the norm could exceed a target.

    Args:
        entries: W L of one L for all postures.
        bend: b_k of the angles of ``entries``.
        target: what is to be shown.
        inside: a norm that is reached.
        postures: with them other L are tried; without, the search ends at a norm above the target.
        points: looked at so far.
        factors: the other L, each times the inverse of the first one.
    """

    entries: Circles
    bend: Array
    target: float
    inside: float
    postures: Postures | None = None
    points: int = 0
    factors: list[Array] = field(default_factory=list, init=False)

    def bound(self, most_points: int) -> float:
        """An upper bound of the norm over all angles: the target if it is shown, else what is.

        Args:
            most_points: after so many points a larger bound has to do.

        Soundness: let the norm be λ times the target, λ > 1; then ``bend`` need only hold up to λ as well.
            In the cell where the norm is reached it is at most corner + λ · rest. Where corner + rest is at
            most the target that is target + (λ − 1) · rest < λ · target, a contradiction; elsewhere it says
            that the norm is at most corner / (1 − rest / target).
        """
        first = min(FIRST, len(self.bend))
        if not first:
            return max(self.target, float(norms_above(self.entries.coefficients[None], 0.0)[0]))
        near, far = self.bend[:first], self.bend[first:]
        half = np.full(first, np.pi / _PARTS)
        cells = np.array(list(product(range(_PARTS), repeat=first)))
        corners = np.array(list(product((0, 1), repeat=first)))
        while True:
            around = np.round(np.pi / half).astype(np.intp)
            counts = np.maximum(1, np.ceil(np.pi * np.sqrt(far / np.mean(near * half**2)))).astype(np.intp)
            rest = 0.5 * float(near @ half**2 + far @ (np.pi / counts) ** 2)
            if rest < _LARGE * self.target:
                places = (cells[:, None] + corners).reshape(-1, first) % around
                number = np.ravel_multi_index(tuple(places.T), tuple(around))
                _, one, back = np.unique(number, return_index=True, return_inverse=True)
                tops = self._tops(places[one] * (2 * np.pi / around), counts, self.target - rest)
                top = np.max(tops[back].reshape(len(cells), -1), axis=1)
                fails = top > self.target - rest
                if not fails.any():
                    return self.target
                cells = cells[fails]
                reached = float(np.max(top))
                if self.points > most_points or (self.postures is None and reached > self.target):
                    return max(self.target, reached / (1 - rest / self.target))
            side = np.argmax(near * half**2)
            half[side] /= 2
            step = np.arange(first) == side
            cells = np.concatenate([cells * (1 + step), cells * (1 + step) + step])

    def _tops(self, first: Array, counts: NDArray[np.intp], cut: float) -> Array:
        """For values of the first angles the largest norm over the grid of the others, at least the cut."""
        tops, tight = np.full(len(first), cut), self.target - _TIGHT * (self.target - self.inside)
        hard: list[Array] = []
        for places, values in self.entries.on(first, counts.tolist()):
            flat = values.reshape(-1, *values.shape[-2:])
            self.points += len(flat)
            norms = norms_above(flat, cut)
            for factor in self.factors:
                large = norms > max(cut, _LOOSE * self.inside)
                if large.any():
                    norms[large] = np.minimum(norms[large], norms_above(flat[large] @ factor, cut))
            norms = norms.reshape(len(places), -1)
            worst = np.argmax(norms, axis=1)
            tops[places] = np.maximum(cut, np.max(norms, axis=1))
            high = tops[places] > tight
            if self.postures is not None and high.any():
                others = _angles(worst[high], counts.tolist())
                hard.append(np.column_stack([tops[places][high], first[places][high], *others]))
        if self.postures is not None and hard:
            rows = np.concatenate(hard)
            self._add_factors(self.postures, rows[:, 0], rows[:, 1:], tight)
        return tops

    def _add_factors(self, postures: Postures, tops: Array, angles: Array, tight: float) -> None:
        """An L for the worst postures and those like them, and so on until no norm is above ``tight``."""
        for _ in range(_TRIES):
            apart = (1 - np.cos(angles - angles[np.argmax(tops)])) @ self.bend
            q = np.zeros((len(angles), postures.n))
            q[:, list(self.entries.angles)] = angles
            stacks = postures.stacks(q)
            factor = common_factor(stacks[np.argsort(apart, kind="stable")[:_ALIKE]], postures.n)
            self.factors.append(np.asarray(np.linalg.solve(postures.factor, factor), dtype=np.float64))
            tops = np.minimum(tops, norms_above(stacks @ factor, 0.0))
            tops, angles = tops[tops > tight], angles[tops > tight]
            if not len(tops):
                return


def norms_above(matrices: Array, cut: float) -> Array:
    """Upper bounds of the spectral norms, (count,), close where they are above the cut."""
    norms = np.sqrt(np.einsum("cij,cij->c", matrices, matrices))
    above = np.flatnonzero(norms > cut)
    if len(above):
        chosen = matrices[above]
        gram = chosen @ np.swapaxes(chosen, 1, 2)
        square = gram @ gram
        norms[above] = np.einsum("cij,cij->c", square, square) ** 0.125
        still = norms[above] > cut
        if still.any():
            norms[above[still]] = np.sqrt(np.linalg.eigvalsh(gram[still])[:, -1])
    return np.asarray(norms)


def _angles(places: NDArray[np.intp], counts: Sequence[int]) -> list[Array]:
    """The angles of places in a grid, rad."""
    if not counts:
        return []
    index = np.unravel_index(places, tuple(counts))
    return [2 * np.pi * place / count for place, count in zip(index, counts, strict=True)]
