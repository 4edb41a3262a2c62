"""Inequalities in one variable, on an interval, a half-line or the whole line.

Search comes first: a sample of exact points, each tried in balls. Where it finds nothing, the domain is cut
at 0, the negative side is reflected, and each piece is proved by the steps of ``check.kinds.for_all``.

References: ``reyes2019family`` (7), (8); ``tucker2011validated``.
"""

from __future__ import annotations

from fractions import Fraction
from functools import lru_cache

import numpy as np
from flint import ctx

from lyapcheck.check.expressions.expression import Tree, Unsupported
from lyapcheck.check.expressions.scales import sign_beside, sign_from
from lyapcheck.check.kinds import norm_bound as rules
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
from lyapcheck.check.kinds.norm_bound import EqualEntries, NormBound, OneEntry, Supremum
from lyapcheck.check.statement import Piece, Proof, Relation
from lyapcheck.claims.procedures.identity import find_relation
from lyapcheck.claims.procedures.search import (
    Point,
    doubtful,
    first_refutation,
    values_of,
    witness_data,
    witness_of,
)
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
    skip = {low if statement.open_low else None, high if statement.open_high else None}
    return [point for point in _grid(low, high) if point not in skip]


@lru_cache(maxsize=64)
def _grid(low: Fraction | None, high: Fraction | None) -> tuple[Fraction, ...]:
    left = low if low is not None else min(Fraction(-40), (high or Fraction(0)) - 40)
    right = high if high is not None else max(Fraction(40), left + 40)
    grid = [left + (right - left) * Fraction(k, 240) for k in range(241)]
    fine = [sign * Fraction(3, 2) ** k for k in range(-40, 14) for sign in (1, -1)]
    inside = {x for x in (*fine, Fraction(0)) if left < x < right}
    return tuple(sorted({*grid, *inside}))


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


# --- Bounds ``‖(f(x_1), …, f(x_n))‖ <= c · ‖x‖^k`` for every x in Rⁿ, reduced to one variable.
#
# - k = 0: the worst x repeats one worst entry, so the bound holds if and only if |f(t)| <= c/√n for every t.
# - k = 1, f(0) = 0: put all but one entry to 0 and the bound needs |f(t)| <= c|t|; squared and summed over
#   the entries, that also gives it. If f(0) ≠ 0, the bound fails at x = 0.
#
# A bound by a certified supremum (c = √n·γ with f = h, or √n·ρ with f = h') holds by its definition.
#
# References: ``reyes2019family`` (7), (8).

NORMS = "norm inequality"


@procedure(NormBound)
def find_norm_bound(statement: NormBound) -> SearchResult:
    """Try the vectors that are worst; where none breaks the bound, prove it by one variable."""
    claim, points = rules.vector_relation(statement).comparison, vector_points(statement)
    result, proof = first_refutation(claim, doubtful(claim, points)), None
    if result is None:
        proof = _by_supremum(statement) or _by_one_variable(statement)
        result = None if proof.is_proof else first_refutation(claim, points)
    if result is not None:
        return broken(witness_of(result), f"{NORMS}: a vector where it fails", witness_data(result))
    assert proof is not None
    return proof


def vector_points(statement: NormBound) -> list[Point]:
    """The vectors that the reductions say are worst: all entries equal, or one entry alone."""
    grid = sample(ForAll(Relation(statement.component, "<=", ("num", "0"))))
    # where |f(t)| (or |f(t)/t|) is largest on a fine grid of floating point
    x = np.linspace(1e-3, 12.0, 24_000)
    with np.errstate(all="ignore"):
        size = np.abs(values_of(statement.component, {"x": x})) / x**statement.power
    best = float(x[int(np.nanargmax(size))])
    peaks = [Fraction(best).limit_denominator(10**6)]
    names = rules.entries(statement)
    if statement.power == 0:
        return [dict.fromkeys(names, t) for t in [*peaks, *grid]]
    zero = dict.fromkeys(names, Fraction(0))
    return [zero, *({**zero, "x1": t} for t in [*peaks, *grid])]


def _by_supremum(statement: NormBound) -> SearchResult | None:
    relation = rules.supremum_relation(statement)
    numbers = find_relation(relation, NORMS) if relation is not None else None
    if numbers is None or not numbers.is_proof or numbers.proof is None:
        return None
    return shown(Supremum(numbers.proof), numbers.method)


def _by_one_variable(statement: NormBound) -> SearchResult:
    """The norm bound from its inequalities in one variable; a part that fails leaves it open."""
    reduced: tuple[ForAll, ...]
    if statement.power == 0:
        reduced, most, why = rules.uniform_parts(statement), "c/√n", "all entries equal is the worst case"
    else:
        reduced, most, why = rules.linear_parts(statement), "c|t|", "one entry alone is the worst case"
    parts = [find_for_all(part) for part in reduced]
    for side, part in zip(("f(t)", "-f(t)") * 2, parts, strict=False):
        if not part.is_proof:
            reason = f"{side} <= {most}: {part.reason or 'the inequality in one variable fails'}"
            return still_open(f"reduced to one variable ({why}), which stays open: {reason}", NORMS)
    methods = "; ".join(dict.fromkeys(part.method for part in parts))
    proofs = tuple(part.proof for part in parts if part.proof is not None)
    by: Proof = EqualEntries(proofs[0], proofs[1]) if statement.power == 0 else OneEntry(proofs)
    return shown(by, f"{NORMS}: {why}; {methods}")
