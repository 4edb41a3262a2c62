"""What γ_m, ρ_m and L_m come close to as m grows, and how far they are from it.

    γ_m = √2 (1 − (1 + ln 4m)/(4m)) + O((ln m/m)²)
    ρ_m = m − 1/2 + 9/(16m) + O(1/m²)
    L_m = √2/asinh 1 · (1 − κ (1 + ln(m/κ))/m) + O((ln m/m)²)        κ = (1 + √2/asinh 1)/4

In t = ln sinh^(2m) x the logarithm of h(x)/x is ln(√2/asinh 1) − κ t/m − e^(−t) but for terms of second
order: largest at t = ln(m/κ). Likewise that of h(x), with 1/4 in place of κ.

References: ``proofs/asymptotics.py`` and ``proofs/every_m.py`` prove bounds of the three rests.
"""

from __future__ import annotations

from dataclasses import dataclass
from fractions import Fraction
from math import ceil, log

from flint import arb, ctx, fmpq, fmpq_poly

from lyapcheck.check.numbers.balls import Constants, gamma_value, peak_of_h, precision, to_arb
from lyapcheck.check.numbers.polynomials import Enclosure, ball_of


@dataclass(frozen=True)
class Asymptotes:
    """The leading terms of γ, ρ and L at one m, and what is left of each constant beside them."""

    gamma: Enclosure
    gamma_rest: Enclosure
    rho: Enclosure
    rho_rest: Enclosure
    L: Enclosure
    L_rest: Enclosure


def asymptotes(row: Constants, digits: int) -> Asymptotes:
    """The leading terms, to about as many digits as the constants have.

    Soundness: balls throughout.
    """
    with precision(ceil(digits * log(10, 2)) + 32 + row.m.bit_length()):
        gamma, rho, secant = _gamma(row.m), _rho(row.m), _secant(row.m)
        return Asymptotes(
            Enclosure.from_arb(gamma),
            Enclosure.from_arb(row.gamma.to_arb() - gamma),
            Enclosure.exact(rho),
            Enclosure(row.rho.lower - rho, row.rho.upper - rho),
            Enclosure.from_arb(secant),
            Enclosure.from_arb(row.L.to_arb() - secant),
        )


def limits() -> tuple[arb, arb]:
    """√2 and √2/asinh 1: what γ_m and L_m tend to."""
    root = to_arb(2).sqrt()
    return root, root / to_arb(1).asinh()


def _gamma(m: int) -> arb:
    return limits()[0] * (1 - (1 + to_arb(4 * m).log()) / (4 * m))


def _rho(m: int) -> Fraction:
    return Fraction(2 * m - 1, 2) + Fraction(9, 16 * m)


def _secant(m: int) -> arb:
    limit = limits()[1]
    fall = (1 + limit) / 4
    return limit * (1 - fall * (1 + (m / fall).log()) / m)


# --- γ_m against a number, decided exactly however close they are.


def gamma_less_than(m: int, bound_squared: Fraction) -> bool:
    """Decide γ_m² < s exactly, for every rational s; never undecided.

    Balls of rising precision decide all but equality. Equality is algebraic: at the peak, γ² = s turns into
    the quadratic R(u) = (2m(1+u) - 1)² - 4m² s u(1+u) = 0, and γ_m² = s exactly when R shares the only
    positive root of u^m - 2m u - (2m - 1), the peak.
    """
    if m == 1:
        return bound_squared > 1
    bits = 64
    while True:
        with ctx.workprec(bits):
            gap = ball_of(bound_squared) - gamma_value(m, peak_of_h(m)) ** 2
            if gap > 0 or gap < 0:
                return bool(gap > 0)
        if bits == 256 and _gamma_squared_is(m, bound_squared):
            return False
        bits *= 2


def _gamma_squared_is(m: int, s: Fraction) -> bool:
    """Whether γ_m² equals s, by the greatest common divisor of both polynomials."""
    peak = fmpq_poly([1 - 2 * m, -2 * m, *[0] * (m - 2), 1]) if m > 2 else fmpq_poly([-3, -4, 1])
    scaled = 4 * m * m * fmpq(s.numerator, s.denominator)
    touching = fmpq_poly([2 * m - 1, 2 * m]) ** 2 - scaled * fmpq_poly([0, 1, 1])
    common = peak.gcd(touching)
    return _has_positive_root(common)


def _has_positive_root(poly: fmpq_poly) -> bool:
    """Whether a polynomial of degree 2 or less, dividing one with a single positive root, has that root.

    It then has at most one positive root, a simple one, and does not vanish at 0: it has one exactly when its
    first and last coefficients have opposite signs.
    """
    return bool(poly.degree() >= 1 and poly[0] * poly[poly.degree()] < 0)
