"""Inequalities in one variable, on an interval, a half-line or the whole line.

Search comes first: a sample of exact points, each tried in balls. Where it finds nothing, the domain is cut
at 0, the negative side is reflected, and each piece is proved by the steps of ``check.inequality``.

References: ``reyes2019family`` (7), (8); ``tucker2011validated``.
"""

from __future__ import annotations

from collections.abc import Iterator
from fractions import Fraction

from flint import ctx

from lyapcheck.check.functions import Tree, Unsupported
from lyapcheck.check.inequality import positive_from, positive_near_zero, positive_on_box, sign_everywhere
from lyapcheck.claims.decision import Decision, proved, refuted, undecided
from lyapcheck.claims.procedures.search import first_refutation, witness_data
from lyapcheck.claims.statements import ForAll
from lyapcheck.verdicts import Grade

METHOD = "one-variable inequality"
BITS = 160
MAX_BOXES = 6000
TAIL_STARTS = (2, 4, 8, 16, 32, 64, 128)


def decide_for_all(statement: ForAll) -> Decision:
    """Decide a relation for every x of an interval.

    Soundness: ``refuted`` rests on one point where disjoint balls show the failure; ``proved`` on pieces that
    cover the domain, each shown by a step of ``check.inequality``.
    """
    found = first_refutation(statement.relation, [{statement.variable: p} for p in sample(statement)])
    if found is None:
        found = first_refutation(statement.relation, [{statement.variable: p} for p in valleys(statement)])
    if found is not None:
        return refuted(Grade.ENCLOSURE, f"{METHOD}: a point where it fails", witness_data(*found))
    steps: list[str] = []
    try:
        with ctx.workprec(BITS):
            for tree, low, high in pieces(statement):
                steps.append(_prove(tree, statement, low, high))
    except Unsupported as problem:
        return undecided(f"{problem}; state it on a smaller interval, or split it into claims", METHOD)
    failed = [step for step in steps if step.startswith("?")]
    if failed:
        return undecided(failed[0][1:], METHOD, points_tried=len(sample(statement)))
    grade = Grade.EXACT if all(step.startswith("Sturm") for step in steps) else Grade.ENCLOSURE
    return proved(grade, f"{METHOD}: " + "; ".join(dict.fromkeys(steps)))


def pieces(statement: ForAll) -> Iterator[tuple[Tree, Fraction, Fraction | None]]:
    """The gap on pieces [low, high] with 0 <= low, which together cover the domain; high None is infinity."""
    low, high = statement.low, statement.high
    if high is None or high > 0:
        yield statement.relation.gap, max(low, Fraction(0)) if low is not None else Fraction(0), high
    if low is None or low < 0:
        reflected = _reflect(statement.relation.gap, statement.variable)
        yield (
            reflected,
            max(-high, Fraction(0)) if high is not None else Fraction(0),
            None if low is None else -low,
        )


def _reflect(tree: Tree, name: str) -> Tree:
    if tree[0] == "var":
        return ("neg", tree) if tree[1] == name else tree
    return (tree[0], *(_reflect(part, name) if isinstance(part, tuple) else part for part in tree[1:]))


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
    from lyapcheck.claims.procedures.sampling import lowest_points

    low = (
        statement.low
        if statement.low is not None
        else min(Fraction(-20), (statement.high or 0) - Fraction(20))
    )
    high = statement.high if statement.high is not None else max(Fraction(20), low + 40)
    return lowest_points(statement.relation, statement.variable, low, high)


def _prove(tree: Tree, statement: ForAll, low: Fraction, high: Fraction | None) -> str:
    """The step that proves one piece, or "?" and what to try next."""
    strict = statement.relation.strict
    exact = sign_everywhere(tree, statement.variable, low, high, strict)
    if exact is True and (not strict or low != 0 or _zero_is_left_out(statement)):
        return "Sturm's theorem"
    if exact is False:
        return (
            "?the exact sign test fails, yet no rational point shows it; look for a point by hand near a root"
        )
    if strict and low == 0 and not _zero_is_left_out(statement):
        low = Fraction(0)
        if not positive_on_box(tree, statement.variable, low, Fraction(1, 1024)):
            return "?equality at 0 is not excluded; say open_low, or use <= instead of <"
    return _prove_by_balls(tree, statement.variable, low, high)


def _zero_is_left_out(statement: ForAll) -> bool:
    return (statement.low == 0 and statement.open_low) or (statement.high == 0 and statement.open_high)


def _prove_by_balls(tree: Tree, name: str, low: Fraction, high: Fraction | None) -> str:
    used = []
    if low == 0:
        start = _start_of_boxes(tree, name, high)
        if start is None:
            return "?the sign next to 0 is open: no Taylor coefficient up to order 96 decides it"
        low = start
        used.append("Taylor at 0")
    if high is None:
        end = next(
            (Fraction(x) for x in TAIL_STARTS if x > low and positive_from(tree, name, Fraction(x))), None
        )
        if end is None:
            return "?the tail is open: not a quotient of polynomials in x and exp(x), or equal at infinity"
        high = end
        used.append("dominant term at infinity")
    boxes = count_boxes(tree, name, low, high)
    if boxes is None:
        return f"?{MAX_BOXES} boxes did not settle [{low}, {high}]; shrink it or look for equality inside"
    return ", ".join([*used, f"{boxes} Taylor boxes"])


def _start_of_boxes(tree: Tree, name: str, high: Fraction | None) -> Fraction | None:
    for k in range(0, 16, 2):
        start = Fraction(1, 2**k)
        if (high is None or start <= high) and positive_near_zero(tree, name, start):
            return start
    return None


def count_boxes(tree: Tree, name: str, low: Fraction, high: Fraction) -> int | None:
    """The number of boxes that show positivity over [low, high] by bisection; None if the budget ends."""
    stack, used = [(low, high)], 0
    while stack:
        left, right = stack.pop()
        used += 1
        if used > MAX_BOXES or right - left < Fraction(1, 2**60):
            return None
        if right > left and not positive_on_box(tree, name, left, right):
            middle = (left + right) / 2
            stack += [(middle, right), (left, middle)]
    return used
