"""Implications between inequalities: an identity of signs, or a point at which they fail."""

from __future__ import annotations

from dataclasses import dataclass

from lyapcheck.check.expressions.domain import Interval
from lyapcheck.check.expressions.witness import Comparison
from lyapcheck.check.kinds.parts import conditional_text, domain_of, require_relations
from lyapcheck.check.kinds.signs import SignIdentity, Signs, require_identity
from lyapcheck.check.replay import Pointwise
from lyapcheck.check.statement import Relation, Variable
from lyapcheck.check.verify import Accepted, rule


@dataclass(frozen=True)
class Implies(Pointwise):
    """For all values of the variables: if every hypothesis holds, so does the conclusion."""

    variables: tuple[Variable, ...]
    hypotheses: tuple[Relation, ...]
    conclusion: Relation

    def require_well_formed(self) -> None:
        """Refuse what the rules should not have to look at."""
        require_relations((*self.hypotheses, self.conclusion), [v.name for v in self.variables])

    @property
    def ranges(self) -> dict[str, Interval]:
        """The ranges of the variables."""
        return domain_of(self.variables)

    @property
    def at_points(self) -> tuple[tuple[Comparison, ...], Comparison]:
        """As they are."""
        return tuple(one.comparison for one in self.hypotheses), self.conclusion.comparison

    def text(self) -> str:
        """The statement in one line."""
        return conditional_text(self.variables, self.hypotheses, self.conclusion)


@rule(Implies, SignIdentity)
def by_signs(statement: Implies, proof: SignIdentity) -> Accepted:
    """Soundness: see :func:`require_identity`."""
    signs = signs_of(statement)
    require_identity(signs, signs.conclusion, statement.conclusion.strict, proof)
    return Accepted("proved", "exact")


def signs_of(statement: Implies) -> Signs:
    """The polynomials of the statement."""
    return Signs(statement.variables, statement.hypotheses, statement.conclusion)
