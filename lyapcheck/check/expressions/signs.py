"""The signs that an expression takes over a domain, by rules that see them in its form.

An answer lists signs that *may* occur; leaving one out is a proof that it does not, at any point of the
domain at which the expression is defined.

References: ``sturm1829``; ``tucker2011validated``, chapter 3.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping
from fractions import Fraction
from itertools import product
from math import floor
from typing import Any

from flint import arb, ctx, fmpq, fmpq_mpoly, fmpq_mpoly_ctx, fmpq_poly

from lyapcheck.check.expressions.domain import REALS, Domain, Interval
from lyapcheck.check.expressions.expression import (
    CONSTANTS,
    FAMILY,
    LEAVES,
    Tree,
    Unsupported,
    ball,
    family_formula,
    nodes,
    substitute,
    variables,
)
from lyapcheck.check.expressions.grammar import MAX_EXPONENT, Remembered
from lyapcheck.check.expressions.normal_form import RationalAlgebra, normal_form, rational_value
from lyapcheck.check.expressions.text import expression_text
from lyapcheck.check.numbers.polynomials import (
    Enclosure,
    ball_of,
    nonnegative_on,
    positive_on,
    rational,
    signum,
    univariate,
)
from lyapcheck.check.refusal import Refused

Signs = frozenset[int]
ANY: Signs = frozenset((-1, 0, 1))
PLUS: Signs = frozenset((1,))
NOT_NEGATIVE: Signs = frozenset((0, 1))
ZERO: Signs = frozenset((0,))
MINUS: Signs = frozenset((-1,))
ODD = ("sinh", "tanh", "atan", "asin")
"""Functions with the sign of their argument."""
BITS = (64, 256, 1024)
HALVINGS = 10
MOST_PARTS = 400


def never(tree: Tree, unwanted: Signs, domain: Domain) -> bool:
    """Whether an expression takes none of some signs where it is defined; ``False`` says nothing.

    It may have the dot products and derivatives of ``check.letters``, of which little is seen.
    """
    result = _Reader(domain, deep=False).of(tree)
    if result & unwanted:
        result &= by_value(tree, domain)
    if result & unwanted:
        result &= _Reader(domain, deep=True).of(tree)
    return not result & unwanted


class _Reader:
    """One expression over one domain; a node that stands in several places is looked at once.

    With ``deep`` every part is also looked at by its values, and not by its form alone.
    """

    def __init__(self, domain: Domain, deep: bool) -> None:
        self.domain, self.deep = domain, deep
        self.known: dict[int, tuple[Tree, Signs]] = {}

    def of(self, tree: Tree) -> Signs:
        if id(tree) not in self.known:
            result = self._by_form(tree)
            if self.deep and len(result) > 1 and len(self.known) < MOST_PARTS:
                result &= by_value(tree, self.domain)
            self.known[id(tree)] = tree, result
        return self.known[id(tree)][1]

    def _by_form(self, tree: Tree) -> Signs:
        kind, *rest = tree
        if kind == "num":
            return frozenset([signum(Fraction(rest[0]))])
        if kind == "var":
            return self.domain.get(rest[0], REALS).signs()
        if kind in CONSTANTS or kind in ("pi", "exp", "cosh"):
            return PLUS
        if kind in FAMILY:
            return self.of(family_formula(kind, *rest))
        if kind in ODD:
            return self.of(rest[0])
        rule = RULES.get(kind)
        return ANY if rule is None else rule(self, rest)


def by_value(tree: Tree, domain: Domain) -> Signs:
    """What the normal form, exact signs of polynomials and balls leave of all signs."""
    if any(node[0] in ("dot", "rate") for node in nodes(tree)):
        return ANY
    names = variables(tree)
    if not names:
        return _of_number(tree)
    result = _of_polynomial(tree, domain)
    with ctx.workprec(BITS[0]):  # over the whole domain, in which a sine lies between −1 and 1
        result &= _sign_of(ball(tree, {name: _ball_over(domain.get(name, REALS)) for name in names}))
    if len(result) > 1 and len(names) == 1:
        (name,) = names
        low, high = domain.get(name, REALS).low, domain.get(name, REALS).high
        result &= ANY if low is None or high is None else _over_pieces(tree, name, low, high, HALVINGS)
    return result


def _sum(parts: list[Signs]) -> Signs:
    for sign in (1, -1):
        if all(part <= {0, sign} for part in parts):
            return frozenset([sign]) if any(part == {sign} for part in parts) else frozenset([0, sign])
    return ANY


def _times(first: Signs, *others: Signs) -> Signs:
    for other in others:
        first = frozenset(a * b for a, b in product(first, other))
    return first


RULES: dict[str, Callable[[_Reader, list[Any]], Signs]] = {
    "neg": lambda reader, rest: frozenset(-sign for sign in reader.of(rest[0])),
    "add": lambda reader, rest: _sum([reader.of(part) for part in rest]),
    "mul": lambda reader, rest: _times(PLUS, *map(reader.of, rest)),
    "div": lambda reader, rest: _times(reader.of(rest[0]), reader.of(rest[1]) - {0}),
    "pow": lambda reader, rest: frozenset(sign ** rest[1] for sign in reader.of(rest[0])),
    "abs": lambda reader, rest: frozenset(abs(sign) for sign in reader.of(rest[0])),
    "sqrt": lambda reader, rest: reader.of(rest[0]) & NOT_NEGATIVE,
    "acos": lambda reader, rest: NOT_NEGATIVE,
    "dot": lambda reader, rest: NOT_NEGATIVE if rest[0] == rest[1] else ANY,
}


def _of_number(tree: Tree) -> Signs:
    """The sign of a number: exactly where its normal form is rational, else by a ball that avoids 0."""
    value = rational_value(tree)
    if value is not None:
        return frozenset([signum(value)])
    for bits in BITS:
        with ctx.workprec(bits):
            result = _sign_of(ball(tree))
            if len(result) == 1:
                return result
    return ANY


def _ball_over(interval: Interval) -> arb:
    """A ball that contains an interval; the whole line where that has no end."""
    if interval.low is None or interval.high is None:
        return arb("0 +/- inf")
    return ball_of(interval.low).union(ball_of(interval.high))


def _sign_of(value: arb) -> Signs:
    if value > 0:
        return PLUS
    if value < 0:
        return MINUS
    return NOT_NEGATIVE if value >= 0 else ANY


def _of_polynomial(tree: Tree, domain: Domain) -> Signs:
    """The signs of a quotient of polynomials, by its coefficients or, in one variable, by Sturm's theorem."""
    try:
        ratio, algebra = normal_form(tree)
    except (Unsupported, ZeroDivisionError):
        return ANY
    if ratio.top == 0:
        return frozenset([0])
    bounds = lower_bounds(algebra, domain)
    both = (above(bounds, part, algebra.ring) for part in (ratio.top, ratio.bottom))
    top, bottom = (of_terms(part, bounds) for part in both)
    result = _times(top, bottom - {0})
    short = max(map(max, (*ratio.top.monoms(), *ratio.bottom.monoms())), default=0) <= MAX_EXPONENT
    if len(result) > 1 and short and not algebra.uses and len(algebra.names) == 1:
        interval = domain.get(algebra.names[0], REALS)
        result &= _by_sturm(univariate(ratio.top, 0) * univariate(ratio.bottom, 0), interval)
    return result


