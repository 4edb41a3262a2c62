"""h and h' of a family over intervals: hulls of end values and of the extremes in between.

In doubles the member m loses 4m + 8 units in the last place of h. Of h' it loses as many of the size of its
terms, which is at most 4m, and cancels where |sinh x| > 1 alone; see `lyapcheck.family.hyperbolic_numeric`.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from functools import lru_cache

import numpy as np
from flint import arb

from lyapcheck._types import Array
from lyapcheck.check.numbers.enclosure import Enclosure
from lyapcheck.family import Family
from lyapcheck.intervals.functions import TINY, widened
from lyapcheck.intervals.interval import Interval

_BORDER = 0.88
"""Below asinh 1."""


@dataclass(frozen=True)
class TurningPoint:
    """An x ≥ 0 at which a function may turn, and its value there, each between two doubles."""

    where: tuple[float, float]
    value: tuple[float, float]


def h_range(family: Family, x: Interval) -> Interval:
    """All values of h over the intervals: h is odd and monotone between its extremes."""
    extrema = _turning_points(family)[0]
    mirrored = [
        TurningPoint((-p.where[1], -p.where[0]), (-p.value[1], -p.value[0]))
        for p in extrema
        if p.where[1] > 0
    ]
    return _range(family.h, [*extrema, *mirrored], x, _lost(family), TINY)


def dh_range(family: Family, x: Interval) -> Interval:
    """All values of h' over the intervals: h' is even and monotone between its extremes."""
    extrema = _turning_points(family)[1]
    mirrored = [TurningPoint((-p.where[1], -p.where[0]), p.value) for p in extrema if p.where[1] > 0]
    cancels = np.maximum(np.abs(x.lo), np.abs(x.hi)) > _BORDER
    least = np.where(cancels, 4 * (family.m or 1) * _lost(family), TINY)
    return _range(family.dh, [*extrema, *mirrored], x, _lost(family), least)


def _lost(family: Family) -> float:
    """Of h in doubles, relatively."""
    return (4 * (family.m or 1) + 8) * 2.0**-52


def _range(
    function: Callable[[Array], Array],
    extrema: list[TurningPoint],
    x: Interval,
    slack: float,
    least: Array | float,
) -> Interval:
    a, b = _at_ends(function, x)
    result = widened(np.minimum(a, b), np.maximum(a, b), slack, least)
    low, high = result.lo, result.hi
    for point in extrema:
        inside = (x.lo <= point.where[1]) & (x.hi >= point.where[0])
        low = np.where(inside, np.minimum(low, point.value[0]), low)
        high = np.where(inside, np.maximum(high, point.value[1]), high)
    return Interval(low, high)


def _at_ends(function: Callable[[Array], Array], x: Interval) -> tuple[Array, Array]:
    """The function at both ends; boxes made by halving share most ends, and equal ones are done once."""
    ends = np.concatenate([np.ravel(x.lo), np.ravel(x.hi)])
    distinct, index = np.unique(ends, return_inverse=True)
    values = function(distinct)[index.ravel()]
    half = values.size // 2
    return values[:half].reshape(np.shape(x.lo)), values[half:].reshape(np.shape(x.hi))


@lru_cache(maxsize=256)
def _turning_points(family: Family) -> tuple[tuple[TurningPoint, ...], tuple[TurningPoint, ...]]:
    """The x ≥ 0 at which h, and at which h', may stop being monotone."""
    h_turns, dh_turns = family.turning_points()
    h = tuple(_extreme(family.ball_h, where) for where in h_turns)
    return h, tuple(_extreme(family.ball_dh, where) for where in (arb(0), *dh_turns))


def _extreme(function: Callable[[arb], arb], where: arb) -> TurningPoint:
    place, value = Enclosure.from_arb(where), Enclosure.from_arb(function(where))
    return TurningPoint((place.float_lower, place.float_upper), (value.float_lower, value.float_upper))
