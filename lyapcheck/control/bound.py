"""γ, the bound of a bounded function, as the conditions need it: compared exactly with any rational."""

from __future__ import annotations

from dataclasses import dataclass
from fractions import Fraction

from lyapcheck.check.constants import gamma_less_than, hyperbolic_constants
from lyapcheck.check.enclosure import Enclosure
from lyapcheck.control.gains import GainSet
from lyapcheck.errors import argument_error

PRINTED = {1: Fraction(1), 2: Fraction(105, 100), 3: Fraction(111, 100)}
"""γ_1, γ_2, γ_3 as the paper prints them (Table 2): the last two are below the true ones."""

DIGITS = 30


@dataclass(frozen=True)
class GammaBound:
    """γ of one gain set: an enclosure to show, and the exact decision γ² < s to decide with.

    ``enclosure`` is ``None`` for an unbounded function, whose γ is below nothing.
    """

    enclosure: Enclosure | None
    m: int | None = None

    def squared_less(self, s: Fraction) -> bool:
        """Decide γ² < s.

        Soundness: γ_m by ``gamma_less_than``, which never leaves it open; a γ that is known exactly by
        rationals; π/2 by an enclosure, and no rational equals its square.
        """
        if self.enclosure is None:
            return False
        if self.m is not None:
            return gamma_less_than(self.m, s)
        low, high = self.enclosure.lower**2, self.enclosure.upper**2
        if self.enclosure.width == 0 or not low < s < high:
            return high < s or (self.enclosure.width > 0 and high == s)
        raise ArithmeticError(f"{DIGITS} digits of γ do not decide γ² < {s}")


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
    from lyapcheck.family import named

    return GammaBound(named(gain_set.family).constants(DIGITS).gamma)
