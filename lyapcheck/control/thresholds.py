"""The numbers that the conditions compare gains with, and which rationals pass, decided exactly.

With s = √n γ they are

    scaled   budget/s          of (10p) and (19), which gains must stay below
    norms    (√T − √G)/s       of (10), which gains must not exceed; T = ‖τmax‖² and G = k_g²

Brackets of rising precision in integer arithmetic decide all but equality. x = budget/s is equality exactly
where γ² = budget²/(n x²), and x = (√T − √G)/s where x is the smaller root of the rational quadratic in x²

    n²γ⁴ x⁴ − 2 nγ² (T + G) x² + (T − G)² = 0,

whose larger root is (√T + √G)/s: questions about γ² that algebra answers.
"""

from __future__ import annotations

from fractions import Fraction
from math import isqrt

from lyapcheck.control.bound import FIRST_BITS, GammaBound
from lyapcheck.control.bracket import Bracket
from lyapcheck.files.decimals import Written, exact_decimal, scaled_text

TYPE_CHECKING = False
if TYPE_CHECKING:
    from collections.abc import Callable


class Threshold:
    """A real number that positive values are compared with.

    Args:
        within: the number in a bracket of about 2^-bits of it.
        equals: decides whether a positive rational is the number.
        strict: whether the number itself does not pass.

    Soundness: that of the two functions.
    """

    def __init__(
        self, within: Callable[[int], Bracket], equals: Callable[[Fraction], bool], strict: bool = True
    ) -> None:
        self.within, self.equals, self.strict = within, equals, strict
        self._near: dict[int, Bracket] = {}
        self._largest: dict[int, Written | None] = {}

    def near(self, places: int = 0) -> Bracket:
        """A bracket that tells decimals of so many places apart."""
        bits = FIRST_BITS + 4 * (places - places % 16)
        if bits not in self._near:
            found = self.within(bits)
            wide = ((found.high - found.low) * 10**places // found.den).bit_length()
            self._near[bits] = self.within(bits + wide + 4) if wide else found
        return self._near[bits]

    def apart(self, value: Fraction, places: int = 0) -> Bracket:
        """A bracket that a positive value lies outside of, or that holds nothing but it."""
        found, bits = self.near(places), FIRST_BITS + 4 * places
        while found.side(value) == 0:
            if self.equals(value):
                return Bracket.exact(value)
            bits *= 2
            found = self.within(bits)
        return found

    def admits(self, value: Fraction) -> bool:
        """Decide whether a positive value passes."""
        return self.passes(self.apart(value).side(value))

    def passes(self, side: int) -> bool:
        """Whether a value on that side of a bracket that ``apart`` gave passes."""
        return side < 0 or (side == 0 and not self.strict)

    def largest(self, places: int) -> Written | None:
        """The largest decimal of so many places that passes, of more where it takes more.

        ``None`` where no positive value passes.
        """
        if places not in self._largest:
            units, most, near = self.most_units(places), places, self.near(places)
            if units == 0 and near.low > 0:
                while near.low * 10**most < 10 * near.den:
                    most += 1
                units = self.most_units(most)
            self._largest[places] = exact_decimal(scaled_text(units, most)) if units else None
        return self._largest[places]

    def most_units(self, places: int) -> int:
        """The largest number of units in so many places that passes; 0 where none does."""
        near = self.near(places)
        scale: int = 10**places
        low, high = max(0, near.low * scale // near.den - 1), max(0, near.high * scale // near.den)
        while low < high:
            middle = (low + high + 1) // 2
            low, high = (middle, high) if self.admits(Fraction(middle, scale)) else (low, middle - 1)
        return low


def scaled(budget: Fraction, n: int, gamma: GammaBound) -> Threshold:
    """budget/(√n γ), which values must stay below."""

    def within(bits: int) -> Bracket:
        low, high, den = _root(Fraction(n), bits)
        near = gamma.within(bits)
        top, bottom = budget.numerator * den * near.den, budget.denominator
        ends = Fraction(top, bottom * high * near.high), Fraction(top, bottom * low * near.low)
        return _outward(min(ends), max(ends), bits)

    def equals(value: Fraction) -> bool:
        return budget > 0 and gamma.squared_is_root(-(budget**2), n * value**2, Fraction(0))

    return Threshold(within, equals)


def norms(torque_squared: Fraction, gravity_squared: Fraction, n: int, gamma: GammaBound) -> Threshold:
    """(√T − √G)/(√n γ), which values must not exceed, N·m.

    References: (10) of reyes2019family.
    """
    T, G = torque_squared, gravity_squared

    def within(bits: int) -> Bracket:
        (t_low, t_high, t_den), (g_low, g_high, g_den) = _root(T, bits), _root(G, bits)
        n_low, n_high, n_den = _root(Fraction(n), bits)
        near = gamma.within(bits)
        low = Fraction(t_low * g_den - g_high * t_den, t_den * g_den)
        high = Fraction(t_high * g_den - g_low * t_den, t_den * g_den)
        small = Fraction(n_low * near.low, n_den * near.den)
        large = Fraction(n_high * near.high, n_den * near.den)
        return _outward(low / (large if low > 0 else small), high / (small if high > 0 else large), bits)

    def equals(value: Fraction) -> bool:
        """Of the two roots of the quadratic only the smaller is below (T + G)/s; for G = 0 they are one."""
        s = n * value**2
        if T <= G or not gamma.squared_is_root((T - G) ** 2, -2 * s * (T + G), s * s):
            return False
        return G == 0 or gamma.squared_less((T + G) / s)

    return Threshold(within, equals, strict=False)


def _root(square: Fraction, bits: int) -> tuple[int, int, int]:
    """Integers a, b, d with a/d ≤ √square ≤ b/d, equal where the root is rational."""
    top, bottom = isqrt(square.numerator), isqrt(square.denominator)
    if top * top == square.numerator and bottom * bottom == square.denominator:
        return top, top, bottom
    # as many bits behind the point as a small root needs to have ``bits`` of its own
    shift = bits + max(0, square.denominator.bit_length() - square.numerator.bit_length())
    root = isqrt((square.numerator << 2 * shift) // square.denominator)
    return root, root + 1, 1 << shift


def _outward(low: Fraction, high: Fraction, bits: int) -> Bracket:
    """The bracket over a power of two, for quick comparisons; a number that is known exactly stays so."""
    if low == high:
        return Bracket.exact(low)
    size = max(abs(low), abs(high))
    shift = bits + max(0, size.denominator.bit_length() - size.numerator.bit_length())
    return Bracket(
        (low.numerator << shift) // low.denominator,
        -((-high.numerator << shift) // high.denominator),
        1 << shift,
    )