Bounds = Mapping[int, tuple[Fraction, Signs]]
"""For each generator that has one, a lower bound, and the signs of what is above it."""


def lower_bounds(algebra: RationalAlgebra, domain: Domain) -> Bounds:
    """Those of variables and constants; the latter in sixteenths."""
    intervals = ((i, domain.get(name, REALS)) for i, name in enumerate(algebra.names))
    result = {
        i: (one.low, PLUS if one.open_low else NOT_NEGATIVE) for i, one in intervals if one.low is not None
    }
    with ctx.workprec(BITS[0]):
        for i, number in algebra.constants().items():
            result[i] = Fraction(floor(Enclosure.from_arb(number).lower * 16), 16), NOT_NEGATIVE
    return result


def above(bounds: Bounds, polynomial: fmpq_mpoly, ring: fmpq_mpoly_ctx) -> fmpq_mpoly:
    """The polynomial in generators that are counted from their lower bounds."""
    lows = (rational(bounds[i][0]) if i in bounds else fmpq(0) for i in range(ring.nvars()))
    return polynomial.compose(*(x + low for x, low in zip(ring.gens(), lows, strict=True)), ctx=ring)


def of_monomial(exponents: tuple[int, ...], bounds: Bounds) -> Signs:
    """The signs of a product of powers of generators that are counted from their lower bounds."""
    result = PLUS
    for i, e in enumerate(exponents):
        if e:
            own = bounds[i][1] if i in bounds else ANY
            result = frozenset(a * b ** int(e) for a, b in product(result, own))
    return result


