"""Relations between numbers: in balls, of growing precision, and exactly where both sides are rational.

References: ``reyes2019family``, Section 4.
"""

from __future__ import annotations

from flint import ctx

from lyapcheck.check.expressions.domain import holds
from lyapcheck.check.expressions.expression import ball
from lyapcheck.check.kinds.constant import Constant, ExactNumbers, SeparateBalls, exact_truth
from lyapcheck.check.numbers.polynomials import Enclosure
from lyapcheck.check.statement import Proof, Relation
from lyapcheck.claims.procedures.search import Sides, witness_data
from lyapcheck.claims.search_result import SearchResult, broken, procedure, shown, still_open

METHOD = "relation between numbers"
PRECISIONS = (128, 512, 2048)


@procedure(Constant)
def find_constant(statement: Constant) -> SearchResult:
    """Decide a relation between numbers."""
    return find_relation(statement.relation, METHOD)


def find_relation(relation: Relation, method: str) -> SearchResult:
    """Compare both sides exactly, or in balls of growing precision."""
    exact = exact_truth(relation)
    if exact is not None:
        return _found(relation, exact, ExactNumbers(), f"{method}: exact arithmetic", PRECISIONS[0])
    for bits in PRECISIONS:
        with ctx.workprec(bits):
            truth = holds(relation.comparison, {})
        if truth is not None:
            return _found(relation, truth, SeparateBalls(bits), f"{method}: balls of {bits} bits", bits)
    return still_open(
        f"both sides agree to {PRECISIONS[-1]} bits; if they are equal, state it as an identity", method
    )


def _found(relation: Relation, truth: bool, proof: Proof, method: str, bits: int) -> SearchResult:
    if truth:
        return shown(proof, method)
    with ctx.workprec(bits):
        left, right = (Enclosure.from_arb(ball(side)) for side in (relation.left, relation.right))
    return broken(proof, method, witness_data((relation.comparison, {}, Sides(left, right))))
