"""Running errors: how far a program in doubles is from the same program in real numbers, in balls.

A value is a ball that holds the exact number, and a bound of |computed − exact|. With u = 2⁻⁵³ and
η = 2⁻¹⁰⁷⁴ one operation of IEEE 754, to nearest, gives x̂ ∘ ŷ up to u |x̂ ∘ ŷ| + η. The bounds hold as well
where a compiler fuses a product with a sum: that leaves out a rounding that is counted here.

References: running error analysis, ``higham2002accuracy`` section 3.3.
"""

from __future__ import annotations

from dataclasses import dataclass
from fractions import Fraction

from flint import arb

from lyapcheck.check.numbers.balls import to_arb

BITS = 160
U = arb(2) ** -53
TINY = arb(2) ** -1074
LARGEST = arb(2) ** 1000
"""No value may come near the largest double, so that nothing overflows."""


class Unbounded(ArithmeticError):
    """An operation whose error has no bound over these balls: a divisor that may be 0, or an overflow."""


@dataclass(frozen=True)
class Rounded:
    """A number and its computed double.

    Args:
        exact: a ball that holds the number.
        error: at least |computed − exact|.
    """

    exact: arb
    error: arb

    @classmethod
    def constant(cls, value: Fraction) -> Rounded:
        """An exact number, which C has as the nearest double."""
        return cls(to_arb(value), upper(to_arb(abs(Fraction(float(value)) - value))))

    @property
    def size(self) -> arb:
        """At least |computed| and |exact|."""
        return upper(self.exact.abs_upper() + self.error)

    def __add__(self, other: Rounded) -> Rounded:
        return _rounded(self.exact + other.exact, self.error + other.error)

    def __sub__(self, other: Rounded) -> Rounded:
        return _rounded(self.exact - other.exact, self.error + other.error)

    def __mul__(self, other: Rounded) -> Rounded:
        # x̂ŷ − xy = (x̂ − x) ŷ + x (ŷ − y)
        error = self.error * other.size + self.exact.abs_upper() * other.error
        return _rounded(self.exact * other.exact, error)

    def __truediv__(self, other: Rounded) -> Rounded:
        # x̂/ŷ − x/y = ((x̂ − x) − (x/y) (ŷ − y))/ŷ
        least = (other.exact.abs_lower() - other.error).lower()
        if not least > 0:
            raise Unbounded("a divisor may be 0")
        exact = self.exact / other.exact
        return _rounded(exact, (self.error + exact.abs_upper() * other.error) / least)

    def __neg__(self) -> Rounded:
        return Rounded(-self.exact, self.error)


def _rounded(exact: arb, error: arb) -> Rounded:
    """After one rounding of a computed result within ``error`` of ``exact``."""
    size = upper(exact.abs_upper() + error)
    if not size < LARGEST:
        raise Unbounded("a value may overflow")
    return Rounded(exact, upper(error + U * size + TINY))


def upper(x: arb) -> arb:
    """The upper end of a ball, exactly."""
    return x.upper()
