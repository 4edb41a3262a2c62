"""Whether the hypotheses of a proved statement hold anywhere: one that holds of nothing says nothing."""

from __future__ import annotations

from collections.abc import Callable, Iterator

from lyapcheck.check.kinds.all_of import AllOf
from lyapcheck.check.kinds.for_small import ForSmall
from lyapcheck.check.kinds.implies import Implies
from lyapcheck.check.statement import Relation, Statement
from lyapcheck.claims.expressions import expr, var
from lyapcheck.claims.search_result import SearchResult
from lyapcheck.claims.statements import positive
from lyapcheck.verdicts import Verdict

NOTHING = "its hypotheses contradict each other: it holds of nothing"
UNMET = "no value was found that meets all hypotheses: it may hold of nothing"


def remarks(statement: Statement, judge: Callable[[Implies], SearchResult]) -> Iterator[str]:
    """What a reader of a proved statement must know of its hypotheses; nothing where a point meets them.

    Args:
        statement: parts of it are named.
        judge: a search whose proofs the checker has verified: of the claim that the hypotheses give
            1 <= 0, which a point that meets them refutes, and of claims that they contradict each other.
    """
    if isinstance(statement, AllOf):
        for name, part in statement.parts:
            yield from (f"{name}: {remark}" for remark in remarks(part, judge))
    elif isinstance(statement, (Implies, ForSmall)) and statement.hypotheses:
        together = _together(statement)
        if judge(together).verdict is not Verdict.REFUTED:
            decided = any(judge(one).verdict is Verdict.PROVED for one in _contradictions(together))
            yield NOTHING if decided else UNMET


def _together(statement: Implies | ForSmall) -> Implies:
    """That the hypotheses of a statement give 1 <= 0."""
    variables, given = statement.variables, statement.hypotheses
    if isinstance(statement, ForSmall):
        variables += positive(statement.small, *statement.bounded)
        given += tuple(var(name) <= 1 for name in statement.bounded)
    return Implies(variables, given, expr(1) <= 0)


def _contradictions(together: Implies) -> Iterator[Implies]:
    """Statements of which each says that no point meets all hypotheses: the others give that one fails."""
    yield together
    given = together.hypotheses
    for k, one in enumerate(given):
        fails = Relation(one.right, "<=" if one.strict else "<", one.left)
        yield Implies(together.variables, (*given[:k], *given[k + 1 :]), fails)
