"""Expressions as quotients of polynomials over ℚ: the normal form in which identities are decided.

The generators are the variables, one E = exp(t) for each monomial t that is exponentiated (so that sinh t is
(E − 1/E)/2), one pair (sin a, cos a) with cos² = 1 − sin², and one generator for each other function of each
argument (a square root with its square as a relation). Equal normal forms mean equal functions wherever both
sides are defined; different ones mean nothing when opaque functions (log, atan, …) occur.

References: ``geddes1992algorithms``, chapter 3.
"""

from __future__ import annotations

from dataclasses import dataclass, field
from fractions import Fraction
from functools import lru_cache

from flint import Ordering, arb, fmpq, fmpq_mpoly, fmpq_mpoly_ctx

from lyapcheck.check.expressions.expression import (
    CONSTANTS,
    FUNCTIONS,
    Algebra,
    Tree,
    Unsupported,
    evaluate,
    family_constant,
    nodes,
    variables,
)
from lyapcheck.check.expressions.grammar import MAX_SIZE, written_out
from lyapcheck.check.numbers.polynomials import fraction, rational, rational_root

MAX_STEPS = 5_000_000
"""Products of two terms each that the product of two polynomials may take."""
ODD = ("atan", "asin", "tan")
AT_ZERO = {"sin": 0, "cos": 1, "tan": 0, "atan": 0, "asin": 0, "abs": 0}
WITH_GENERATORS = frozenset((*FUNCTIONS, "gamma", "rho", "L", "pi", "h", "dh", "potential"))


@dataclass(frozen=True)
class Ratio:
    """``top / bottom`` with a bottom that is not the zero polynomial."""

    top: fmpq_mpoly
    bottom: fmpq_mpoly

    def __add__(self, other: Ratio) -> Ratio:
        if self.bottom == other.bottom:
            return Ratio(self.top + other.top, self.bottom)
        common = self.bottom.gcd(other.bottom)
        left, right = self.bottom / common, other.bottom / common
        top = product(self.top, right) + product(other.top, left)
        return Ratio(top, product(left, other.bottom))

    def __neg__(self) -> Ratio:
        return Ratio(-self.top, self.bottom)

    def __sub__(self, other: Ratio) -> Ratio:
        return self + (-other)

    def __mul__(self, other: Ratio) -> Ratio:
        return Ratio(product(self.top, other.top), product(self.bottom, other.bottom))

    def __truediv__(self, other: Ratio) -> Ratio:
        if other.top == 0:
            raise Unsupported("division by an expression that is identically zero")
        return Ratio(product(self.top, other.bottom), product(self.bottom, other.top))

    def lowest(self) -> Ratio:
        """The same quotient in lowest terms, with a leading coefficient of 1 below."""
        common = self.top.gcd(self.bottom)
        top, bottom = self.top / common, self.bottom / common
        lead = bottom.leading_coefficient()
        return Ratio(top / lead, bottom / lead)


