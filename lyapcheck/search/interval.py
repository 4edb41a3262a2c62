"""Intervals of doubles, elementwise over arrays.

Each elementary operation is done in round-to-nearest and then widened: for a rounded result r of an exact x,
|r − x| ≤ 2⁻⁵³|r| + 2⁻¹⁰⁷⁴, while ``_down`` and ``_up`` move r by at least 2⁻⁵¹|r| + 10⁻³⁰⁰ before their own
rounding, which is below 2⁻⁵³(|r| + …): the exact x stays inside. Overflow gives infinite ends, and an
undefined end becomes an infinite one: such an interval contains everything and proves nothing.
"""

from __future__ import annotations

import math
import sys
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from fractions import Fraction
from typing import Any, NoReturn

import numpy as np
from numpy.typing import NDArray

from lyapcheck._types import Array

Number = float | int | Fraction
_SLACK = 2.0**-51
_TINY = 1e-300


def down(x: Array) -> Array:
    """A bound not above the exact value that ``x`` is the rounding of."""
    moved = x - (np.abs(x) * _SLACK + _TINY)
    return np.where(np.isnan(moved), -np.inf, moved)


def up(x: Array) -> Array:
    """A bound not below the exact value that ``x`` is the rounding of."""
    moved = x + (np.abs(x) * _SLACK + _TINY)
    return np.where(np.isnan(moved), np.inf, moved)


@dataclass(frozen=True, eq=False)
class Interval:
    """All reals between ``lo`` and ``hi``, elementwise; plain numbers in an operation are exact.

    A plain ``int`` or ``Fraction`` that is no double stands for the narrowest interval of doubles around it.

    Soundness: for x in the first and y in the second interval, x ∘ y lies in the result, for every ∘ here.
    """

    lo: Array
    hi: Array

    # NumPy must leave ``array * interval`` to this class instead of looping over the array.
    __array_ufunc__ = None

    @classmethod
    def exact(cls, value: float) -> Interval:
        """The interval of one double."""
        point = np.asarray(float(value))
        return cls(point, point)

    @classmethod
    def of(cls, value: Fraction | int) -> Interval:
        """The narrowest interval of doubles around a rational."""
        near = _nearest(value)
        below = near if Fraction(near) <= value else math.nextafter(near, -math.inf)
        above = near if Fraction(near) >= value else math.nextafter(near, math.inf)
        return cls(np.asarray(below), np.asarray(above))

    def __add__(self, other: Interval | Number) -> Interval:
        o = _interval(other)
        with np.errstate(all="ignore"):
            return Interval(down(self.lo + o.lo), up(self.hi + o.hi))

    __radd__ = __add__

    def __sub__(self, other: Interval | Number) -> Interval:
        o = _interval(other)
        with np.errstate(all="ignore"):
            return Interval(down(self.lo - o.hi), up(self.hi - o.lo))

    def __rsub__(self, other: Interval | Number) -> Interval:
        return -self + other

    def __neg__(self) -> Interval:
        return Interval(-self.hi, -self.lo)

    def __mul__(self, other: Interval | Number) -> Interval:
        if isinstance(other, float):
            return self._scaled(other)
        other = _interval(other)
        with np.errstate(all="ignore"):
            a, b = self.lo * other.lo, self.lo * other.hi
            c, d = self.hi * other.lo, self.hi * other.hi
            low = np.minimum(np.minimum(a, b), np.minimum(c, d))
            high = np.maximum(np.maximum(a, b), np.maximum(c, d))
            return Interval(down(low), up(high))

    __rmul__ = __mul__

    def _scaled(self, factor: float) -> Interval:
        with np.errstate(all="ignore"):
            a, b = self.lo * factor, self.hi * factor
            low, high = (a, b) if factor >= 0 else (b, a)
            return Interval(down(low), up(high))

    def square(self) -> Interval:
        """x², which is never negative."""
        a, b = np.abs(self.lo), np.abs(self.hi)
        small = np.where((self.lo <= 0) & (self.hi >= 0), 0.0, np.minimum(a, b))
        large = np.maximum(a, b)
        with np.errstate(all="ignore"):
            return Interval(np.maximum(down(small * small), 0.0), up(large * large))

    def reciprocal(self) -> Interval:
        """1/x where x is positive throughout; everything elsewhere."""
        with np.errstate(all="ignore"):
            low, high = down(1.0 / self.hi), up(1.0 / self.lo)
        usable = self.lo > 0
        return Interval(np.where(usable, low, -np.inf), np.where(usable, high, np.inf))

    def sqrt(self) -> Interval:
        """√x where x is not negative throughout; everything elsewhere."""
        with np.errstate(all="ignore"):
            low, high = np.maximum(down(np.sqrt(self.lo)), 0.0), up(np.sqrt(self.hi))
        usable = self.lo >= 0
        return Interval(np.where(usable, low, -np.inf), np.where(usable, high, np.inf))

    def meet(self, other: Interval) -> Interval:
        """The values in both, for two enclosures of the same quantity."""
        return Interval(np.maximum(self.lo, other.lo), np.minimum(self.hi, other.hi))

    def __getitem__(self, index: Any) -> Interval:
        return Interval(self.lo[index], self.hi[index])

    @property
    def mid(self) -> Array:
        """The middle, rounded, but never outside; NaN where an end is undefined or both are infinite."""
        with np.errstate(all="ignore"):
            return np.clip(0.5 * self.lo + 0.5 * self.hi, self.lo, self.hi)

    @property
    def radius(self) -> Array:
        """Half the width, rounded up."""
        with np.errstate(all="ignore"):
            return up(np.maximum(self.hi - self.mid, self.mid - self.lo))

    def __bool__(self) -> NoReturn:
        raise TypeError("an interval has no truth value; compare its ends")


