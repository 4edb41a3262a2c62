"""Identities: equal normal forms, or a point at which both sides differ.

References: ``geddes1992algorithms``, chapter 3.
"""

from __future__ import annotations

from dataclasses import dataclass

from lyapcheck.check.expressions.expression import Tree, variables
from lyapcheck.check.expressions.grammar import require_expressions
from lyapcheck.check.expressions.normal_form import is_zero
from lyapcheck.check.expressions.text import expression_text
from lyapcheck.check.refusal import require
from lyapcheck.check.replay import coordinates, require_failure
from lyapcheck.check.statement import Proof, Statement, Witness
from lyapcheck.check.verify import Accepted, rule


@dataclass(frozen=True)
class Identity(Statement):
    """``left = right`` for all values of the variables."""

    left: Tree
    right: Tree

    def require_well_formed(self) -> None:
        """Refuse what the rules should not have to look at."""
        require_expressions((self.left, self.right))

    def text(self) -> str:
        """The statement in one line."""
        return f"{expression_text(self.left)} = {expression_text(self.right)}"


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
    names = variables(statement.left) | variables(statement.right)
    point = coordinates(proof.point, names)
    require_failure((statement.left, "=", statement.right), point, proof.bits)
    return Accepted("refuted", "enclosure")


def gap_of(statement: Identity) -> Tree:
    """The difference of both sides."""
    return ("add", statement.right, ("neg", statement.left))
