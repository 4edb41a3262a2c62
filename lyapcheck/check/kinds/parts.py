"""What several kinds of statement share: relations and the ranges of variables, their form and their text."""

from __future__ import annotations

from collections.abc import Iterable

from lyapcheck.check.expressions.domain import Domain, Interval
from lyapcheck.check.expressions.expression import Tree
from lyapcheck.check.expressions.grammar import require_expressions
from lyapcheck.check.expressions.text import expression_text, number_text
from lyapcheck.check.refusal import require
from lyapcheck.check.statement import Relation, Variable


def require_relations(relations: Iterable[Relation], names: list[str]) -> None:
    """Refuse relations with variables beyond ``names``, or a name given twice."""
    require_distinct("variables", names)
    for relation in relations:
        require_expressions((relation.left, relation.right), names)


def require_distinct(subject: str, names: list[str]) -> None:
    """Refuse names of which one is given twice."""
    require(len(set(names)) == len(names), subject, ", ".join(names), "one is given twice")


def terms_of(relations: Iterable[Relation], domain: Domain) -> list[tuple[Tree, Domain]]:
    """Both sides of relations, which must have values over a domain."""
    return [(side, domain) for relation in relations for side in (relation.left, relation.right)]


def domain_of(variables: Iterable[Variable]) -> dict[str, Interval]:
    """The intervals over which variables range."""
    return {variable.name: variable.interval for variable in variables}


def relation_text(relation: Relation) -> str:
    """``left ≤ right``."""
    sign = "<" if relation.strict else "≤"
    return f"{expression_text(relation.left)} {sign} {expression_text(relation.right)}"


def range_text(variables: Iterable[Variable]) -> str:
    """``x in R, y > 0``."""
    return ", ".join(map(_range, variables))


def _range(variable: Variable) -> str:
    if variable.low is None:
        return f"{variable.name} in R"
    return f"{variable.name} {'>' if variable.strict else '≥'} {number_text(variable.low)}"


def conditional_text(
    variables: Iterable[Variable], hypotheses: Iterable[Relation], conclusion: Relation
) -> str:
    """``for all …: if …, then …``."""
    over = range_text(variables)
    given = " and ".join(map(relation_text, hypotheses))
    start = f"for all {over}: " if over else ""
    return start + (f"if {given}, then " if given else "") + relation_text(conclusion)