def _interval(value: Interval | Number) -> Interval:
    if isinstance(value, Interval):
        return value
    return Interval.exact(value) if isinstance(value, float) else Interval.of(value)


def _nearest(value: Fraction | int) -> float:
    """A double next to a rational, and the largest of its sign where it is beyond all of them."""
    try:
        return float(value)
    except OverflowError:
        return sys.float_info.max if value > 0 else -sys.float_info.max


# --- Elementary functions and norms over intervals.
#
# The sin and cos of the platform are taken to be right within 2⁻⁴⁹ relatively (eight units in the last
# place), a family within what `lyapcheck.search.interval_arm` says. Tests compare them with balls at many
# points.


LIBRARY_SLACK = 2.0**-49
TINY = 1e-300
_ROUNDING = 1e-15
_SQUARABLE = 1e-140


def widened(low: Array, high: Array, slack: float = LIBRARY_SLACK, least: Array | float = TINY) -> Interval:
    """The interval between two values of a library function, widened by what the library may be wrong.

    An undefined value becomes an infinite end.

    Args:
        low: the smaller value.
        high: the larger one.
        slack: what it may be wrong relatively.
        least: what it may be wrong beside that.
    """
    with np.errstate(invalid="ignore"):
        return Interval(down(low - (np.abs(low) * slack + least)), up(high + (np.abs(high) * slack + least)))


def sine(x: Interval) -> Interval:
    """sin over intervals of angles in rad, |x| up to some thousand turns."""
    return _periodic(np.sin, x, math.pi / 2)


def cosine(x: Interval) -> Interval:
    """cos over intervals of angles in rad, |x| up to some thousand turns."""
    return _periodic(np.cos, x, 0.0)


