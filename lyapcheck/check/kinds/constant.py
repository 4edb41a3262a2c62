"""Relations between numbers: exactly where the difference is rational, else by balls that do not touch."""

from __future__ import annotations

import re
from dataclasses import dataclass
from decimal import Decimal
from fractions import Fraction

from flint import arb, ctx

from lyapcheck.check.expressions.domain import Domain, Interval, sign_holds
from lyapcheck.check.expressions.expression import Tree, ball
from lyapcheck.check.expressions.grammar import require_expressions
from lyapcheck.check.expressions.normal_form import rational_value
from lyapcheck.check.expressions.text import expression_text
from lyapcheck.check.numbers.polynomials import Enclosure
from lyapcheck.check.refusal import Refused, require
from lyapcheck.check.replay import relation_text, require_bits, require_distinct, require_relations, terms_of
from lyapcheck.check.statement import OfTerms, Proof, Relation
from lyapcheck.check.verify import Accepted, rule

MOST_BALLS = 256
_BALLS: dict[tuple[int, int], tuple[Tree, arb]] = {}


@dataclass(frozen=True)
class Constant(OfTerms):
    """A relation between numbers."""

    relation: Relation

    def require_well_formed(self) -> None:
        require_relations([self.relation], [])

    def terms(self) -> list[tuple[Tree, Domain]]:
        return terms_of([self.relation], {})

    def text(self) -> str:
        return relation_text(self.relation)


@dataclass(frozen=True)
class ExactNumbers(Proof):
    """The difference of both sides is rational, or its normal form is zero."""

    rule = "exact numbers"


@dataclass(frozen=True)
class SeparateBalls(Proof):
    """Both sides lie in balls of ``bits`` that tell them apart."""

    rule = "separate balls"
    bits: int


@rule(Constant, ExactNumbers)
def by_exact_numbers(statement: Constant, proof: ExactNumbers) -> Accepted:
    """Soundness: the sign of one rational number."""
    truth = exact_truth(statement.relation)
    if truth is None:
        raise Refused("difference", "", "of both sides is not rational")
    return _with_values(statement, truth, "exact")


@rule(Constant, SeparateBalls)
def by_separate_balls(statement: Constant, proof: SeparateBalls) -> Accepted:
    """Soundness: the ball of the difference does not touch 0."""
    relation = statement.relation
    with ctx.workprec(require_bits(proof.bits)):
        truth = sign_holds(_ball(relation.right) - _ball(relation.left), relation.operator)
    if truth is None:
        raise Refused("bits", proof.bits, "are too few to tell both sides apart")
    return _with_values(statement, truth, "enclosure")


def _ball(tree: Tree) -> arb:
    """A ball for a side; that of an operation is kept, since one limit is compared with many numbers.

    A statement is immutable once it is well-formed, and kept with its ball, so that its id stays its own.
    """
    if len(tree) <= 2:
        return ball(tree)
    key = id(tree), ctx.prec
    if key not in _BALLS:
        if len(_BALLS) >= MOST_BALLS:
            _BALLS.clear()
        _BALLS[key] = tree, ball(tree)
    return _BALLS[key][1]


def _with_values(statement: Constant, truth: bool, grade: str) -> Accepted:
    """The verdict, if both sides have values: a refutation needs them as much as a proof."""
    statement.require_defined()
    return Accepted("proved" if truth else "refuted", grade)


def exact_truth(relation: Relation) -> bool | None:
    """The truth of a relation between numbers whose difference is rational, else ``None``."""
    gap = rational_value(relation.gap)
    return None if gap is None else bool(gap > 0 or (gap == 0 and not relation.strict))


# --- Printed numbers: whether a result that a text prints agrees with the numbers it prints beside it.
#
# A number printed as 0.5934 stands for some real in [0.59335, 0.59345]. The printed result agrees if some
# choice of inputs within their half units gives a result within its half unit; it disagrees if none does.
#
# References: ``reyes2019family``, Section 4.


@dataclass(frozen=True)
class Agrees(OfTerms):
    """A printed number agrees with a formula in printed numbers, to half a unit in each last place.

    Where it does not, the value that ``solve_for`` would need is reported; the formula is proportional to it.
    """

    formula: Tree
    inputs: tuple[tuple[str, str], ...]
    printed: str
    solve_for: str | None = None

    def require_well_formed(self) -> None:
        names = [name for name, _ in self.inputs]
        require_distinct("inputs", names)
        require(len(names) <= MAX_INPUTS, "inputs", len(names), f"must be at most {MAX_INPUTS}")
        require_expressions([self.formula], names)
        for text in (*(text for _, text in self.inputs), self.printed):
            plain = len(text) <= MAX_LENGTH and DECIMAL.fullmatch(text) is not None
            require(plain, "printed number", text, "is not a decimal")

    def terms(self) -> list[tuple[Tree, Domain]]:
        ranges = zip(self.inputs, _ranges(self), strict=True)
        return [(self.formula, {name: Interval(r.lower, r.upper) for (name, _), r in ranges})]

    def text(self) -> str:
        inputs = ", ".join(f"{name} = {_printed(value)}" for name, value in self.inputs)
        given = f" for {inputs}" if inputs else ""
        formula, printed = expression_text(self.formula), _printed(self.printed)
        return f"{formula} is {printed}{given}, all to printed precision"


