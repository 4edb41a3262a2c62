"""γ, the bound of a bounded function, as the conditions need it: compared exactly with any rational."""

from __future__ import annotations

from dataclasses import dataclass
from fractions import Fraction
from functools import lru_cache

from flint import fmpq, fmpq_poly

from lyapcheck.check.balls import precision
from lyapcheck.check.constants import gamma_less_than, gamma_value, hyperbolic_constants
from lyapcheck.check.critical import peak_of_h
from lyapcheck.check.enclosure import Enclosure
from lyapcheck.control.gains import GainSet
from lyapcheck.errors import argument_error

PRINTED = {1: Fraction(1), 2: Fraction(105, 100), 3: Fraction(111, 100)}
"""γ_1, γ_2, γ_3 as the paper prints them (Table 2): the last two are below the true ones."""

DIGITS = 30


@dataclass(frozen=True)
class GammaBound:
    """γ of one gain set: an enclosure to show, and exact decisions about γ² to decide with.

    Args:
        enclosure: γ to 30 digits; ``None`` for an unbounded function, whose γ is below nothing.
        m: the member, where γ is the true γ_m of the hyperbolic family.
        family: the family, where γ is a transcendental number that the family encloses to any precision.
    """

    enclosure: Enclosure | None
    m: int | None = None
    family: str = ""

    def within(self, digits: int) -> Enclosure:
        """γ of a bounded function to so many digits."""
        if self.enclosure is None:
            raise ValueError("an unbounded function has no γ")
        if digits <= DIGITS or self.enclosure.width == 0:
            return self.enclosure
        if self.m is None:
            return _of_family(self.family, digits)
        return _of_member(self.m, digits)

    def squared_less(self, s: Fraction) -> bool:
        """Decide γ² < s.

        Soundness: γ_m by ``gamma_less_than``, which never leaves it open; a γ that is known exactly by
        rationals; π/2 by ever tighter enclosures, which end because no rational equals its square.
        """
        if self.enclosure is None:
            return False
        if self.m is not None:
            return gamma_less_than(self.m, s)
        digits, known = DIGITS, self.enclosure
        while known.width and known.lower**2 < s < known.upper**2:
            digits *= 2
            known = self.within(digits)
        return known.upper**2 < s or (known.width > 0 and known.upper**2 == s)

    def squared_is_root(self, c0: Fraction, c1: Fraction, c2: Fraction) -> bool:
        """Whether c0 + c1 γ² + c2 γ⁴ = 0, exactly; the coefficients are not all 0.

        Soundness: γ_m² = A²/W with A = 2m(1 + u) − 1 and W = 4m² u(1 + u), where u is the only positive root
        of P = u^m − 2m u − (2m − 1) (Descartes). So γ_m² is a root exactly when u is a common root of P and
        c0 W² + c1 A² W + c2 A⁴, that is when their greatest common divisor has a positive root. It divides P,
        so it has at most one, a simple one, and then its sign at 0 differs from that at infinity. A
        transcendental γ is a root of nothing.
        """
        if self.enclosure is None:
            return False
        if self.enclosure.width == 0:
            x = self.enclosure.lower**2
            return c0 + c1 * x + c2 * x * x == 0
        if self.m is None:
            return False
        a, w = fmpq_poly([2 * self.m - 1, 2 * self.m]) ** 2, 4 * self.m**2 * fmpq_poly([0, 1, 1])
        k0, k1, k2 = (fmpq(c.numerator, c.denominator) for c in (c0, c1, c2))
        common = _peak_equation(self.m).gcd(k0 * w * w + k1 * a * w + k2 * a * a)
        return bool(common.degree() >= 1 and common[0] * common[common.degree()] < 0)


def _peak_equation(m: int) -> fmpq_poly:
    """u^m − 2m u − (2m − 1), for m >= 2."""
    return fmpq_poly([0] * m + [1]) - fmpq_poly([2 * m - 1, 2 * m])


@lru_cache(maxsize=1024)
def _of_member(m: int, digits: int) -> Enclosure:
    """γ_m, for m >= 2."""
    with precision(4 * digits + 64):
        return Enclosure.from_arb(gamma_value(m, peak_of_h(m)))


@lru_cache(maxsize=64)
def _of_family(family: str, digits: int) -> Enclosure:
    from lyapcheck.family import named

    gamma = named(family).constants(digits).gamma
    assert gamma is not None
    return gamma


def gamma_of(gain_set: GainSet, source: str = "true") -> GammaBound:
    """γ of a gain set: the true one, or the one the paper prints.

    Raises:
        InputError: the paper prints no γ for this m.
    """
    if source == "printed":
        if gain_set.family != "hyperbolic" or gain_set.m not in PRINTED:
            raise argument_error(
                "--gamma", source, f"the paper prints no γ for {gain_set.name}", "use the true γ"
            )
        return GammaBound(Enclosure.exact(PRINTED[gain_set.m]))
    if gain_set.family == "hyperbolic" and gain_set.m is not None:
        return GammaBound(hyperbolic_constants(gain_set.m, DIGITS).gamma, gain_set.m)
    if gain_set.family == "linear":
        return GammaBound(None)
    return GammaBound(_of_family(gain_set.family, DIGITS), family=gain_set.family)
