"""Relations that hold for every small enough positive value of one variable ε.

The gap of the conclusion is a polynomial p(ε, t, …), t in (0, 1]. Divided by the powers of ε and t that
divide it, it is continuous on the compact range of t, so p > 0 for small ε as soon as its value at ε = 0 is
positive and free of t. That value is the leading term, and its sign is an implication of its own.
"""

from __future__ import annotations

from dataclasses import dataclass
from fractions import Fraction

from flint import fmpq_mpoly

from lyapcheck.check.expressions.domain import POSITIVE, Domain, Interval
from lyapcheck.check.expressions.expression import Tree
from lyapcheck.check.kinds.parts import conditional_text, domain_of, require_relations, terms_of
from lyapcheck.check.kinds.signs import SignIdentity, Signs, require_identity
from lyapcheck.check.refusal import Refused
from lyapcheck.check.statement import Proof, Relation, Statement, Variable
from lyapcheck.check.verify import Accepted, rule


@dataclass(frozen=True)
class ForSmall(Statement):
    """If the hypotheses hold, the relation holds for every small enough positive value of one variable.

    Every variable named in ``bounded`` runs over (0, 1], and the threshold serves all of them.
    """

    small: str
    variables: tuple[Variable, ...]
    hypotheses: tuple[Relation, ...]
    conclusion: Relation
    bounded: tuple[str, ...] = ()

    def require_well_formed(self) -> None:
        """Refuse what the rules should not have to look at."""
        names = [*(v.name for v in self.variables), self.small, *self.bounded]
        require_relations((*self.hypotheses, self.conclusion), names)

    def terms(self) -> list[tuple[Tree, Domain]]:
        """All sides, for every positive value of the small variable and bounded ones in (0, 1]."""
        unit = Interval(Fraction(0), Fraction(1), open_low=True)
        domain = domain_of(self.variables) | {self.small: POSITIVE} | dict.fromkeys(self.bounded, unit)
        return terms_of((*self.hypotheses, self.conclusion), domain)

    def text(self) -> str:
        """The statement in one line."""
        body = conditional_text(self.variables, self.hypotheses, self.conclusion)
        return f"for every small enough {self.small} > 0: {body}"


@dataclass(frozen=True)
class LeadingTerm(Proof):
    """The leading term as the small variable goes to 0 is positive by an identity of signs."""

    rule = "leading term"
    identity: SignIdentity


@rule(ForSmall, LeadingTerm)
def by_leading_term(statement: ForSmall, proof: LeadingTerm) -> Accepted:
    """Soundness: a positive limit persists below some threshold that serves the whole range of t."""
    signs = signs_of(statement)
    limit = leading_term(signs, statement)
    if limit is None:
        raise Refused("leading term", "", "contains a bounded variable, or there is no small variable")
    require_identity(signs, limit, True, proof.identity)
    return Accepted("proved", "exact")


def signs_of(statement: ForSmall) -> Signs:
    """The polynomials of the statement, with the small and the bounded variables positive."""
    more = tuple(Variable(name, Fraction(0)) for name in (statement.small, *statement.bounded))
    return Signs((*statement.variables, *more), statement.hypotheses, statement.conclusion)


def leading_term(signs: Signs, statement: ForSmall) -> fmpq_mpoly | None:
    """What is left of the gap at ε = 0 after division by common powers; ``None`` if it contains some t."""
    names = signs.algebra.names
    if statement.small not in names:
        return None
    terms = signs.conclusion.to_dict()
    free = [names.index(name) for name in (statement.small, *statement.bounded) if name in names]
    lowest = [min((int(e[i]) for e in terms), default=0) for i in free]
    leading = {}
    for exponents, coefficient in terms.items():
        rest = list(map(int, exponents))
        for i, low in zip(free, lowest, strict=True):
            rest[i] -= low
        if rest[free[0]] == 0:
            if any(rest[i] for i in free):
                return None
            leading[tuple(rest)] = coefficient
    return signs.ring.from_dict(leading)
