"""Inequalities in one variable: the domain is cut at 0, its left part reflected, each piece proved by itself.

References: ``tucker2011validated``, chapters 3 and 5; ``sturm1829``.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from fractions import Fraction
from itertools import pairwise

from flint import arb, ctx, fmpq_poly

from lyapcheck.check.expressions.domain import Comparison, Domain, Interval
from lyapcheck.check.expressions.expression import Tree, Unsupported, ball, nodes, substitute, taylor
from lyapcheck.check.expressions.grammar import MAX_EXPONENT
from lyapcheck.check.expressions.normal_form import Ratio, normal_form
from lyapcheck.check.expressions.scales import sign_beside, sign_from
from lyapcheck.check.expressions.signs import MINUS, PLUS, never
from lyapcheck.check.expressions.text import number_text
from lyapcheck.check.numbers.polynomials import ball_of, nonnegative_on, positive_on, univariate
from lyapcheck.check.refusal import Refused, require
from lyapcheck.check.replay import Pointwise, relation_text, require_bits, require_relations
from lyapcheck.check.statement import Piece, Proof, Relation
from lyapcheck.check.verify import Accepted, rule, weakest

# --- The steps by which ``f > 0`` or ``f >= 0`` is shown for an expression of one variable x >= 0.
#
# - everywhere, exactly: f is a quotient of polynomials in x alone or in y = exp(x) alone (Sturm);
# - on a box: Taylor's formula about its middle, the remainder enclosed over the whole box.
#
# Next to 0 and on [X, ∞) ``scales`` has the sign of the dominant term. Each step returns ``True`` only if it
# is a proof; ``False`` says nothing.


def positive_at(tree: Tree, name: str, x: Fraction) -> bool:
    """Whether f(x) > 0."""
    return bool(ball(tree, {name: ball_of(x)}) > 0)


def positive_on_box(tree: Tree, name: str, low: Fraction, high: Fraction, order: int = 8) -> bool:
    """Whether f > 0 on [low, high], by Taylor's formula about the middle."""
    middle = ball_of((low + high) / 2)
    box = ball_of(low).union(ball_of(high))
    try:
        remainder = taylor(tree, name, box, order)[order]
        coefficients = [*taylor(tree, name, middle, order - 1), remainder]
    except (ValueError, ZeroDivisionError):
        return False
    step = box - middle
    value = arb(0)
    for coefficient in reversed(coefficients):
        value = value * step + coefficient
    return bool(value > 0)


def sign_everywhere(tree: Tree, name: str, low: Fraction, high: Fraction | None, strict: bool) -> bool | None:
    """Whether f > 0 (or >= 0) on [low, high], exactly; ``None`` where f is not in x or y alone.

    With ``strict`` the end 0 is left out: f > 0 is asked on (0, high] when low = 0. The quotient is taken in
    lowest terms: that f has a value everywhere, and so a bottom that is not 0, is judged by ``defined``.
    """
    result = _in_x_or_exp(tree, name)
    if result is None:
        return None
    polynomial, exponential = result
    if exponential:
        if low != 0 or high is not None:
            return None
        low = Fraction(1)
    if not strict:
        return nonnegative_on(polynomial, low, high)
    return positive_on(polynomial, low, high, open_low=low == int(exponential))


def _in_x_or_exp(tree: Tree, name: str) -> tuple[fmpq_poly, bool] | None:
    """Top times bottom of the normal form, if it is in x or exp(x) alone, and whether in exp(x)."""
    try:
        ratio, algebra = normal_form(tree)
    except Unsupported:
        return None
    ratio = Ratio(ratio.top, ratio.bottom).lowest()
    degrees = [max(pair) for pair in zip(ratio.top.degrees(), ratio.bottom.degrees(), strict=True)]
    used = [index for index, degree in enumerate(degrees) if degree]
    x = algebra.names.index(name) if name in algebra.names else None
    own = algebra.uses.get(("exp", str(algebra.variable(name).top.monoms()[0]))) if x is not None else None
    if len(used) > 1 or not {*used} <= {x, own}:
        return None
    [index] = used or [0]
    if degrees[index] > MAX_EXPONENT:
        raise Unsupported(f"a power above {MAX_EXPONENT}")
    return univariate(ratio.top, index) * univariate(ratio.bottom, index), bool(used) and index == own


@dataclass(frozen=True)
class ForAll(Pointwise):
    """A relation for every value of one variable in the interval from low to high (None: unbounded)."""

    relation: Relation
    low: Fraction | None = None
    high: Fraction | None = None
    open_low: bool = False
    open_high: bool = False
    variable: str = "x"

    def require_well_formed(self) -> None:
        require_relations([self.relation], [self.variable])
        low, high = self.low, self.high
        endless = (low is None and self.open_low) or (high is None and self.open_high)
        require(not endless, "interval", "open", "is no end at infinity; leave it false there")
        if low is not None and high is not None:
            closed = not self.open_low and not self.open_high
            require(low < high or (low == high and closed), "interval", f"{low}, {high}", "is empty")

    @property
    def interval(self) -> Interval:
        return Interval(self.low, self.high, self.open_low, self.open_high)

    @property
    def ranges(self) -> dict[str, Interval]:
        return {self.variable: self.interval}

    @property
    def at_points(self) -> tuple[tuple[()], Comparison]:
        return (), self.relation.comparison

    def text(self) -> str:
        low = "−∞" if self.low is None else number_text(self.low)
        high = "∞" if self.high is None else number_text(self.high)
        left = "(" if self.open_low or self.low is None else "["
        right = ")" if self.open_high or self.high is None else "]"
        return f"{relation_text(self.relation)} for all {self.variable} in {left}{low}, {high}{right}"


