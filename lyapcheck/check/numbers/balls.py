"""The hyperbolic family in balls: h_m, h_m', U_m and h_m(x)/x, containing for every finite ball.

Over a ball that is not a single point the answer is the hull of the values at both ends and at the extremes
in between, so wide balls give ranges as tight as narrow ones.

References: ``reyes2019family`` (6), (8), (12).
"""

from __future__ import annotations

from collections.abc import Callable
from functools import lru_cache
from typing import Any

from flint import arb, ctx

from lyapcheck.check.numbers.constants import (
    dh_value,
    gamma_value,
    peak_of_h,
    peaks_of_d2h,
    peaks_of_dh,
    position,
    power,
)
from lyapcheck.check.numbers.polynomials import ball_of

Extremes = tuple[tuple[arb, arb], ...]
"""Pairs (where, value) of the extremes of a function over x > 0."""
precision: Any = ctx.workprec
"""Work with so many bits of precision inside; flint's setting is global, so it is put back after."""
to_arb = ball_of
"""A ball of the current precision that contains a rational number."""


def h(m: int, x: arb) -> arb:
    """h_m(x) = sinh^(2m-1)x cosh x / (1 + sinh^(2m)x)."""
    return odd_range(lambda a: _h(m, a), _extremes_of_h(m, ctx.prec), x)


def dh(m: int, x: arb) -> arb:
    """h_m'(x) = (2m-1 + 2m s² - s^(2m)) s^(2m-2) / (1 + s^(2m))² with s = sinh x."""
    return even_range(lambda a: _dh(m, a), _extremes_of_dh(m, ctx.prec), x)


def d2h(m: int, x: arb) -> arb:
    """h_m''(x) = 2 s c s^(2m-4) P(s²) / (1 + s^(2m))³, P that of `critical.peaks_of_dh`."""
    return odd_range(lambda a: _d2h(m, a), _extremes_of_d2h(m, ctx.prec), x)


def bends(m: int) -> tuple[arb, ...]:
    """The x > 0 at which h_m'' may stop being monotone; between −1 and 1 times the first it is."""
    return tuple(where for where, _ in _extremes_of_d2h(m, ctx.prec))


def potential(m: int, x: arb) -> arb:
    """U_m(x) = ln(1 + sinh^(2m)x) / (2m)."""
    return even_range(lambda a: _potential(m, a), (), x)


def even_range(value: Callable[[arb], arb], extremes: Extremes, x: arb) -> arb:
    """The range over a ball of an even function that is monotone between 0, its extremes and infinity."""
    if not x.is_finite():
        return arb("nan")
    low, high = x.lower(), x.upper()
    near = high if high < 0 else (low if low > 0 else arb(0))
    return _range(value, extremes, abs(near), low.neg().max(high))


def odd_range(value: Callable[[arb], arb], extremes: Extremes, x: arb) -> arb:
    """The range over a ball of an odd function that is monotone between 0, its extremes and infinity."""
    if not x.is_finite():
        return arb("nan")
    low, high = x.lower(), x.upper()
    if low >= 0:
        return _range(value, extremes, low, high)
    if high <= 0:
        return -_range(value, extremes, -high, -low)
    return _range(value, extremes, arb(0), high).union(-_range(value, extremes, arb(0), -low))


def _range(value: Callable[[arb], arb], extremes: Extremes, low: arb, high: arb) -> arb:
    """The hull over the points 0 <= low <= high and the extremes that may lie between them."""
    result = value(low)
    if low == high:
        return result
    result = result.union(value(high))
    for where, reached in extremes:
        if not (where < low or where > high):
            result = result.union(reached)
    return result


def _h(m: int, a: arb) -> arb:
    if a == 0:
        return arb(0)
    if a > 1:
        coth, r = _far(a)
        return coth / (1 + power(r, 2 * m))
    s, c = a.sinh_cosh()
    low = power(s, 2 * m - 1)
    return low * c / (1 + low * s)


def _dh(m: int, a: arb) -> arb:
    if a == 0:
        return arb(1 if m == 1 else 0)
    if a > 1:
        _, r = _far(a)
        r2 = r * r
        q = power(r2, m - 1)
        return r2 * ((2 * m - 1) * q * r2 + 2 * m * q - 1) / (1 + q * r2) ** 2
    return dh_value(m, a.sinh() ** 2)


def _d2h(m: int, a: arb) -> arb:
    if m == 1:
        return -2 * _h(1, a) * _dh(1, a)
    k = 2 * m - 1
    if a > 1:
        coth, r = _far(a)
        v = r * r
        q = power(v, m - 1)
        p = q * v
        curvature = 1 - 2 * m * m * q * (1 - p) - p * (k * (m + 2) - k * (m - 1) * p)
        return 2 * coth * v * curvature / (1 + p) ** 3
    s, c = a.sinh_cosh()
    y = s * s
    p = power(y, m)
    curvature = k * (m - 1) + 2 * m * m * y * (1 - p) - p * (k * (m + 2) - p)
    return 2 * s * c * power(y, m - 2) * curvature / (1 + p) ** 3


def _potential(m: int, a: arb) -> arb:
    if a == 0:
        return arb(0)
    if a > 1:
        _, r = _far(a)
        log_sinh = a + (-(-2 * a).exp()).log1p() - arb.const_log2()
        return log_sinh + power(r, 2 * m).log1p() / (2 * m)
    return power(a.sinh(), 2 * m).log1p() / (2 * m)


def _far(a: arb) -> tuple[arb, arb]:
    """coth a and 1/sinh a from e^(-a), which no a > 0 overflows."""
    t = (-a).exp()
    below = 1 - t * t
    return (1 + t * t) / below, 2 * t / below


@lru_cache(maxsize=256)
def _extremes_of_h(m: int, bits: int) -> Extremes:
    if m == 1:
        return ()
    u = peak_of_h(m)
    return ((position(u), gamma_value(m, u)),)


@lru_cache(maxsize=256)
def _extremes_of_dh(m: int, bits: int) -> Extremes:
    if m == 1:
        return ()
    return tuple((position(u), dh_value(m, u)) for u in peaks_of_dh(m))


@lru_cache(maxsize=256)
def _extremes_of_d2h(m: int, bits: int) -> Extremes:
    return tuple((x, _d2h(m, x)) for x in map(position, peaks_of_d2h(m)))
