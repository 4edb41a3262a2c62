"""Inequalities in one variable, on an interval, a half-line or the whole line.

Search comes first: a sample of exact points, each tried in balls. Where it finds nothing, the domain is cut
at 0, the negative side is reflected, and each piece is proved by the steps of ``check.kinds.for_all``.

References: ``reyes2019family`` (7), (8); ``tucker2011validated``.
"""

from __future__ import annotations

from fractions import Fraction

from flint import ctx

from lyapcheck.check.expressions.expression import Tree, Unsupported
from lyapcheck.check.expressions.scales import sign_beside, sign_from
from lyapcheck.check.kinds.for_all import (
    Boxes,
    ForAll,
    Pieces,
    Stretch,
    Sturm,
    pieces,
    positive_at,
    positive_on_box,
    sign_everywhere,
    zero_must_be_positive,
)
from lyapcheck.check.statement import Piece
from lyapcheck.claims.procedures.search import doubtful, first_refutation, witness_data, witness_of
from lyapcheck.claims.search_result import SearchResult, broken, procedure, shown, still_open

METHOD = "one-variable inequality"
BITS = 160
MAX_BOXES = 6000
TAIL_STARTS = (2, 4, 8, 16, 32, 64, 128)


class _Open(Exception):
    """A piece that no step proves; says what to try next."""


@procedure(ForAll)
def find_for_all(statement: ForAll) -> SearchResult:
    """Look for a point where the relation fails, then for a proof on each piece of the domain."""
    claim, name = statement.relation.comparison, statement.variable
    points = [{name: p} for p in sample(statement)]
    likely = [*doubtful(claim, points), *({name: p} for p in valleys(statement))]
    result, proofs, reason = first_refutation(claim, likely), [], ""
    if result is None:
        try:
            with ctx.workprec(BITS):
                proofs = [_prove(statement, domain) for domain in pieces(statement)]
        except (Unsupported, _Open) as problem:
            more = "; state it on a smaller interval, or split it into claims"
            reason = f"{problem}{more if isinstance(problem, Unsupported) else ''}"
            result = first_refutation(claim, points)
    if result is not None:
        return broken(witness_of(result), f"{METHOD}: a point where it fails", witness_data(result))
    if reason:
        return still_open(reason, METHOD, points_tried=len(points))
    return shown(Pieces(tuple(proofs)), f"{METHOD}: " + "; ".join(dict.fromkeys(map(_words, proofs))))


def sample(statement: ForAll) -> list[Fraction]:
    """Exact points of the domain: its ends, an even grid, and a grid that is even in the exponent."""
    low, high = statement.low, statement.high
    left = low if low is not None else min(Fraction(-40), (high or Fraction(0)) - 40)
    right = high if high is not None else max(Fraction(40), left + 40)
    grid = [left + (right - left) * Fraction(k, 240) for k in range(241)]
    fine = [sign * Fraction(3, 2) ** k for k in range(-40, 14) for sign in (1, -1)]
    points = sorted(
        {*grid, *(x for x in fine if left < x < right), *([Fraction(0)] if left < 0 < right else [])}
    )
    skip = {low if statement.open_low else None, high if statement.open_high else None}
    return [point for point in points if point not in skip]


def valleys(statement: ForAll) -> list[Fraction]:
    """Points of the domain near which the gap is smallest in floating point."""
    from lyapcheck.claims.procedures.search import lowest_points

    low = (
        statement.low
        if statement.low is not None
        else min(Fraction(-20), (statement.high or 0) - Fraction(20))
    )
    high = statement.high if statement.high is not None else max(Fraction(20), low + 40)
    return lowest_points(statement.relation, statement.variable, low, high)


def _prove(statement: ForAll, domain: Stretch) -> Piece:
    """The step that proves one piece; raises :class:`_Open` with what to try next."""
    tree, low, high = domain
    strict, at_zero = statement.relation.strict, zero_must_be_positive(statement, low)
    exact = sign_everywhere(tree, statement.variable, low, high, strict)
    if exact is True and not at_zero:
        return Sturm()
    if exact is False:
        raise _Open(
            "the exact sign test fails, yet no rational point shows it; look for a point by hand near a root"
        )
    if at_zero and not positive_at(tree, statement.variable, low):
        raise _Open("equality at 0 is not excluded; say open_low, or use <= instead of <")
    tree, low, high = domain
    name, start, end = statement.variable, low, high
    if low == 0:
        start = _start_of_boxes(tree, name, high)
    if high is None:
        end = _end_of_boxes(tree, name, start)
    assert end is not None
    return Boxes(tuple(cuts(tree, name, start, end)), low == 0, high is None, BITS)


def _start_of_boxes(tree: Tree, name: str, high: Fraction | None) -> Fraction:
    for k in range(0, 16, 2):
        start = Fraction(1, 2**k)
        if (high is None or start <= high) and sign_beside(tree, name, Fraction(0), start) > 0:
            return start
    raise _Open("the sign next to 0 is open: no dominant term decides it")


def _end_of_boxes(tree: Tree, name: str, start: Fraction) -> Fraction:
    for x in map(Fraction, TAIL_STARTS):
        if x > start and sign_from(tree, name, x) > 0:
            return x
    raise _Open("the tail is open: no term dominates from there on, or both sides meet at infinity")


def cuts(tree: Tree, name: str, low: Fraction, high: Fraction) -> list[Fraction]:
    """The ends of boxes that show positivity over [low, high], found by bisection.

    Raises:
        _Open: the budget of boxes ends first.
    """
    stack, result, used = [(low, high)], [low], 0
    while stack:
        left, right = stack.pop()
        used += 1
        if used > MAX_BOXES or (left < right and right - left < Fraction(1, 2**60)):
            raise _Open(
                f"{MAX_BOXES} boxes did not settle [{low}, {high}]; shrink it or look for equality inside"
            )
        if left < right and not positive_on_box(tree, name, left, right):
            middle = (left + right) / 2
            stack += [(middle, right), (left, middle)]
        elif left < right:
            result.append(right)
    return result


def _words(piece: Piece) -> str:
    """The step in words."""
    if not isinstance(piece, Boxes):
        return "Sturm's theorem"
    used = ["dominant term at 0"] * piece.from_zero + ["dominant term at infinity"] * piece.to_infinity
    return ", ".join([*used, f"{len(piece.cuts) - 1} Taylor boxes"])
