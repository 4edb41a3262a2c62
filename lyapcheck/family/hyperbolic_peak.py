"""h_m' around its zero x_γ, where every formula cancels: a Taylor expansion in x - x_γ.

The zero is known to three doubles, so that the distance to it keeps full relative precision even at the
double next to it; the coefficients come from ball arithmetic, once for each m.
"""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import contextmanager
from dataclasses import dataclass
from functools import lru_cache
from typing import Any

from flint import arb, arb_series, ctx

from lyapcheck.check.numbers.balls import precision
from lyapcheck.check.numbers.constants import hyperbolic_constants
from lyapcheck.family.arithmetic import Arithmetic

_TERMS = 13
_BITS = 320


@dataclass(frozen=True)
class Peak:
    """The zero x_γ of h_m' as a sum of three doubles, a radius, and h_m'(x_γ + d)/d as a polynomial in d."""

    place: tuple[float, float, float]
    radius: float
    coefficients: tuple[float, ...]


@lru_cache(maxsize=1024)
def peak(m: int) -> Peak:
    """The expansion for one m >= 2, good to a unit in the last place within its radius."""
    with precision(_BITS), _series_length(_TERMS + 1):
        where = hyperbolic_constants(m, 80).gamma_at
        assert where is not None
        center = where.to_arb()
        series = _dh_series(m, center)
        coefficients = tuple(float(series[k].mid()) for k in range(1, _TERMS + 1))
        return Peak(_three_doubles(center), 1.0 / (32 * m), coefficients)


def dh_at_peak(of: Arithmetic, m: int, a: Any, elsewhere: Any) -> Any:
    """h_m'(a) by the expansion where a lies within its radius, and ``elsewhere`` where not."""
    if m == 1:
        return elsewhere
    near = peak(m)
    d = ((a - near.place[0]) - near.place[1]) - near.place[2]
    inside = of.fabs(d) < near.radius
    d = of.where(inside, d, 0.0)
    total: Any = near.coefficients[-1]
    for coefficient in reversed(near.coefficients[:-1]):
        total = coefficient + d * total
    return of.where(inside, d * total, elsewhere)


def _dh_series(m: int, center: arb) -> Any:
    """The Taylor series of h_m' at x_γ, from r = 1/sinh."""
    t = (-arb_series([center, 1])).exp()
    r2 = (2 * t / (1 - t * t)) ** 2
    q = r2**m
    return r2 * ((2 * m - 1) * q + 2 * m * q / r2 - 1) / (1 + q) ** 2


def _three_doubles(value: arb) -> tuple[float, float, float]:
    first = float(value.mid())
    second = float((value - first).mid())
    return first, second, float((value - first - second).mid())


@contextmanager
def _series_length(terms: int) -> Iterator[None]:
    """Work with power series of some length inside."""
    before, ctx.cap = ctx.cap, terms
    try:
        yield
    finally:
        ctx.cap = before