@dataclass
class RationalAlgebra(Algebra):
    """The arithmetic of :class:`Ratio`, which hands out generators as functions come up."""

    names: list[str]
    slots: int
    uses: dict[tuple[str, str], int] = field(default_factory=dict)
    squares: dict[int, fmpq_mpoly] = field(default_factory=dict)
    opaque: set[str] = field(default_factory=set)

    def __post_init__(self) -> None:
        generators = [f"v{i}" for i in range(len(self.names))] + [f"g{i}" for i in range(self.slots)]
        self.ring = fmpq_mpoly_ctx.get(generators or ["unused"], Ordering.lex)
        self.one = self.ring.constant(1)

    def variable(self, name: str) -> Ratio:
        return Ratio(self.ring.gen(self.names.index(name)), self.one)

    def number(self, value: Fraction) -> Ratio:
        return Ratio(self.ring.constant(rational(value)), self.one)

    def constant(self, name: str, m: int) -> Ratio:
        """γ_1 = ρ_1 = L_1 = 1; the others are not rational and become generators."""
        return self.number(Fraction(1)) if m == 1 else self._generator(name, str(m))

    def pi(self) -> Ratio:
        """A generator: π is transcendental."""
        return self._generator("pi", "")

    def function(self, name: str, value: Ratio) -> Ratio:
        value = Ratio(self.reduced(value.top), self.reduced(value.bottom)).lowest()
        if value.top == 0 and name in AT_ZERO:
            return self.number(Fraction(AT_ZERO[name]))
        if name == "log" and value.top == value.bottom:
            return self.number(Fraction(0))
        if name == "exp":
            return self._exponential(value)
        if name in ("sinh", "cosh", "tanh"):
            grow, half = self._exponential(value), self.number(Fraction(1, 2))
            fall = self.number(Fraction(1)) / grow
            sinh, cosh = (grow - fall) * half, (grow + fall) * half
            return {"sinh": sinh, "cosh": cosh, "tanh": sinh / cosh}[name]
        if name in ("sin", "cos"):
            sin = self._generator("sin", str(value))
            cos = self._generator("cos", str(value))
            self.squares[self.uses["cos", str(value)]] = self.one - sin.top * sin.top
            return sin if name == "sin" else cos
        return self._root(value) if name == "sqrt" else self._opaque(name, value)

    def _exponential(self, value: Ratio) -> Ratio:
        if not value.bottom.is_constant():
            return self._opaque("exp", value)
        result = self.number(Fraction(1))
        polynomial = value.top / value.bottom.leading_coefficient()
        for exponents, coefficient in polynomial.to_dict().items():
            if coefficient.q != 1 or not any(exponents):
                raise Unsupported("exp of a number or of a fractional multiple has no normal form here")
            base = self._generator("exp", str(exponents))
            power = Ratio(base.top ** abs(int(coefficient.p)), self.one)
            result = result * power if coefficient > 0 else result / power
        return result

    def _root(self, value: Ratio) -> Ratio:
        """√(top/bottom) = √(top·bottom)/bottom for a positive number below; its square is known."""
        if not value.bottom.is_constant():
            return self._opaque("sqrt", value)
        radicand = value.top / value.bottom.leading_coefficient()
        if radicand.is_constant():
            number = radicand.leading_coefficient() if radicand != 0 else fmpq(0)
            exact = rational_root(fraction(number))
            if exact is not None:
                return self.number(exact)
        root = self._generator("sqrt", str(radicand))
        self.squares[self.uses["sqrt", str(radicand)]] = radicand
        return root

    def _opaque(self, name: str, value: Ratio) -> Ratio:
        """A generator; f(−x) = −f(x) for the functions that are odd."""
        if name in ODD and value.top != 0 and value.top.leading_coefficient() < 0:
            return -self._opaque(name, -value)
        self.opaque.add(name)
        return self._generator(name, str((str(value.top), str(value.bottom))))

    def _generator(self, name: str, argument: str) -> Ratio:
        index = self.uses.setdefault((name, argument), len(self.names) + len(self.uses))
        if index >= len(self.names) + self.slots:
            raise Unsupported("exp of a sum of so many terms")
        return Ratio(self.ring.gen(index), self.one)

    def constants(self) -> dict[int, arb]:
        """The generators that are numbers (γ_m, π, √3, …), with balls for them; √−3 is none."""
        result = {}
        for (name, argument), index in self.uses.items():
            if name in CONSTANTS:
                result[index] = family_constant(name, int(argument))
            elif name == "pi":
                result[index] = arb.pi()
            elif name == "sqrt" and index in self.squares and self.squares[index].is_constant():
                result[index] = arb(self.squares[index].leading_coefficient()).sqrt()
        return {index: number for index, number in result.items() if number.is_finite()}

    def reduced(self, polynomial: fmpq_mpoly) -> fmpq_mpoly:
        """The polynomial with every square of a root and of a cosine replaced by what it equals."""
        for index, square in self.squares.items():
            while polynomial.degrees()[index] >= 2:
                polynomial = self._replace_square(polynomial, index, square)
        return polynomial

    def _replace_square(self, polynomial: fmpq_mpoly, index: int, square: fmpq_mpoly) -> fmpq_mpoly:
        keep: dict[tuple[int, ...], fmpq] = {}
        lower: dict[tuple[int, ...], fmpq] = {}
        for exponents, coefficient in polynomial.to_dict().items():
            if exponents[index] >= 2:
                lower[(*exponents[:index], exponents[index] - 2, *exponents[index + 1 :])] = coefficient
            else:
                keep[exponents] = coefficient
        return self.ring.from_dict(keep) + product(self.ring.from_dict(lower), square)


def product(left: fmpq_mpoly, right: fmpq_mpoly) -> fmpq_mpoly:
    """The product, unless it takes too many steps: a short text may stand for a polynomial without end."""
    if len(left) * len(right) > MAX_STEPS:
        raise Unsupported(f"a product of polynomials with {len(left)} and {len(right)} terms")
    return left * right


def normal_form(tree: Tree) -> tuple[Ratio, RationalAlgebra]:
    """The reduced quotient of polynomials that an expression is, where it is one (``Unsupported``)."""
    if written_out(tree, {}) > MAX_SIZE:
        raise Unsupported(f"more than {MAX_SIZE} parts with all powers written out")
    names = sorted(variables(tree))
    algebra = RationalAlgebra(names, room_for(tree))
    ratio = evaluate(tree, {name: algebra.variable(name) for name in names}, algebra)
    return Ratio(algebra.reduced(ratio.top), algebra.reduced(ratio.bottom)), algebra


def rational_value(tree: Tree) -> fmpq | None:
    """The value of a number whose normal form is rational, else ``None``."""
    try:
        ratio, _ = normal_form(tree)
    except (Unsupported, ZeroDivisionError):
        return None
    if not (ratio.top.is_constant() and ratio.bottom.is_constant()):
        return fmpq(0) if ratio.top == 0 else None
    return fmpq(0) if ratio.top == 0 else ratio.top.leading_coefficient() / ratio.bottom.leading_coefficient()


def is_zero(tree: Tree) -> bool:
    """Whether the normal form of an expression, if it has one, is zero; ``False`` says nothing.

    Soundness: every relation that is used (squares of roots, sin² + cos² = 1, products of exponentials) holds
    for the real functions, so a zero normal form is a zero function wherever no denominator vanishes.
    """
    if written_out(tree, {}) > MAX_SIZE:  # before it is compared with others: parts may be shared without end
        raise Unsupported(f"more than {MAX_SIZE} parts with all powers written out")
    return _is_zero(tree)


@lru_cache(maxsize=32)
def _is_zero(tree: Tree) -> bool:
    return bool(normal_form(tree)[0].top == 0)


def room_for(*trees: Tree) -> int:
    """Generators that expressions need beside their variables: two for each function of each argument."""
    result = {node for node in nodes(*trees) if node[0] in WITH_GENERATORS}
    return 2 * len(result) + 4
