"""γ_m against a number, decided exactly however close they are."""

from __future__ import annotations

from fractions import Fraction

from flint import ctx, fmpq, fmpq_poly

from lyapcheck.check.numbers.constants import gamma_value
from lyapcheck.check.numbers.critical import peak_of_h
from lyapcheck.check.numbers.enclosure import ball_of


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
