"""What the conditions compare gains with: terms of which the checker judges and whose digits are shown.

scaled   budget/(√n γ)        of (10p) and (19), which gains must stay below; of (10i) with n = 1
norms    (√T − √G)/(√n γ)     of (10), which gains must not exceed; T = ‖τmax‖² and G = k_g²
"""

from __future__ import annotations

from fractions import Fraction
from math import floor, isqrt
from typing import TYPE_CHECKING

from lyapcheck.check.expressions.expression import Tree, ball
from lyapcheck.check.expressions.normal_form import normal_form
from lyapcheck.check.kinds.constant import Constant, ExactNumbers, SeparateBalls
from lyapcheck.check.numbers.balls import precision
from lyapcheck.check.numbers.polynomials import Enclosure, fraction
from lyapcheck.check.replay import MAX_BITS
from lyapcheck.check.statement import Relation, Witness
from lyapcheck.control.judgement import JudgedStatement, judged_statement
from lyapcheck.files.decimals import Written, exact_decimal
from lyapcheck.output.digits import scaled_text

if TYPE_CHECKING:
    from collections.abc import Iterable, Iterator

    from lyapcheck.check.kinds.for_all import ForAll
    from lyapcheck.check.statement import Proof

FIRST = SeparateBalls(128)
"""What decides nearly always."""
FIRST_BITS = 160
ONE: Tree = ("num", "1")
LARGEST_DIVISOR = 2000
"""Squares of numbers up to it are taken out of roots."""


