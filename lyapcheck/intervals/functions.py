"""Elementary functions and norms over intervals.

The sin and cos of the platform are taken to be right within 2⁻⁴⁹ relatively (eight units in the last place),
a family within what `lyapcheck.intervals.family` says. Tests compare them with balls at many points.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence

import numpy as np

from lyapcheck._types import Array
from lyapcheck.intervals.interval import Interval, down, up

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
        return Interval(
            down(low - (np.abs(low) * slack + least)),
            up(high + (np.abs(high) * slack + least)),
        )


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
    return [_component(e, i) for i in range(len(e))]


def _component(e: Sequence[Interval], i: int) -> Interval:
    rest = _sum_of_squares([x for k, x in enumerate(e) if k != i])
    return Interval(-_largest_share(-e[i].lo, rest), _largest_share(e[i].hi, rest))


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