@dataclass(frozen=True)
class PrintedInputs(Proof):
    """The printed inputs, taken as exact, give the printed result within its rounding."""

    rule = "printed inputs"
    bits: int


@dataclass(frozen=True)
class Corners(Proof):
    """Two corners of the inputs' roundings (0 lower, 1 upper end) give results around the printed one."""

    rule = "corners of the roundings"
    below: tuple[int, ...]
    above: tuple[int, ...]
    bits: int


@dataclass(frozen=True)
class OutsideRounding(Proof):
    """No inputs within their roundings give the printed result."""

    rule = "outside the roundings"
    bits: int


MAX_INPUTS = 16
MAX_LENGTH = 400
DECIMAL = re.compile(r"[+-]?([0-9]+(\.[0-9]*)?|\.[0-9]+)([eE][+-]?[0-9]{1,3})?")


@rule(Agrees, PrintedInputs)
def by_printed_inputs(statement: Agrees, proof: PrintedInputs) -> Accepted:
    """Soundness: the formula at the printed inputs, enclosed, lies inside the half unit."""
    value, target = at_printed(statement, proof.bits), printed_range(statement.printed)
    inside = target.lower <= value.lower and value.upper <= target.upper
    require(inside, "result", value.to_arb(), "leaves the rounding of the printed one")
    return Accepted("proved", "enclosure")


@rule(Agrees, Corners)
def by_corners(statement: Agrees, proof: Corners) -> Accepted:
    """Soundness: a formula that is finite over all inputs is continuous and takes every value between."""
    over_all(statement, proof.bits)
    target = printed_range(statement.printed)
    low, high = (at_corner(statement, ends, proof.bits) for ends in (proof.below, proof.above))
    require(low.upper <= target.upper, "lower corner", low.to_arb(), "is above the printed result")
    require(high.lower >= target.lower, "upper corner", high.to_arb(), "is below the printed result")
    return Accepted("proved", "enclosure")


@rule(Agrees, OutsideRounding)
def by_outside(statement: Agrees, proof: OutsideRounding) -> Accepted:
    """Soundness: the formula, enclosed over all roundings of the inputs, misses the half unit."""
    value, target = over_all(statement, proof.bits), printed_range(statement.printed)
    statement.require_defined()
    outside = value.upper < target.lower or value.lower > target.upper
    require(outside, "result", value.to_arb(), "meets the rounding of the printed one")
    return Accepted("refuted", "enclosure")


def printed_range(text: str) -> Enclosure:
    """The reals that round to a printed number: half a unit of its last place to both sides."""
    value, places = Fraction(text), Decimal(text).as_tuple().exponent
    half = Fraction(10) ** int(places) / 2
    return Enclosure(value - half, value + half)


def at_printed(statement: Agrees, bits: int) -> Enclosure:
    """The formula at the printed inputs."""
    return _enclosed(statement, [Enclosure.exact(Fraction(text)) for _, text in statement.inputs], bits)


def over_all(statement: Agrees, bits: int) -> Enclosure:
    """The formula over all roundings of the inputs; raises ``ValueError`` where it is not finite."""
    return _enclosed(statement, _ranges(statement), bits)


def at_corner(statement: Agrees, ends: tuple[int, ...], bits: int) -> Enclosure:
    """The formula at one corner of the roundings: 0 for the lower end of an input, 1 for the upper one."""
    named = len(ends) == len(statement.inputs) and set(ends) <= {0, 1}
    require(named, "corner", ends, "must say 0 or 1 for each input")
    pairs = zip(_ranges(statement), ends, strict=True)
    return _enclosed(statement, [Enclosure.exact(r.upper if end else r.lower) for r, end in pairs], bits)


def _ranges(statement: Agrees) -> list[Enclosure]:
    return [printed_range(text) for _, text in statement.inputs]


def _enclosed(statement: Agrees, inputs: list[Enclosure], bits: int) -> Enclosure:
    names = (name for name, _ in statement.inputs)
    with ctx.workprec(require_bits(bits)):
        values = {name: e.to_arb() for name, e in zip(names, inputs, strict=True)}
        return Enclosure.from_arb(ball(statement.formula, values))


def _printed(number: str) -> str:
    return number.replace("-", "−")
