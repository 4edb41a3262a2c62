"""Relations for every small enough ε: a leading term of known sign, or a point at which they fail.

See ``check.kinds.for_small`` for why these decide.
"""

from __future__ import annotations

from collections.abc import Iterator
from fractions import Fraction

from flint import ctx

from lyapcheck.check.expressions.expression import Unsupported, ball
from lyapcheck.check.kinds.for_small import (
    ForSmall,
    LeadingTerm,
    SmallWitness,
    at,
    leading_term,
    sign_for_small,
    signs_of,
)
from lyapcheck.check.numbers.polynomials import Enclosure, ball_of
from lyapcheck.check.refusal import Refused
from lyapcheck.check.statement import Relation, Variable
from lyapcheck.claims.procedures.implication import EFFORT, Cancellation
from lyapcheck.claims.procedures.search import BITS, Point, point_of, round_points
from lyapcheck.claims.search_result import SearchResult, broken, failing, procedure, shown, still_open
from lyapcheck.control.judgement import refutes

METHOD = "small parameter"
BELOW = (Fraction(1), Fraction(1, 2**10))


@procedure(ForSmall)
def find_for_small(statement: ForSmall) -> SearchResult:
    """Search an identity of signs for the leading term, then a point at which the relation fails."""
    proved = _leading(statement)
    if proved.is_proof:
        return proved
    return _against(statement) or proved


def _leading(statement: ForSmall) -> SearchResult:
    """An identity of signs for the leading term."""
    try:
        signs = signs_of(statement)
        limit = leading_term(signs, statement)
    except Unsupported as problem:
        return still_open(f"{problem}; write the relation between polynomials", METHOD)
    if limit is None:
        return still_open(
            "the leading term depends on a bounded variable; state the claim without it", METHOD
        )
    depth, nodes = EFFORT[-1]
    identity = Cancellation(signs, nodes).identity(limit, True, depth)
    if identity is not None:
        return shown(
            LeadingTerm(identity),
            f"{METHOD}: the leading term is positive by an identity with terms of known sign",
        )
    return still_open(
        "the leading term is not shown to be positive; add the hypothesis that makes it so", METHOD
    )


def _against(statement: ForSmall) -> SearchResult | None:
    """A point of small rationals at which the relation fails for all small ε."""
    method = f"{METHOD}: a point at which it fails for all small {statement.small}"
    for point in _points(statement):
        if _breaks(statement, point):
            for below in BELOW:
                proof = SmallWitness(point_of(point), below)
                if refutes(statement, proof):
                    return broken(proof, method, _data(statement, point, below))
    return None


def _points(statement: ForSmall) -> Iterator[Point]:
    """Round points; variables that run over (0, 1] are 1 at most."""
    unit = [Variable(name, Fraction(0)) for name in statement.bounded]
    for point in round_points([*statement.variables, *unit]):
        yield point | {name: min(point[name], Fraction(1)) for name in statement.bounded}


def _breaks(statement: ForSmall, point: Point) -> bool:
    """Whether the conclusion fails for all small ε and every hypothesis holds."""
    try:
        fails = not _holds(statement.conclusion, point)
        return fails and all(_holds(hypothesis, point) for hypothesis in statement.hypotheses)
    except (Refused, Unsupported, ZeroDivisionError):
        return False


def _holds(relation: Relation, point: Point) -> bool:
    sign = sign_for_small(at(point, relation.gap))
    return sign > 0 or (sign == 0 and not relation.strict)


def _data(statement: ForSmall, point: Point, below: Fraction) -> dict[str, object]:
    """The point, and both sides at one small value."""
    whole = point | {statement.small: below / 2**20}
    balls = {name: ball_of(value) for name, value in whole.items()}
    claim = statement.conclusion
    with ctx.workprec(BITS):
        left, right = (Enclosure.from_arb(ball(side, balls)) for side in (claim.left, claim.right))
    return failing(dict(sorted(whole.items())), left, claim.operator, right)
