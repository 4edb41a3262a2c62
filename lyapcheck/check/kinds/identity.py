"""Identities: equal normal forms, or a point at which both sides differ.

References: ``geddes1992algorithms``, chapter 3.
"""

from __future__ import annotations

from dataclasses import dataclass

from lyapcheck.check.expressions.domain import REALS, Interval
from lyapcheck.check.expressions.expression import Tree, variables
from lyapcheck.check.expressions.grammar import require_expressions
from lyapcheck.check.expressions.normal_form import is_zero
from lyapcheck.check.expressions.text import expression_text
from lyapcheck.check.expressions.witness import Comparison
from lyapcheck.check.kinds.parts import domain_of, range_text, require_distinct
from lyapcheck.check.refusal import require
from lyapcheck.check.replay import Pointwise
from lyapcheck.check.statement import Proof, Variable
from lyapcheck.check.verify import Accepted, rule


@dataclass(frozen=True)
class Identity(Pointwise):
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

    @property
    def ranges(self) -> dict[str, Interval]:
        """Real numbers, unless it is said otherwise."""
        return dict.fromkeys(self.names, REALS) | domain_of(self.variables)

    @property
    def at_points(self) -> tuple[tuple[()], Comparison]:
        """Both sides, on no hypothesis."""
        return (), (self.left, "=", self.right)

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


def gap_of(statement: Identity) -> Tree:
    """The difference of both sides."""
    return ("add", statement.right, ("neg", statement.left))
