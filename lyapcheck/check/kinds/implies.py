"""Implications between inequalities: an identity of signs, or a point at which they fail.

References: ``stengle1974nullstellensatz`` (these certificates are its simplest members).
"""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass
from fractions import Fraction

from flint import fmpq, fmpq_mpoly, fmpq_mpoly_ctx

from lyapcheck.check.expressions.domain import Comparison, Interval
from lyapcheck.check.expressions.expression import Unsupported, evaluate
from lyapcheck.check.expressions.expression import variables as variables_of
from lyapcheck.check.expressions.normal_form import RationalAlgebra, room_for
from lyapcheck.check.expressions.signs import NOT_NEGATIVE, PLUS, above, lower_bounds, of_monomial, of_terms
from lyapcheck.check.numbers.polynomials import rational
from lyapcheck.check.refusal import require
from lyapcheck.check.replay import Pointwise, conditional_text, domain_of, require_relations
from lyapcheck.check.statement import Proof, Relation, Variable
from lyapcheck.check.verify import Accepted, rule

# --- The polynomials of an implication, and identities  μ·C = Σ λ_k μ_k H_k + R  between them.
#
# C is the gap of the conclusion, H_k are gaps of hypotheses, λ_k > 0 are rational, μ and μ_k are monomials
# that are positive (or at least not negative), and R has no negative term.

Monomial = tuple[tuple[int, int], ...]
"""Pairs (generator, exponent)."""


@dataclass(frozen=True)
class Multiple:
    """``weight · monomial · gap of a hypothesis``."""

    hypothesis: int
    weight: Fraction
    monomial: Monomial


@dataclass(frozen=True)
class SignIdentity(Proof):
    """``lift · gap of the conclusion = Σ multiples + R``, in which no term of R is negative."""

    rule = "identity of signs"
    lift: Monomial
    multiples: tuple[Multiple, ...]


Exponents = tuple[int, ...]


class Signs:
    """The gaps of an implication as polynomials, and which generators are positive, non-negative or neither.

    ``conclusion`` and ``hypotheses`` have the signs of the gaps, in generators shifted by their lower bounds.

    Raises:
        Unsupported: a gap is not a quotient of polynomials with a bottom that is plainly positive.
    """

    def __init__(
        self, variables: Iterable[Variable], hypotheses: tuple[Relation, ...], conclusion: Relation
    ) -> None:
        relations = (conclusion, *hypotheses)
        names = sorted({name for r in relations for name in variables_of(r.gap)})
        self.algebra = RationalAlgebra(names, room_for(*(r.gap for r in relations)))
        self.ring: fmpq_mpoly_ctx = self.algebra.ring
        values = {name: self.algebra.variable(name) for name in names}
        ratios = [evaluate(r.gap, values, self.algebra) for r in relations]
        self.bounds = lower_bounds(self.algebra, domain_of(variables))
        self.conclusion, *tops = (self._shifted(ratio.top) for ratio in ratios)
        self.hypotheses = [(top, h.strict) for top, h in zip(tops, hypotheses, strict=True)]
        self.bottoms = [self._shifted(ratio.bottom) for ratio in ratios]
        """Of the conclusion and the hypotheses; the polynomials are the tops."""
        if not all(map(self.is_positive, self.bottoms)):
            raise Unsupported("a denominator whose sign is not plain from its terms")

    def _shifted(self, polynomial: fmpq_mpoly) -> fmpq_mpoly:
        return above(self.bounds, self.algebra.reduced(polynomial), self.ring)

    @property
    def is_polynomial(self) -> bool:
        """Whether the conclusion is a polynomial in its variables and in numbers, without functions."""
        plain = {*range(len(self.algebra.names)), *self.algebra.constants()}
        used = {i for exponents in self.conclusion.monoms() for i, e in enumerate(exponents) if e}
        return used <= plain

    def monomial_is(self, exponents: Exponents, positive: bool) -> bool:
        """Whether a monomial is >= 0 everywhere (> 0, if ``positive``)."""
        return of_monomial(exponents, self.bounds) <= (PLUS if positive else NOT_NEGATIVE)

    def is_nonnegative(self, polynomial: fmpq_mpoly) -> bool:
        """Whether every term is plainly >= 0."""
        return of_terms(polynomial, self.bounds) <= NOT_NEGATIVE

    def is_positive(self, polynomial: fmpq_mpoly) -> bool:
        """Whether every term is plainly >= 0 and one of them > 0."""
        return of_terms(polynomial, self.bounds) <= PLUS

    def exponents(self, monomial: Monomial) -> Exponents:
        """The exponents of all generators; refused where one does not exist or is not positive."""
        result = [0] * self.ring.nvars()
        for index, exponent in monomial:
            require(0 <= index < len(result), "generator", index, "does not exist")
            require(exponent > 0, "exponent", exponent, "must be positive")
            result[index] += exponent
        return tuple(result)


def require_identity(signs: Signs, goal: fmpq_mpoly, strict: bool, proof: SignIdentity) -> None:
    """Refuse unless an identity of signs shows goal >= 0 (> 0, if ``strict``).

    Soundness: μ > 0, so the goal has the sign of a sum of terms none of which is negative; it is positive if
    R is, or if a strict hypothesis enters with μ_k > 0.
    """
    lift = signs.exponents(proof.lift)
    require(signs.monomial_is(lift, True), "lift", proof.lift, "is not a positive monomial")
    remainder = goal * signs.ring.from_dict({lift: fmpq(1)})
    for multiple in proof.multiples:
        k, over = multiple.hypothesis, signs.exponents(multiple.monomial)
        require(0 <= k < len(signs.hypotheses), "hypothesis", k, "does not exist")
        require(multiple.weight > 0, "weight", multiple.weight, "must be positive")
        require(signs.monomial_is(over, False), "monomial", multiple.monomial, "may be negative")
        hypothesis, hypothesis_strict = signs.hypotheses[k]
        remainder -= hypothesis * signs.ring.from_dict({over: rational(multiple.weight)})
        strict = strict and not (hypothesis_strict and signs.monomial_is(over, True))
    shown = signs.is_positive(remainder) if strict else signs.is_nonnegative(remainder)
    require(shown, "remainder", "", "has a term that may be negative, or is not shown to be positive")


@dataclass(frozen=True)
class Implies(Pointwise):
    """For all values of the variables: if every hypothesis holds, so does the conclusion."""

    variables: tuple[Variable, ...]
    hypotheses: tuple[Relation, ...]
    conclusion: Relation

    def require_well_formed(self) -> None:
        require_relations((*self.hypotheses, self.conclusion), [v.name for v in self.variables])

    @property
    def ranges(self) -> dict[str, Interval]:
        return domain_of(self.variables)

    @property
    def at_points(self) -> tuple[tuple[Comparison, ...], Comparison]:
        return tuple(one.comparison for one in self.hypotheses), self.conclusion.comparison

    def text(self) -> str:
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
