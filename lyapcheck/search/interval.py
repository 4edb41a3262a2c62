"""Intervals of doubles, elementwise over arrays, for proposals that the checker judges again in balls.

Nothing is rounded outward: `positive_definite` leaves more room than rounding takes. A comparison with an
undefined end is false, so that such an interval proves nothing.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from functools import lru_cache
from typing import Any

import numpy as np
from flint import arb
from numpy.typing import NDArray

from lyapcheck._types import Array
from lyapcheck.check.loop.field import Side

SURELY = 1e-9
"""What a pivot has to exceed, as a share of its entry of the diagonal."""
_KEPT = 1 << 17


@dataclass(frozen=True, eq=False)
class Interval:
    """All reals between ``lo`` and ``hi``, elementwise; numbers and arrays in an operation are exact."""

    lo: Array
    hi: Array

    # NumPy must leave ``array * interval`` to this class instead of looping over the array.
    __array_ufunc__ = None

    @classmethod
    def around(cls, middle: Array, radius: Array) -> Interval:
        """What is no further from a middle than a radius."""
        return cls(middle - radius, middle + radius)

    def __add__(self, other: Interval | Array | float) -> Interval:
        low, high = _ends(other)
        return Interval(self.lo + low, self.hi + high)

    __radd__ = __add__

    def __sub__(self, other: Interval | Array | float) -> Interval:
        low, high = _ends(other)
        return Interval(self.lo - high, self.hi - low)

    def __rsub__(self, other: Array | float) -> Interval:
        return Interval(other - self.hi, other - self.lo)

    def __mul__(self, other: Interval | Array | float) -> Interval:
        low, high = _ends(other)
        a, b = self.lo * low, self.hi * low
        least, most = np.minimum(a, b), np.maximum(a, b)
        if low is not high:
            c, d = self.lo * high, self.hi * high
            least, most = np.minimum(least, np.minimum(c, d)), np.maximum(most, np.maximum(c, d))
        return Interval(least, most)

    __rmul__ = __mul__

    def square(self) -> Interval:
        """x², which is never negative."""
        least = np.maximum(np.maximum(self.lo, -self.hi), 0.0)
        return Interval(least * least, self.size**2)

    def reciprocal(self) -> Interval:
        """1/x where x is positive throughout; everything elsewhere."""
        usable = self.lo > 0
        return Interval(np.where(usable, 1 / self.hi, -np.inf), np.where(usable, 1 / self.lo, np.inf))

    @property
    def middle(self) -> Array:
        """The mean of both ends."""
        return np.asarray(0.5 * (self.lo + self.hi))

    @property
    def radius(self) -> Array:
        """Half the width."""
        return np.asarray(0.5 * (self.hi - self.lo))

    @property
    def size(self) -> Array:
        """The largest absolute value."""
        return np.maximum(-self.lo, self.hi)


def _ends(value: Any) -> tuple[Any, Any]:
    return (value.lo, value.hi) if isinstance(value, Interval) else (value, value)


def norm(e: Sequence[Interval]) -> Interval:
    """‖e‖."""
    squares = [x.square() for x in e]
    return Interval(np.sqrt(sum(x.lo for x in squares)), np.sqrt(sum(x.hi for x in squares)))


def unit_vector(e: Sequence[Interval]) -> list[Interval]:
    """e/‖e‖, and everything in [−1, 1] where the box touches the origin.

    e_i/√(e_i² + rest) grows with e_i; for e_i > 0 it falls with the rest, for e_i < 0 it grows with it.
    """
    result = []
    for i, x in enumerate(e):
        rest = norm([Interval(np.zeros(()), np.zeros(())), *e[:i], *e[i + 1 :]])
        result.append(Interval(-_largest_share(-x.lo, rest), _largest_share(x.hi, rest)))
    return result


def _largest_share(x: Array, rest: Interval) -> Array:
    """The largest x/√(x² + rest²); 0 where x is 0."""
    length = np.hypot(x, np.where(x >= 0, rest.lo, rest.hi))
    return np.where(x == 0, 0.0, x / np.where(length > 0, length, 1.0))


def of_sides(functions: Callable[[Side], Sequence[arb]]) -> Callable[[Interval], list[Interval]]:
    """Functions of one side in balls, over arrays of sides: each is asked once, as boxes share most."""

    @lru_cache(maxsize=_KEPT)
    def ends(side: complex) -> list[tuple[float, float]]:
        return [(float(y.lower()), float(y.upper())) for y in functions((side.real, side.imag))]

    def over(x: Interval) -> list[Interval]:
        sides, index = np.unique(np.ravel(x.lo) + 1j * np.ravel(x.hi), return_inverse=True)
        known = np.array([ends(side) for side in sides.tolist()])[index.ravel()]
        low, high = np.moveaxis(known.reshape(*np.shape(x.lo), -1, 2), (-2, -1), (1, 0))
        return [Interval(*pair) for pair in zip(low, high, strict=True)]

    return over


def positive_definite(matrix: Sequence[Sequence[Interval]]) -> NDArray[np.bool_]:
    """Where every symmetric matrix within the intervals is positive definite; False means not shown.

    Elimination without pivoting: a symmetric matrix is positive definite exactly when all its pivots are
    positive, and the pivots of every member lie in the interval pivots.

    Args:
        matrix: n × n intervals; only the entries on and below the diagonal are read.
    """
    rows = [list(row) for row in matrix]
    proved = np.ones(np.shape(rows[0][0].lo), dtype=np.bool_)
    with np.errstate(all="ignore"):
        for k, row in enumerate(rows):
            proved = proved & (row[k].lo > SURELY * matrix[k][k].hi)
            inverse = row[k].reciprocal()
            for i in range(k + 1, len(rows)):
                factor = rows[i][k] * inverse
                for j in range(k + 1, i):
                    rows[i][j] = rows[i][j] - factor * rows[j][k]
                rows[i][i] = rows[i][i] - rows[i][k].square() * inverse
    return proved
