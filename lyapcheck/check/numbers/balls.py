"""The hyperbolic family in balls: h_m, h_m', U_m and h_m(x)/x, containing for every finite ball.

Over a ball that is not a single point the answer is the hull of the values at both ends and at the extremes
in between, so wide balls give ranges as tight as narrow ones.

References: ``reyes2019family`` (6), (8), (12).
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from functools import lru_cache
from math import ceil, log
from typing import Any

from flint import arb, ctx

from lyapcheck.check.numbers.polynomials import Enclosure, ball_of

# --- The constants γ_m, ρ_m and L_m, enclosed to any number of digits.
#
# They are where h_m, h_m' and h_m(x)/x are extreme, enclosed by changes of sign.
#
# With u = sinh²x and p = u^m everything but L is algebraic:
#
#     h² = p² (1 + u) / (u (1 + p)²),     h' = p (2m - 1 + 2m u - p) / (u (1 + p)²).
#
# Each root lies between two points at which a function provably has opposite signs, and is closed in on by
# bisection; an argument by counting says that it is the only one there.
#
# References: ``reyes2019family`` (6), (7), (8).

NEAR = arb(2) ** -40
"""Where a root is known to this share, secants close in on it."""


def peak_of_h(m: int) -> arb:
    """The u = sinh²x at which h_m is largest, for m >= 2.

    h' has the sign of 2m - 1 + 2m u - u^m, whose coefficients change sign once: by Descartes' rule it has
    exactly one positive root, and h rises before it and falls after it.
    """
    return bracketed_root(lambda u: 2 * m - 1 + 2 * m * u - power(u, m), arb(1), arb(4 * m))


def peaks_of_dh(m: int) -> tuple[arb, arb]:
    """The two u = sinh²x at which h_m' is largest and smallest, for m >= 2.

    h'' has, for x > 0, the sign of

        P(u) = (2m-1)(m-1) + 2m² u - (2m-1)(m+2) u^m - 2m² u^(m+1) + u^(2m),

    whose coefficients change sign twice: at most two positive roots (Descartes). Both are found, so h' rises
    from 0 to its maximum, falls through 0 to its minimum, and rises back to 0.
    """

    def curvature(u: arb) -> arb:
        p = power(u, m)
        return (2 * m - 1) * (m - 1) + 2 * m * m * u * (1 - p) - (2 * m - 1) * (m + 2) * p + p * p

    return bracketed_root(curvature, arb(0), arb(1)), bracketed_root(curvature, arb(1), arb(4 * m * m))


def peak_of_secant(m: int) -> arb:
    """The x > 0 at which h_m(x)/x is largest, for m >= 2.

    The derivative of h/x has the sign of F(x) = x h' - h, and F' = x h''. By the roots of P, h is convex up
    to x_ρ and concave from there to x_γ: so F rises from F(0) = 0 and then falls to F(x_γ) = -h(x_γ) < 0,
    with exactly one zero in (0, x_γ). Beyond x_γ, where h falls, h/x falls too: that zero is the peak of h/x.
    In u, p and s = sinh x, c = cosh x, F has the sign of x (2m - 1 + 2m u - p) - (1 + p) s c.
    """

    def excess(x: arb) -> arb:
        s, c = x.sinh_cosh()
        p = power(s, 2 * m)
        return x * (2 * m - 1 + 2 * m * s * s - p) - (1 + p) * s * c

    low, high = (u.sqrt().asinh().mid() for u in (peaks_of_dh(m)[0], peak_of_h(m)))
    return bracketed_root(excess, low, high)


def bracketed_root(function: Callable[[arb], arb], low: arb, high: arb) -> arb:
    """An enclosure, tight at the current precision, of a root of a continuous function between two points.

    Soundness: the ball lies between the points and holds a root because the function changes sign inside it;
    that no other root is meant is for the caller to argue.
    """
    ends, width = (low, high), arb(2) ** -ctx.prec
    with ctx.workprec(2 * ctx.prec + 64):
        while high - low > high * NEAR:
            middle = ((low + high) / 2).mid()
            if _opposite(function(low), function(middle)):
                high = middle
            else:
                low = middle
        last, root = low, high
        for _ in range(2 * ctx.prec.bit_length()):  # by secants, where nothing is promised
            slope = (function(root) - function(last)) / (root - last)
            last, root = root, (root - function(root) / slope).mid()
            if abs(root - last) < root * width / 4:
                break
        left, right = root * (1 - width), root * (1 + width)
        if ends[0] < left and right < ends[1] and _opposite(function(left), function(right)):
            return left.union(right)
    raise ArithmeticError(f"no change of sign was found between {low} and {high}")


def _opposite(left: arb, right: arb) -> bool:
    return bool((left < 0 and right > 0) or (left > 0 and right < 0))


def power(base: Any, exponent: int) -> Any:
    """``base ** exponent`` by repeated multiplication: finite for balls around zero, as flint's is not."""
    result = None
    while exponent:
        if exponent & 1:
            result = base if result is None else result * base
        exponent >>= 1
        base = base * base if exponent else base
    return arb(1) if result is None else result


