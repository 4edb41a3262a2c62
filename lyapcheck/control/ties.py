"""Whether γ_m is exactly an algebraic number: what no bracket can decide, and hardly ever has to be."""

from __future__ import annotations

from fractions import Fraction

from flint import fmpq, fmpq_poly


def gamma_squared_is_root(m: int, c0: Fraction, c1: Fraction, c2: Fraction) -> bool:
    """Whether c0 + c1 γ_m² + c2 γ_m⁴ = 0, for m >= 2; the coefficients are not all 0.

    Soundness: γ_m² = A²/W with A = 2m(1 + u) − 1 and W = 4m² u(1 + u), where u is the only positive root
    of P = u^m − 2m u − (2m − 1) (Descartes). So γ_m² is a root exactly when u is a common root of P and
    c0 W² + c1 A² W + c2 A⁴, that is when their greatest common divisor has a positive root. It divides P,
    so it has at most one, a simple one, and then its sign at 0 differs from that at infinity.
    """
    a, w = fmpq_poly([2 * m - 1, 2 * m]) ** 2, 4 * m**2 * fmpq_poly([0, 1, 1])
    k0, k1, k2 = (fmpq(c.numerator, c.denominator) for c in (c0, c1, c2))
    common = _peak_equation(m).gcd(k0 * w * w + k1 * a * w + k2 * a * a)
    return bool(common.degree() >= 1 and common[0] * common[common.degree()] < 0)


def _peak_equation(m: int) -> fmpq_poly:
    """u^m − 2m u − (2m − 1), for m >= 2."""
    return fmpq_poly([0] * m + [1]) - fmpq_poly([2 * m - 1, 2 * m])
