"""Relations that hold for every small enough positive value of one variable ε, or fail for all of them.

The gap of the conclusion is a polynomial p(ε, t, …), t in (0, 1]. Divided by the powers of ε and t that
divide it, it is continuous on the compact range of t, so p > 0 for small ε as soon as its value at ε = 0 is
positive and free of t. That value is the leading term, and its sign is an implication of its own.

At a point of all other variables each gap is a function of ε alone. It has, for
small ε, the sign of its dominant term. Hypotheses that hold so, and a conclusion that
fails so, refute the statement.
"""

from __future__ import annotations

from dataclasses import dataclass
from fractions import Fraction

from flint import fmpq_mpoly

from lyapcheck.check.expressions.domain import POSITIVE, Domain, Interval
from lyapcheck.check.expressions.expression import Tree, substitute, variables
from lyapcheck.check.expressions.normal_form import is_zero
from lyapcheck.check.expressions.scales import sign_beside
from lyapcheck.check.expressions.signs import require_defined
from lyapcheck.check.kinds.implies import SignIdentity, Signs, require_identity
from lyapcheck.check.refusal import Refused, require
from lyapcheck.check.replay import (
    coordinates,
    domain_of,
    range_text,
    relation_text,
    require_inside,
    require_relations,
    terms_of,
)
from lyapcheck.check.statement import OfTerms, Point, Proof, Relation, Variable
from lyapcheck.check.verify import Accepted, rule

UNIT = Interval(Fraction(0), Fraction(1), open_low=True)
NEAR = Fraction(1, 2**64)
"""Up to here the dominant term has to dominate."""


@dataclass(frozen=True)
class ForSmall(OfTerms):
    """If the hypotheses hold, the relation holds for every small enough positive value of one variable.

    Every variable named in ``bounded`` runs over (0, 1], and the threshold serves all of them.
    """

    small: str
    variables: tuple[Variable, ...]
    hypotheses: tuple[Relation, ...]
    conclusion: Relation
    bounded: tuple[str, ...] = ()

    def require_well_formed(self) -> None:
        names = [*(v.name for v in self.variables), self.small, *self.bounded]
        require_relations((*self.hypotheses, self.conclusion), names)

    def terms(self) -> list[tuple[Tree, Domain]]:
        """All sides, for every positive value of the small variable and bounded ones in (0, 1]."""
        domain = domain_of(self.variables) | {self.small: POSITIVE} | dict.fromkeys(self.bounded, UNIT)
        return terms_of((*self.hypotheses, self.conclusion), domain)

    def text(self) -> str:
        over, given = range_text(self.variables), " and ".join(map(relation_text, self.hypotheses))
        unit = f" and all {', '.join(self.bounded)} in (0, 1]" if self.bounded else ""
        return (
            f"{f'for all {over}: ' if over else ''}for every small enough {self.small} > 0{unit}"
            f"{f', if {given}' if given else ''}: {relation_text(self.conclusion)}"
        )


@dataclass(frozen=True)
class LeadingTerm(Proof):
    """The leading term as the small variable goes to 0 is positive by an identity of signs."""

    rule = "leading term"
    identity: SignIdentity


@rule(ForSmall, LeadingTerm)
def by_leading_term(statement: ForSmall, proof: LeadingTerm) -> Accepted:
    """Soundness: a positive limit persists below some threshold that serves the whole range of t."""
    signs = signs_of(statement)
    require(
        signs.is_polynomial, "conclusion", "", "has functions in it, which may depend on the small variable"
    )
    limit = leading_term(signs, statement)
    if limit is None:
        raise Refused(
            "leading term", "", "contains a bounded variable or functions, or there is no small one"
        )
    require_identity(signs, limit, True, proof.identity)
    return Accepted("proved", "exact")


@dataclass(frozen=True)
class SmallWitness(Proof):
    """A rational point of all variables but the small one; ``below`` it, all terms have values there."""

    rule = "failure for small values"
    point: Point
    below: Fraction


@rule(ForSmall, SmallWitness)
def by_small_witness(statement: ForSmall, proof: SmallWitness) -> Accepted:
    """Soundness: for all small ε every hypothesis holds at the point and the conclusion fails there."""
    names = [*(v.name for v in statement.variables), *statement.bounded]
    point = coordinates(proof.point, names)
    require_inside(domain_of(statement.variables) | dict.fromkeys(statement.bounded, UNIT), point)
    require(proof.below > 0, "below", proof.below, "must be positive")
    domain = {statement.small: Interval(Fraction(0), proof.below, open_low=True)}
    for tree, _ in statement.terms():
        require_defined(at(point, tree), domain)
    for hypothesis in statement.hypotheses:
        sign = sign_for_small(at(point, hypothesis.gap))
        require(sign > 0 or (sign == 0 and not hypothesis.strict), "point", "", "breaks a hypothesis")
    sign = sign_for_small(at(point, statement.conclusion.gap))
    failing = sign < 0 or (sign == 0 and statement.conclusion.strict)
    require(failing, "point", "", "does not break the conclusion for small values")
    return Accepted("refuted", "enclosure")


def at(point: dict[str, Fraction], tree: Tree) -> Tree:
    """An expression with numbers for the variables of a point."""
    return substitute(tree, {name: ("num", str(value)) for name, value in point.items()})


def sign_for_small(tree: Tree) -> int:
    """The sign of an expression for all small enough positive values of its one variable; refused if open."""
    if is_zero(tree):
        return 0
    names = variables(tree)
    require(len(names) <= 1, "variables", ", ".join(sorted(names)), "must be one")
    sign = sign_beside(tree, next(iter(names), ""), Fraction(0), NEAR)
    require(sign != 0, "expression", "", "has no certain sign for small values")
    return sign


def signs_of(statement: ForSmall) -> Signs:
    """The polynomials of the statement, with the small and the bounded variables positive."""
    more = tuple(Variable(name, Fraction(0)) for name in (statement.small, *statement.bounded))
    return Signs((*statement.variables, *more), statement.hypotheses, statement.conclusion)


def leading_term(signs: Signs, statement: ForSmall) -> fmpq_mpoly | None:
    """What is left of the gap at ε = 0 after division by common powers.

    ``None`` if it contains some t, or functions, which may depend on ε.
    """
    names = signs.algebra.names
    if statement.small not in names or not signs.is_polynomial:
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
