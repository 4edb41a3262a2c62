"""The largest norm of a matrix of trigonometric polynomials, from points and bounds of second derivatives.

Let f(q) = zᵀ W(q) X for unit z, x and the products X of x, and f(q*) = sup ‖W X‖. The corners of a box around
q* with half widths r, weighted so that their mean is q*, see what linear interpolation sees: no mixed
derivatives. What f loses towards them its second derivatives give back. So with D = Π_k (1 − ½ r_k² ∂_k²)

    sup ‖W X‖ ≤ max over the corners of ‖(D W) L‖ + rest,

where the rest, `remainder`, is of fourth order, and each corner may have its own L of
`lyapcheck.constants.products`. The first three angles are parted into cells; of the others every corner sees
a whole grid, as fine as the cells need.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, field
from itertools import product
from operator import itemgetter

import numpy as np

from lyapcheck._types import Array
from lyapcheck.compiled.threads import over_shares
from lyapcheck.constants.circles import Circles
from lyapcheck.constants.products import common_factor

FIRST = 3
"""Angles that are parted into cells."""
_PARTS = 4
"""Cells of a circle to begin with."""
_PLAIN = 0.5
"""Half widths, rad, from which an angle is left out of D, as what is of higher order would cost more."""
_LARGE = 0.15
"""Share of the target from which the remainder is not worth a look at the corners."""
_POWERS = (2, 4, 8, 16, 32, 64)
"""Of A Aᵀ, whose traces bound its norm: without eigenvalues, which take longer."""
_ALIKE = 40
"""Matrices that share one more L."""
_TRIES = 20
"""More L at one width of the cells, at most, and"""
_WORTH = 5_000
"""points around corners above the cut that are worth one: about as many as take as long as it does."""


@dataclass(eq=False)
class Lattice:
    """A search for cells where the norm could exceed a target.

    Args:
        entries: W L of one L for all postures.
        bend: b_k of the angles of ``entries``.
        target: what is to be shown.
        factor: that L, (pairs, pairs), which others can replace; without it the search ends at a norm above
            the target.
        points: looked at so far.
        factors: the other L, each times the inverse of the first one.
    """

    entries: Circles
    bend: Array
    target: float
    factor: Array | None = None
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
            widths = np.concatenate([half, np.pi / counts])
            rest = remainder(widths, self.bend)
            if rest < _LARGE * self.target:
                places = (cells[:, None] + corners).reshape(-1, first) % around
                number = np.ravel_multi_index(tuple(places.T), tuple(around))
                _, one, back = np.unique(number, return_index=True, return_inverse=True)
                spread = self.entries.spread(np.where(widths < _PLAIN, widths, 0.0))
                cut = self.target - rest
                tops, hard, matrices = self._tops(
                    spread, places[one] * (2 * np.pi / around), counts.tolist(), cut
                )
                top = np.max(tops[back].reshape(len(cells), -1), axis=1)
                cells = cells[top > cut]
                if not len(cells):
                    return self.target
                reached = float(np.max(top))
                if self.points > most_points or (self.factor is None and reached > self.target):
                    return max(self.target, reached / (1 - rest / self.target))
                if self.factor is not None:
                    tries = min(_TRIES, len(hard) * int(np.prod(counts)) // _WORTH)
                    self._add_factors(self.factor, tops[hard], matrices, cut, tries)
            side = np.argmax(near * half**2)
            half[side] /= 2
            step = np.arange(first) == side
            cells = np.concatenate([cells * (1 + step), cells * (1 + step) + step])

    def _tops(
        self, spread: Circles, first: Array, counts: Sequence[int], cut: float
    ) -> tuple[Array, list[int], Array]:
        """For values of the first angles a bound of the norm on the grid of the others, at least the cut.

        Returns:
            The bounds, (count,); where they are above the cut, and matrices that no L brings below it.
        """
        tops, factors = np.full(len(first), cut), np.array(self.factors)
        found: list[tuple[int, Array]] = []

        def look(start: int, stop: int) -> int:
            points = 0
            for places, values in spread.on(first[start:stop], counts):
                points += values.shape[0] * values.shape[1]
                norms = norms_above(values.reshape(-1, *values.shape[2:]), cut).reshape(len(places), -1)
                for row in np.flatnonzero(norms.max(axis=1) > cut):
                    worst = _worst(values[row], norms[row], factors, cut)
                    if norms[row, worst] > cut:
                        place = start + int(places[row])
                        tops[place] = norms[row].max()
                        found.append((place, values[row, worst]))
            return points

        self.points += over_shares(look, len(first))
        found.sort(key=itemgetter(0))
        return tops, [place for place, _ in found], np.array([matrix for _, matrix in found])

    def _add_factors(self, first: Array, tops: Array, matrices: Array, cut: float, tries: int) -> None:
        """An L for the worst matrix and those like it, and so on for those that stay above the cut."""
        back = np.linalg.inv(first)
        for _ in range(tries):
            worst = np.argmax(tops)
            apart = np.sum((matrices - matrices[worst]) ** 2, axis=(1, 2))
            alike = matrices[np.argsort(apart, kind="stable")[:_ALIKE]] @ back
            self.factors.append(np.asarray(back @ common_factor(alike, matrices.shape[1]), dtype=np.float64))
            tops = np.minimum(tops, norms_above(matrices @ self.factors[-1], cut))
            tops[worst] = cut
            tops, matrices = tops[tops > cut], matrices[tops > cut]
            if not len(tops):
                return


def _worst(matrices: Array, norms: Array, factors: Array, cut: float) -> np.intp:
    """The worst norm, after their bounds are made smaller, in place, until the cut or until no L helps."""
    worst = np.argmax(norms)
    while len(factors) and norms[worst] > cut:
        tried = norms_above(matrices[worst] @ factors, cut)
        norms[worst] = min(norms[worst], np.min(tried))
        if norms[worst] > cut:
            break
        above = norms > cut
        if above.any():
            moved = matrices[above] @ factors[np.argmin(tried)]
            norms[above] = np.minimum(norms[above], norms_above(moved, cut))
        worst = np.argmax(norms)
    return worst


def remainder(half: Array, bend: Array) -> float:
    """What f(q*) can be above the largest D f at the corners of a box around q*.

    Args:
        half: r_k, rad; an angle with r_k ≥ `_PLAIN` has no factor in D.
        bend: b_k ≥ sup |∂_k² f|.

    Soundness: the weighted corners take the mean Π_k A_k f of D f, A_k = I_k (1 − ½ r_k² ∂_k²), where I_k is
        linear interpolation by q_k, at q* = middle + t. Let v = r² − t². By Peano's kernel, I f − f is ½ v
        times a mean of f″ over distances with mean −2t/3 and mean square (r² + 3t²)/6. With the bounds 2b of
        f‴ and 4b of f⁗ (Bernstein; the degree is 2) and μ = A − 1 this gives for every f

            sup |μ f| ≤ s sup |f″|,     s = r² max(½, ⅔ r + 5/3 r²),

        and at a maximum, where f″ = −P ≤ 0 and |f‴| ≤ min(2b, √(12 P b)), as f is nowhere above f(q*),

            μ f ≥ ½ t² P − ⅓ v |t| |f‴| − v (7r² + 3t²) b / 6 ≥ −e b,
            e = r³ min(4/(9√3), ⅔ r) + 7/6 r⁴.

        Without the factor in D both are ½ r². As Π A_k − 1 = Σ_k μ_k Π_{j<k} (1 + μ_j), in any order,

            f(q*) ≤ max D f + Σ_k b_k (e_k + s_k (Π_{j<k} (1 + 4 s_j) − 1)).
    """
    order = np.argsort(-bend, kind="stable")
    r, b = half[order], bend[order]
    plain = 0.5 * r**2
    size = np.where(r < _PLAIN, r**2 * np.maximum(0.5, 2 / 3 * r + 5 / 3 * r**2), plain)
    own = np.where(r < _PLAIN, r**3 * np.minimum(4 / (9 * np.sqrt(3)), 2 / 3 * r) + 7 / 6 * r**4, plain)
    before = np.concatenate([[1.0], np.cumprod(1 + 4 * size)[:-1]])
    return float(b @ (own + size * (before - 1)))


def norms_above(matrices: Array, cut: float) -> Array:
    """Upper bounds of the spectral norms, (count,), close where they are above the cut.

    ‖A‖ ≤ (tr (A Aᵀ)^k)^(1/2k), and at most rows^(1/2k) times ‖A‖: k is doubled while that is above the cut.
    """
    sizes: Array = np.sqrt(np.einsum("cij,cij->c", matrices, matrices))
    norms = sizes.copy()
    above = np.flatnonzero(norms > cut)
    scaled = matrices[above] / sizes[above, None, None]
    power = scaled @ np.swapaxes(scaled, 1, 2)
    for k in _POWERS:
        norms[above] = sizes[above] * np.einsum("cij,cij->c", power, power) ** (0.5 / k)
        still = norms[above] > cut
        above, power = above[still], power[still]
        if k == _POWERS[-1] or not len(above):
            break
        power = power @ power
    return np.asarray(norms)