@dataclass(frozen=True)
class Constants:
    """γ = sup h, ρ = sup |h'|, L = sup h(x)/x over x > 0, and the x at which each is reached.

    A supremum that is reached only in the limit x → ∞ has no place: ``None``.
    """

    m: int
    gamma: Enclosure
    rho: Enclosure
    L: Enclosure
    gamma_at: Enclosure | None
    rho_at: Enclosure | None
    L_at: Enclosure | None


@lru_cache(maxsize=4096)
def hyperbolic_constants(m: int, digits: int = 30) -> Constants:
    """γ_m, ρ_m and L_m of the hyperbolic family, each to ``digits`` significant digits or better.

    m = 1 is tanh: γ = 1 is the limit at infinity, ρ = L = 1 belong to x = 0. For m >= 2 all are reached.

    Soundness: roots are bracketed by certified signs and counted by Descartes' rule.

    References: ``reyes2019family`` (6), (7), (8).
    """
    if m < 1 or digits < 1:
        raise ValueError(f"m and digits must be at least 1, got m = {m}, digits = {digits}")
    if m == 1:
        one, zero = Enclosure.exact(1), Enclosure.exact(0)
        return Constants(1, one, one, one, None, zero, zero)
    with ctx.workprec(ceil(digits * log(10, 2)) + 24 + 2 * m.bit_length()):
        u = peak_of_h(m)
        # h' vanishes at 0 and at infinity, so that |h'| is largest at a root of P
        places = peaks_of_dh(m)
        rise, fall = (abs(dh_value(m, at)) for at in places)
        if not (rise < fall or rise > fall):
            raise ArithmeticError(f"the extremes of h' for m = {m} are too close to tell which is larger")
        rho, rho_at = (rise, position(places[0])) if rise > fall else (fall, position(places[1]))
        x = peak_of_secant(m)
        balls = (gamma_value(m, u), rho, dh_value(m, x.sinh() ** 2), position(u), rho_at, x)
        return Constants(m, *map(Enclosure.from_arb, balls))


def position(u: arb) -> arb:
    """The x > 0 with sinh²x = u."""
    return u.sqrt().asinh()


def gamma_value(m: int, u: arb) -> arb:
    """γ_m from the u at which it is reached: u^m = 2m u + 2m - 1 takes the powers out of h."""
    return (2 * m * (1 + u) - 1) / (2 * m * (u * (1 + u)).sqrt())


def dh_value(m: int, u: arb) -> arb:
    """h_m' as a function of u = sinh²x > 0."""
    p = power(u, m)
    return p * (2 * m - 1 + 2 * m * u - p) / (u * (1 + p) ** 2)


Extremes = tuple[tuple[arb, arb], ...]
"""Pairs (where, value) of the extremes of a function over x > 0."""
precision: Any = ctx.workprec
"""Work with so many bits of precision inside; flint's setting is global, so it is put back after."""
to_arb = ball_of
"""A ball of the current precision that contains a rational number."""


def h(m: int, x: arb) -> arb:
    """h_m(x) = sinh^(2m-1)x cosh x / (1 + sinh^(2m)x)."""

    def at(a: arb) -> arb:
        if a == 0:
            return arb(0)
        if a > 1:
            coth, r = _far(a)
            return coth / (1 + power(r, 2 * m))
        s, c = a.sinh_cosh()
        low = power(s, 2 * m - 1)
        return low * c / (1 + low * s)

    return odd_range(at, _extremes_of_h(m, ctx.prec), x)


def dh(m: int, x: arb) -> arb:
    """h_m'(x) = (2m-1 + 2m s² - s^(2m)) s^(2m-2) / (1 + s^(2m))² with s = sinh x."""

    def at(a: arb) -> arb:
        if a == 0:
            return arb(1 if m == 1 else 0)
        if a > 1:
            _, r = _far(a)
            r2 = r * r
            q = power(r2, m - 1)
            return r2 * ((2 * m - 1) * q * r2 + 2 * m * q - 1) / (1 + q * r2) ** 2
        return dh_value(m, a.sinh() ** 2)

    return even_range(at, _extremes_of_dh(m, ctx.prec), x)


def potential(m: int, x: arb) -> arb:
    """U_m(x) = ln(1 + sinh^(2m)x) / (2m)."""

    def at(a: arb) -> arb:
        if a == 0:
            return arb(0)
        if a > 1:
            _, r = _far(a)
            log_sinh = a + (-(-2 * a).exp()).log1p() - arb.const_log2()
            return log_sinh + power(r, 2 * m).log1p() / (2 * m)
        return power(a.sinh(), 2 * m).log1p() / (2 * m)

    return even_range(at, (), x)


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