def _periodic(function: Callable[[Array], Array], x: Interval, peak: float) -> Interval:
    """The range of a sine-like function whose maximum is at ``peak`` and whose period is 2π."""
    with np.errstate(invalid="ignore"):
        a, b = function(x.lo), function(x.hi)
        low, high = np.minimum(a, b), np.maximum(a, b)
        high = np.where(_holds(x, peak), 1.0, high)
        low = np.where(_holds(x, peak + math.pi), -1.0, low)
    wide = widened(low, high)
    return Interval(np.maximum(wide.lo, -1.0), np.minimum(wide.hi, 1.0))


def _holds(x: Interval, place: float) -> Array:
    """Whether an interval may hold a point ``place`` + 2πk; in doubt it does."""
    turn = 2 * math.pi
    slack = _ROUNDING * (4.0 + np.abs(x.lo) + np.abs(x.hi))
    first = np.ceil((x.lo - place - slack) / turn)
    return np.asarray(place + turn * first <= x.hi + slack)


def norm(e: Sequence[Interval]) -> Interval:
    """‖e‖."""
    return _sum_of_squares(e).sqrt()


def _sum_of_squares(e: Sequence[Interval]) -> Interval:
    """Σ e_i², which rounding must not make negative."""
    total = Interval.exact(0.0)
    for component in e:
        total = total + component.square()
    return Interval(np.maximum(total.lo, 0.0), total.hi)


def inverse_one_plus(r: Interval) -> Interval:
    """1/(1 + r) for r ≥ 0."""
    return (r + 1.0).reciprocal()


def unit_vector(e: Sequence[Interval]) -> list[Interval]:
    """e/‖e‖, and everything in [−1, 1] where the box touches the origin.

    e_i/√(e_i² + rest) grows with e_i; for e_i > 0 it falls with the rest, for e_i < 0 it grows with it.
    """
    rests = (_sum_of_squares([x for k, x in enumerate(e) if k != i]) for i in range(len(e)))
    return [
        Interval(-_largest_share(-x.lo, rest), _largest_share(x.hi, rest))
        for x, rest in zip(e, rests, strict=True)
    ]


def _largest_share(x: Array, rest: Interval) -> Array:
    """An upper bound of x/√(x² + rest), which grows with x.

    Squares of tiny x lose their digits: a tiny x is moved up, to 10⁻¹⁴⁰ or to 0. Where a sum of squares
    overflows, the bound is that of the sign.
    """
    tiny = np.abs(x) < _SQUARABLE
    x = np.where(tiny, np.where(x > 0, _SQUARABLE, 0.0), x)
    with np.errstate(all="ignore"):
        square = x * x + np.where(x >= 0, rest.lo, rest.hi)
        share = x / np.sqrt(square)
        bound = share + (np.abs(share) * LIBRARY_SLACK + TINY)
    bound = np.where(np.isfinite(square), bound, np.where(x < 0, 0.0, 1.0))
    return np.where(np.isnan(bound), 1.0, np.minimum(bound, 1.0))


# --- Positive definiteness of symmetric interval matrices, proved elementwise over arrays.


Rows = Sequence[Sequence[Interval]]


def positive_definite(matrix: Rows) -> NDArray[np.bool_]:
    """Where every symmetric matrix within the intervals is positive definite; False means not proved.

    Elimination without pivoting: a symmetric matrix is positive definite exactly when all its pivots are
    positive, and the pivots of every member lie in the interval pivots.

    Args:
        matrix: n × n intervals; only the entries on and below the diagonal are read.

    Soundness: outward rounding throughout; an undefined end is infinite and proves nothing.
    """
    n = len(matrix)
    rows = [list(row) for row in matrix]
    proved = np.ones(np.shape(rows[0][0].lo), dtype=np.bool_)
    for k in range(n):
        pivot = rows[k][k]
        proved = proved & (pivot.lo > 0)
        inverse = pivot.reciprocal()
        for i in range(k + 1, n):
            factor = rows[i][k] * inverse
            for j in range(k + 1, i):
                rows[i][j] = rows[i][j] - factor * rows[j][k]
            rows[i][i] = rows[i][i] - rows[i][k].square() * inverse
    return proved
