"""γ, the bound of a bounded function, as the conditions need it: compared exactly with any rational."""

from __future__ import annotations

from fractions import Fraction
from functools import lru_cache

from lyapcheck.control.bracket import Bracket
from lyapcheck.control.peak import gamma_between
from lyapcheck.errors import argument_error
from lyapcheck.records import Record

TYPE_CHECKING = False
if TYPE_CHECKING:
    from lyapcheck.check.numbers.enclosure import Enclosure
    from lyapcheck.control.gains import GainSet

PRINTED = {1: Fraction(1), 2: Fraction(105, 100), 3: Fraction(111, 100)}
"""γ_1, γ_2, γ_3 as the paper prints them (Table 2): the last two are below the true ones."""

FIRST_BITS = 160


class GammaBound(Record):
    """γ of one gain set: brackets of any width, and whether γ² is a given algebraic number.

    Args:
        exactly: γ where it is a rational number.
        m: the member, where γ is γ_m of the hyperbolic family, m ≥ 2.
        family: the family, where γ is a transcendental number that the family encloses to any precision.

    With none of these the function is unbounded, and γ is infinite.
    """

    exactly: Fraction | None = None
    m: int | None = None
    family: str = ""

    @property
    def finite(self) -> bool:
        """Whether the function is bounded."""
        return self.exactly is not None or self.m is not None or bool(self.family)

    def within(self, bits: int) -> Bracket:
        """γ of a bounded function in a bracket of about 2^-bits."""
        if self.exactly is not None:
            return Bracket.exact(self.exactly)
        if self.m is not None:
            return Bracket(*gamma_between(self.m, bits), 1 << bits)
        if not self.family:
            raise ValueError("an unbounded function has no γ")
        found = _of_family(self.family, bits * 3 // 10)
        den = found.lower.denominator * found.upper.denominator
        return Bracket(int(found.lower * den), int(found.upper * den), den)

    def squared_is_root(self, c0: Fraction, c1: Fraction, c2: Fraction) -> bool:
        """Whether c0 + c1 γ² + c2 γ⁴ = 0, exactly; the coefficients are not all 0.

        Soundness: a rational γ is put in; γ_m as in ``ties``; a transcendental γ is a root of nothing.
        """
        if self.exactly is not None:
            x = self.exactly**2
            return c0 + c1 * x + c2 * x * x == 0
        if self.m is None:
            return False
        from lyapcheck.control.ties import gamma_squared_is_root

        return gamma_squared_is_root(self.m, c0, c1, c2)

    def squared_less(self, s: Fraction) -> bool:
        """Decide γ² < s."""
        if not self.finite or s <= 0:
            return False
        bits = FIRST_BITS
        while True:
            near = self.within(bits)
            if near.high**2 * s.denominator < s.numerator * near.den**2:
                return True
            if near.low**2 * s.denominator > s.numerator * near.den**2:
                return False
            if self.squared_is_root(-s, Fraction(1), Fraction(0)):
                return False
            bits *= 2


@lru_cache(maxsize=64)
def _of_family(family: str, digits: int) -> Enclosure:
    from lyapcheck.family import named

    gamma = named(family).constants(digits + 2).gamma
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
        return GammaBound(PRINTED[gain_set.m])
    if gain_set.family == "hyperbolic":
        return GammaBound(Fraction(1)) if gain_set.m == 1 else GammaBound(m=gain_set.m)
    if gain_set.family == "linear":
        return GammaBound()
    known = _of_family(gain_set.family, FIRST_BITS // 3)
    return GammaBound(known.lower) if known.width == 0 else GammaBound(family=gain_set.family)
