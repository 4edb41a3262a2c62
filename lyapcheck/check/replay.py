"""Points at which a statement fails, replayed in balls, and exactly where these do not decide.

References: ``johansson2017arb``.
"""

from __future__ import annotations

from abc import abstractmethod
from collections.abc import Iterable, Mapping
from fractions import Fraction

from flint import ctx

from lyapcheck.check.expressions.domain import Comparison, Domain, Interval, holds
from lyapcheck.check.expressions.expression import Tree
from lyapcheck.check.expressions.grammar import require_expressions
from lyapcheck.check.expressions.signs import require_defined_at
from lyapcheck.check.expressions.text import expression_text, number_text
from lyapcheck.check.refusal import require
from lyapcheck.check.statement import OfTerms, Point, Relation, Variable, Witness
from lyapcheck.check.verify import Accepted, rule

MAX_BITS = 16_384


def require_bits(bits: int) -> int:
    """A precision that is meaningful and within reach."""
    require(32 <= bits <= MAX_BITS, "bits", bits, f"must be from 32 to {MAX_BITS}")
    return bits


def coordinates(point: Point, names: Iterable[str]) -> dict[str, Fraction]:
    """The coordinates of a point by name; refused unless it gives those of the statement, each once."""
    result = dict(point)
    wanted = set(names)
    shown = ", ".join(name for name, _ in point)
    require(len(result) == len(point), "point", shown, "gives one coordinate twice")
    require(set(result) == wanted, "point", shown, f"must give {', '.join(sorted(wanted)) or 'nothing'}")
    return result


class Pointwise(OfTerms):
    """A statement that a relation holds at every point of a domain at which its hypotheses do."""

    @property
    @abstractmethod
    def ranges(self) -> Mapping[str, Interval]:
        """Its variables."""

    @property
    @abstractmethod
    def at_points(self) -> tuple[tuple[Comparison, ...], Comparison]:
        """The hypotheses and the conclusion."""

    def terms(self) -> list[tuple[Tree, Domain]]:
        """All sides over the whole domain: hypotheses give no term a value."""
        given, conclusion = self.at_points
        return [(side, self.ranges) for one in (*given, conclusion) for side in one[::2]]


@rule(Pointwise, Witness)
def by_witness(statement: Pointwise, proof: Witness) -> Accepted:
    """Soundness: a point of the domain; every hypothesis holds and the conclusion fails, in balls."""
    point = coordinates(proof.point, statement.ranges)
    require_inside(statement.ranges, point)
    hypotheses, conclusion = statement.at_points
    for left, _, right in (conclusion, *hypotheses):
        require_defined_at(left, point)
        require_defined_at(right, point)
    with ctx.workprec(require_bits(proof.bits)):
        met = all(holds(hypothesis, point) is True for hypothesis in hypotheses)
        fails = met and holds(conclusion, point) is False
    shown = ", ".join(f"{name} = {value}" for name, value in point.items())
    require(fails, "point", shown, "is not shown to break the statement")
    return Accepted("refuted", "enclosure")


def require_inside(ranges: Mapping[str, Interval], point: dict[str, Fraction]) -> None:
    """Refuse a point that lies outside the ranges of the variables."""
    for name, interval in ranges.items():
        require(point[name] in interval, name, point[name], f"must be {interval}")


# --- What several kinds of statement share: relations and the ranges of variables, their form and their text.


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
    return ", ".join(
        f"{one.name} in R"
        if one.low is None
        else f"{one.name} {'>' if one.strict else '≥'} {number_text(one.low)}"
        for one in variables
    )