def of_terms(polynomial: fmpq_mpoly, bounds: Bounds) -> Signs:
    """The signs that the terms show."""
    terms = polynomial.to_dict().items()
    return _sum([frozenset(signum(c) * s for s in of_monomial(e, bounds)) for e, c in terms])


def _by_sturm(polynomial: fmpq_poly, interval: Interval) -> Signs:
    low, high = interval.low, interval.high
    for sign in (1, -1):
        if positive_on(sign * polynomial, low, high, interval.open_low, interval.open_high):
            return frozenset([sign])
        if nonnegative_on(sign * polynomial, low, high):
            return frozenset([0, sign])
    return ANY


def _over_pieces(tree: Tree, name: str, low: Fraction, high: Fraction, halvings: int) -> Signs:
    """The sign over a bounded interval, cut until each piece shows it in balls."""
    with ctx.workprec(BITS[0]):
        result = _sign_of(ball(tree, {name: ball_of(low).union(ball_of(high))}))
    if len(result) == 1:
        return result
    if halvings == 0 or low == high:
        return ANY
    middle = (low + high) / 2
    result = _over_pieces(tree, name, middle, high, halvings - 1)
    same = len(result) == 1 and result == _over_pieces(tree, name, low, middle, halvings - 1)
    return result if same else ANY


# --- The one judgement of definedness: whether every term of an expression has a value over a whole domain.
#
# Expressions are partial functions of real variables:
#
#     a / b     has a value where a and b have one and b ≠ 0
#     √a        where a has one and a ≥ 0           ln a         where a > 0
#     tan a     where cos a ≠ 0                      asin, acos   where −1 ≤ a ≤ 1
#     aᵏ        where a has one, also for k = 0 (then it is 1)
#     all else  where its parts have one
#
# so a part without a value leaves the whole without one, whatever it is multiplied by. A statement is true
# only if all its terms have values on its whole domain, and false only by a point at which they have.


ONE: Tree = ("num", "1")
_DEFINED = Remembered()


class Undefined(Refused):
    """A term of a statement is not shown to have a value over the whole domain."""


def _within_one(rest: list[Any], domain: Domain) -> bool:
    sides = (("add", ONE, rest[0]), ("add", ONE, ("neg", rest[0])))
    return all(never(side, MINUS, domain) for side in sides)


CONDITIONS: dict[str, Callable[[list[Any], Domain], bool]] = {
    "div": lambda rest, domain: never(rest[1], ZERO, domain),
    "sqrt": lambda rest, domain: never(rest[0], MINUS, domain),
    "log": lambda rest, domain: never(rest[0], MINUS | ZERO, domain),
    "tan": lambda rest, domain: never(("cos", rest[0]), ZERO, domain),
    "asin": _within_one,
    "acos": _within_one,
}
"""The operations that do not always have a value, each with what gives it one."""


def require_defined(tree: Tree, domain: Domain) -> None:
    """Refuse an expression with a part that is not shown to have a value over the whole domain.

    Soundness: the conditions of all parts are shown one by one, each on the supposition that what is inside
        of it has a value; what is innermost supposes nothing.
    """
    if tree[0] in LEAVES or (not domain and tree in _DEFINED):
        return
    for node in nodes(tree):
        condition = CONDITIONS.get(node[0])
        if condition is not None and not condition(list(node[1:]), domain):
            rule = (
                "is not shown to have a value over the whole domain; restrict the domain, or write it without"
            )
            raise Undefined("term", expression_text(tuple(node)), rule)
    if not domain and len(tree) > 2:
        _DEFINED.add(tree)


def require_defined_at(tree: Tree, point: Mapping[str, Fraction]) -> None:
    """Refuse a point at which a part of an expression is not shown to have a value."""
    numbers = {name: ("num", str(value)) for name, value in point.items()}
    require_defined(substitute(tree, numbers), {})
