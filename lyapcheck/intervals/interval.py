"""Intervals of doubles, elementwise over arrays.

Each elementary operation is done in round-to-nearest and then widened: for a rounded result r of an exact x,
|r − x| ≤ 2⁻⁵³|r| + 2⁻¹⁰⁷⁴, while ``_down`` and ``_up`` move r by at least 2⁻⁵¹|r| + 10⁻³⁰⁰ before their own
rounding, which is below 2⁻⁵³(|r| + …): the exact x stays inside. Overflow gives infinite ends, and an
undefined end becomes an infinite one: such an interval contains everything and proves nothing.
"""

from __future__ import annotations

import math
import sys
from dataclasses import dataclass
from fractions import Fraction
from typing import Any, NoReturn

import numpy as np

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
