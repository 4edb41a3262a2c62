"""h and h' of a family over intervals: hulls of end values and of the extremes in between."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from functools import lru_cache

import numpy as np
from flint import arb

from lyapcheck._types import Array
from lyapcheck.check.numbers.enclosure import Enclosure
from lyapcheck.family import Family
from lyapcheck.intervals.functions import widened
from lyapcheck.intervals.interval import Interval


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
    return _range(family.h, [*extrema, *mirrored], x)


def dh_range(family: Family, x: Interval) -> Interval:
    """All values of h' over the intervals: h' is even and monotone between its extremes."""
    extrema = _turning_points(family)[1]
    mirrored = [TurningPoint((-p.where[1], -p.where[0]), p.value) for p in extrema if p.where[1] > 0]
    return _range(family.dh, [*extrema, *mirrored], x)


def _range(function: Callable[[Array], Array], extrema: list[TurningPoint], x: Interval) -> Interval:
    a, b = _at_ends(function, x)
    result = widened(np.minimum(a, b), np.maximum(a, b))
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
