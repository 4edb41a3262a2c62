"""Identities: equal normal forms, or a point at which both sides differ.

References: ``geddes1992algorithms``, chapter 3.
"""

from __future__ import annotations

from dataclasses import dataclass

from lyapcheck.check.expressions.domain import Domain
from lyapcheck.check.expressions.expression import Tree, variables
from lyapcheck.check.expressions.grammar import require_expressions
from lyapcheck.check.expressions.normal_form import is_zero
from lyapcheck.check.expressions.text import expression_text
from lyapcheck.check.kinds.parts import domain_of, range_text, require_distinct
from lyapcheck.check.refusal import require
from lyapcheck.check.replay import coordinates, require_failure, require_inside
from lyapcheck.check.statement import Proof, Statement, Variable, Witness
from lyapcheck.check.verify import Accepted, rule


@dataclass(frozen=True)
class Identity(Statement):
    """``left = right`` for all values of the variables; those not in ``variables`` are real numbers."""

    left: Tree
    right: Tree
    variables: tuple[Variable, ...] = ()

    def require_well_formed(self) -> None:
        """Expressions, and a range for variables that occur."""
        require_expressions((self.left, self.right))
        named = [variable.name for variable in self.variables]
        require_distinct("variables", named)
        for name in named:
            require(name in self.names, "variables", name, "does not occur")

    @property
    def names(self) -> set[str]:
        """The variables that occur."""
        return variables(self.left) | variables(self.right)

    def terms(self) -> list[tuple[Tree, Domain]]:
        """Both sides."""
        return [(side, domain_of(self.variables)) for side in (self.left, self.right)]

    def text(self) -> str:
        """``left = right for all …``."""
        sides = f"{expression_text(self.left)} = {expression_text(self.right)}"
        free = sorted(self.names - {variable.name for variable in self.variables})
        over = ", ".join(
            filter(None, [f"{', '.join(free)} in R" if free else "", range_text(self.variables)])
        )
        return f"{sides} for all {over}" if over else sides


@dataclass(frozen=True)
class NormalForm(Proof):
    """Both sides have the same normal form over ℚ."""

    rule = "normal form"


@rule(Identity, NormalForm)
def by_normal_form(statement: Identity, proof: NormalForm) -> Accepted:
    """Soundness: equal normal forms are equal functions, wherever both sides are defined."""
    require(is_zero(gap_of(statement)), "normal form", "", "that of the difference is not zero")
    return Accepted("proved", "exact")


@rule(Identity, Witness)
def by_witness(statement: Identity, proof: Witness) -> Accepted:
    """Soundness: disjoint balls for both sides at one point."""
    point = coordinates(proof.point, statement.names)
    require_inside(statement.variables, point)
    require_failure((statement.left, "=", statement.right), point, proof.bits)
    return Accepted("refuted", "enclosure")


def gap_of(statement: Identity) -> Tree:
    """The difference of both sides."""
    return ("add", statement.right, ("neg", statement.left))