class Threshold:
    """A real number that positive values must stay below, or must not exceed.

    Args:
        budget: the number without √n γ.
        n: number of joints.
        gamma: γ; ``None`` where h is unbounded, so that no value passes.
        operator: ``<`` or ``<=``.
    """

    def __init__(self, budget: Tree, n: int, gamma: Tree | None, operator: str = "<") -> None:
        self.bounded, self.operator = gamma is not None, operator
        below = [factor for factor in (root(Fraction(n)), gamma or ONE) if factor != ONE]
        product = below[0] if len(below) == 1 else ("mul", *below)
        self.limit = ("div", budget, product) if below else budget
        self._known: dict[tuple[int, int], JudgedStatement] = {}
        self._near: dict[int, Enclosure] = {}
        self._largest: dict[int, Written | None] = {}

    def judged(self, value: Fraction, places: int = 0) -> JudgedStatement:
        """What the checker says of a positive value with so many decimal places."""
        key = value.as_integer_ratio()  # hashing a fraction takes longer
        known = self._known.get(key)
        if known is None:
            proofs: Iterable[Proof] = _proofs(places)
            if not self.bounded:
                # an x where value·h(x) = value·x is above the limit
                x = Fraction(max(0, self.near().upper // (value or 1)) + 1)
                proofs = [Witness((("x", x),))]
            known = self._known[key] = judged_statement(self.asked(value), proofs)
        return known

    def asked(self, value: Fraction) -> Constant | ForAll:
        """That a positive value passes; where h is unbounded, that value·h(x) = value·x does for all x."""
        if self.bounded:
            return Constant(Relation(number(value), self.operator, self.limit))
        from lyapcheck.check.kinds.for_all import ForAll

        product = ("mul", number(value), ("var", "x"))
        return ForAll(Relation(product, self.operator, self.limit), Fraction(0))

    def admits(self, value: Fraction, places: int = 0) -> bool:
        return self.judged(value, places).shown == "proved"

    def near(self, places: int = 0) -> Enclosure:
        """The number between two others that tell decimals of so many places apart."""
        bits = FIRST_BITS + 4 * (places - places % 16)
        if bits not in self._near:
            result = self._within(bits)
            wide = floor(result.width * 10**places).bit_length()
            self._near[bits] = self._within(bits + wide + 4) if wide else result
        return self._near[bits]

    def apart(self, value: Fraction, places: int = 0) -> Enclosure:
        """As `near`, and without the value, unless the number is known to be it or cannot be told from it."""
        result, bits = self.near(places), FIRST_BITS + 4 * places
        while _between(result, value) and result.width and bits < MAX_BITS:
            bits *= 2
            result = self._within(bits)
        return result

    def largest(self, places: int) -> Written | None:
        """The largest decimal of so many places that the checker proves to pass, of more where it takes more.

        ``None`` where no positive value passes.
        """
        if places not in self._largest:
            units, most, near = self.most_units(places), places, self.near(places)
            if units == 0 and near.lower > 0:
                while near.lower * 10**most < 10:
                    most += 1
                units = self.most_units(most)
            self._largest[places] = exact_decimal(scaled_text(units, most)) if units else None
        return self._largest[places]

    def most_units(self, places: int) -> int:
        """The largest number of units in so many places that passes; 0 where none does."""
        near, scale = self.near(places), 10**places
        most = floor(near.upper * scale) if self.bounded else 0
        # beside the last decimal before the limit, one more where the limit itself is a decimal
        tried = (units for units in range(most, max(0, most - 3), -1))
        return next((units for units in tried if self.admits(Fraction(units, scale), places)), 0)

    def _within(self, bits: int) -> Enclosure:
        """The number to about so many bits; exactly, where it is rational."""
        ratio, _ = normal_form(self.limit)
        ratio = ratio.lowest()
        if ratio.top.is_constant() and ratio.bottom.is_constant():
            top = ratio.top.leading_coefficient() if ratio.top != 0 else 0
            value = top / ratio.bottom.leading_coefficient()
            return Enclosure.exact(fraction(value))
        with precision(bits):
            return Enclosure.from_arb(ball(self.limit))


def scaled(budget: Fraction, n: int, gamma: Tree | None, operator: str = "<") -> Threshold:
    """budget/(√n γ), which values must stay below, or must not exceed."""
    return Threshold(number(budget), n, gamma, operator)


def norms(torque_squared: Fraction, gravity_squared: Fraction, n: int, gamma: Tree | None) -> Threshold:
    """(√T − √G)/(√n γ), which values must not exceed, N·m.

    References: (10) of reyes2019family.
    """
    T, G = (x.numerator * x.denominator for x in (torque_squared, gravity_squared))
    # roots of numbers whose quotient is no square are never multiples of each other
    short = not G or isqrt(T * G) ** 2 == T * G
    sides = [root(x) if short else ("sqrt", number(x)) for x in (torque_squared, gravity_squared)]
    budget: Tree = ("add", sides[0], ("neg", sides[1])) if G else sides[0]
    return Threshold(budget, n, gamma, "<=")


def root(square: Fraction) -> Tree:
    """√square with the squares taken out: √8 = 2√2, so that equal numbers are equal terms."""
    whole = square.numerator * square.denominator
    outside, inside = _square_out(whole)
    factor = Fraction(outside, square.denominator)
    if inside == 1 or whole == 0:
        return number(factor if whole else Fraction(0))
    surd: Tree = ("sqrt", number(Fraction(inside)))
    return surd if factor == 1 else ("mul", number(factor), surd)


def _between(ends: Enclosure, value: Fraction) -> bool:
    """Whether a value lies between two others; in integers, since comparing fractions takes longer."""
    n, d = value.as_integer_ratio()
    a, b = ends.lower.as_integer_ratio()
    if a * d > n * b:
        return False
    e, f = ends.upper.as_integer_ratio()
    return n * f <= e * d


def _square_out(whole: int) -> tuple[int, int]:
    """a, b with a²b = whole; b without a square that is easily found."""
    if isqrt(whole) ** 2 == whole:
        return isqrt(whole), 1
    outside, inside, rest, divisor = 1, 1, whole, 2
    while divisor <= LARGEST_DIVISOR and divisor * divisor <= rest:
        while rest % (divisor * divisor) == 0:
            outside, rest = outside * divisor, rest // (divisor * divisor)
        if rest % divisor == 0:
            inside, rest = inside * divisor, rest // divisor
        divisor += 1
    if isqrt(rest) ** 2 == rest:
        return outside * isqrt(rest), inside
    return outside, inside * rest


def number(value: Fraction) -> Tree:
    """A rational as a term."""
    return "num", f"{value.numerator}/{value.denominator}" if value.denominator > 1 else str(value.numerator)


def _proofs(places: int) -> Iterator[Proof]:
    """Balls, exact numbers, which decide where both sides are equal, then ever smaller balls."""
    yield FIRST
    yield ExactNumbers()
    bits = FIRST_BITS + 4 * places
    while bits < MAX_BITS:
        bits *= 2
        yield SeparateBalls(min(bits, MAX_BITS))
