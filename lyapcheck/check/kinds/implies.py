"""Implications between inequalities: an identity of signs, or a point at which they fail."""

from __future__ import annotations

from dataclasses import dataclass

from lyapcheck.check.expressions.domain import Domain
from lyapcheck.check.expressions.expression import Tree
from lyapcheck.check.kinds.parts import conditional_text, domain_of, require_relations, terms_of
from lyapcheck.check.kinds.signs import SignIdentity, Signs, require_identity
from lyapcheck.check.replay import coordinates, require_failure, require_inside
from lyapcheck.check.statement import Relation, Statement, Variable, Witness
from lyapcheck.check.verify import Accepted, rule


@dataclass(frozen=True)
class Implies(Statement):
    """For all values of the variables: if every hypothesis holds, so does the conclusion."""

    variables: tuple[Variable, ...]
    hypotheses: tuple[Relation, ...]
    conclusion: Relation

    def require_well_formed(self) -> None:
        """Refuse what the rules should not have to look at."""
        require_relations((*self.hypotheses, self.conclusion), [v.name for v in self.variables])

    def terms(self) -> list[tuple[Tree, Domain]]:
        """All sides, for all values of the variables: hypotheses give no term a value."""
        return terms_of((*self.hypotheses, self.conclusion), domain_of(self.variables))

    def text(self) -> str:
        """The statement in one line."""
        return conditional_text(self.variables, self.hypotheses, self.conclusion)


@rule(Implies, SignIdentity)
def by_signs(statement: Implies, proof: SignIdentity) -> Accepted:
    """Soundness: see :func:`require_identity`."""
    signs = signs_of(statement)
    require_identity(signs, signs.conclusion, statement.conclusion.strict, proof)
    return Accepted("proved", "exact")


@rule(Implies, Witness)
def by_witness(statement: Implies, proof: Witness) -> Accepted:
    """Soundness: variables in their ranges; every hypothesis holds and the conclusion fails, in balls."""
    point = coordinates(proof.point, [v.name for v in statement.variables])
    require_inside(statement.variables, point)
    given = tuple(hypothesis.comparison for hypothesis in statement.hypotheses)
    require_failure(statement.conclusion.comparison, point, proof.bits, given)
    return Accepted("refuted", "enclosure")


def signs_of(statement: Implies) -> Signs:
    """The polynomials of the statement."""
    return Signs(statement.variables, statement.hypotheses, statement.conclusion)