@dataclass(frozen=True)
class Sturm(Piece):
    """By Sturm's theorem: the function is a quotient of polynomials in x alone or in exp(x) alone."""

    rule = "Sturm"


@dataclass(frozen=True)
class Boxes(Piece):
    """By Taylor's formula on the boxes between neighbouring ``cuts``.

    The dominant term gives the sign from 0 to the first cut, with ``from_zero``, and beyond the last one,
    with ``to_infinity``.
    """

    rule = "Taylor boxes"
    cuts: tuple[Fraction, ...]
    from_zero: bool
    to_infinity: bool
    bits: int


@dataclass(frozen=True)
class Pieces(Proof):
    """One proof for each piece of the domain: the part right of 0, then the part left of it, reflected."""

    rule = "pieces of the domain"
    pieces: tuple[Piece, ...]


MAX_CUTS = 20_000
Stretch = tuple[Tree, Fraction, Fraction | None]
"""The gap on [low, high] with 0 <= low; ``None`` is infinity."""


@rule(ForAll, Pieces)
def by_pieces(statement: ForAll, proof: Pieces) -> Accepted:
    """Soundness: the pieces cover the domain, and each is shown to keep its sign."""
    domains = list(pieces(statement))
    require(len(proof.pieces) == len(domains), "pieces", len(proof.pieces), f"must be {len(domains)}")
    return Accepted(
        "proved", weakest(_shown(statement, *pair) for pair in zip(domains, proof.pieces, strict=True))
    )


def pieces(statement: ForAll) -> Iterator[Stretch]:
    """The gap on pieces [low, high] with 0 <= low, which together cover the domain.

    Soundness: on a piece |a| is a where a is never negative, and −a where a is never positive.
    """
    low, high, zero = statement.low, statement.high, Fraction(0)
    gap, name = statement.relation.gap, statement.variable
    if high is None or high > 0 or low == 0:
        start = max(low, zero) if low is not None else zero
        yield without_abs(gap, {name: Interval(start, high)}), start, high
    if low is None or low < 0:
        start, end = max(-high, zero) if high is not None else zero, None if low is None else -low
        mirrored = substitute(gap, {name: ("neg", ("var", name))})
        yield without_abs(mirrored, {name: Interval(start, end)}), start, end


def without_abs(tree: Tree, domain: Domain) -> Tree:
    """The same function on a domain, without the absolute values of parts whose sign is seen there."""
    if all(node[0] != "abs" for node in nodes(tree)):
        return tree
    result: Tree = tuple(without_abs(part, domain) if isinstance(part, tuple) else part for part in tree)
    if result[0] != "abs":
        return result
    inner: Tree = result[1]
    if never(inner, MINUS, domain):
        return inner
    return ("neg", inner) if never(inner, PLUS, domain) else result


def zero_must_be_positive(statement: ForAll, low: Fraction) -> bool:
    """Whether a piece that begins at ``low`` has to show a strict inequality at 0."""
    return statement.relation.strict and low == 0 and low in statement.interval


def _shown(statement: ForAll, domain: Stretch, piece: Piece) -> str:
    """The grade of the proof on one piece."""
    if isinstance(piece, Boxes):
        with ctx.workprec(require_bits(piece.bits)):
            _require_boxes(statement, domain, piece)
        return "enclosure"
    require(isinstance(piece, Sturm), "piece", piece.rule, "is not known")
    tree, low, high = domain
    require(not zero_must_be_positive(statement, low), "piece", "Sturm", "does not show > at 0")
    holds = sign_everywhere(tree, statement.variable, low, high, statement.relation.strict)
    require(holds, "piece", "Sturm", "does not give the sign")
    return "exact"


def _require_boxes(statement: ForAll, domain: Stretch, piece: Boxes) -> None:
    (tree, low, high), cuts, name = domain, piece.cuts, statement.variable
    require(1 <= len(cuts) <= MAX_CUTS, "cuts", len(cuts), f"must be from 1 to {MAX_CUTS}")
    if piece.from_zero:  # where f has a value at 0 too, it is continuous there: f(0) >= 0
        require(low == 0 < cuts[0], "first cut", cuts[0], "must lie above 0, where the piece begins")
        require(sign_beside(tree, name, low, cuts[0]) > 0, "first cut", cuts[0], "is too far from 0")
        if zero_must_be_positive(statement, low):
            require(positive_at(tree, name, low), "value at 0", 0, "is not shown to be positive")
    else:
        require(cuts[0] <= low, "first cut", cuts[0], f"leaves out {low}")
    if piece.to_infinity:
        require(sign_from(tree, name, cuts[-1]) > 0, "last cut", cuts[-1], "no term dominates from there on")
    elif high is None or cuts[-1] < high:
        raise Refused("last cut", cuts[-1], f"leaves out {'infinity' if high is None else high}")
    for left, right in pairwise(cuts):
        require(left < right, "cuts", f"{left}, {right}", "must rise")
        require(positive_on_box(tree, name, left, right), "box", f"[{left}, {right}]", "the sign is open")
    if len(cuts) == 1 and not (piece.from_zero or piece.to_infinity):  # a domain of one point
        require(positive_at(tree, name, cuts[0]), "point", cuts[0], "the sign is open")
