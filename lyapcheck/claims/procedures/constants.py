"""Relations between numbers: in balls, of growing precision, and exactly where both sides are rational.

References: ``reyes2019family``, Section 4.
"""

from __future__ import annotations

from lyapcheck.check.functions import Unsupported
from lyapcheck.check.normal_form import normal_form
from lyapcheck.check.witness import holds, refutation
from lyapcheck.claims.decision import Decision, proved, refuted, undecided
from lyapcheck.claims.expressions import Relation
from lyapcheck.claims.procedures.search import comparison, witness_data
from lyapcheck.claims.statements import Constant
from lyapcheck.verdicts import Grade

METHOD = "relation between numbers"
PRECISIONS = (128, 512, 2048)


def decide_constant(statement: Constant) -> Decision:
    """Decide a relation between numbers."""
    return decide_relation(statement.relation, METHOD)


def decide_relation(relation: Relation, method: str) -> Decision:
    """Decide a relation without variables.

    Soundness: rational sides are compared exactly, others by balls that do not touch.
    """
    exact = _exactly(relation)
    if exact is True:
        return proved(Grade.EXACT, f"{method}: exact arithmetic")
    grade = Grade.ENCLOSURE if exact is None else Grade.EXACT
    for bits in PRECISIONS:
        sides = refutation(comparison(relation), {}, (), bits)
        if sides is not None:
            return refuted(grade, f"{method}: both sides computed", witness_data(relation, {}, sides))
        if exact is None and _in_balls(relation, bits):
            return proved(Grade.ENCLOSURE, f"{method}: balls of {bits} bits")
    return undecided(
        f"both sides agree to {PRECISIONS[-1]} bits; if they are equal, state it as an identity", method
    )


def _in_balls(relation: Relation, bits: int) -> bool:
    from flint import ctx

    with ctx.workprec(bits):
        return holds(comparison(relation), {}) is True


def _exactly(relation: Relation) -> bool | None:
    """The truth of the relation when the gap is rational, else None."""
    try:
        ratio, algebra = normal_form(relation.gap)
    except Unsupported:
        return None
    if ratio.top == 0:
        return not relation.strict
    if algebra.uses and not (ratio.top.is_constant() and ratio.bottom.is_constant()):
        return None
    gap = ratio.top.leading_coefficient() / ratio.bottom.leading_coefficient()
    return bool(gap > 0)
