"""Implications between inequalities: identities of signs or sums of squares, or a point at which they fail.

Polynomials are also shown by an identity  (1 + σ)·C = Σ μ_k σ_k H_k. C is the gap of the conclusion. H_k are
gaps of hypotheses, or 1. μ_k are monomials that are never negative. σ and σ_k are zᵀ L D Lᵀ z: z are
monomials, L has ones on its diagonal and 0 above it, and D ≥ 0 is diagonal. If H_k ≥ 0 and −H_k ≥ 0 are both
hypotheses, they are an equation, and μ_k σ_k may be any polynomial. Monomials are of variables and of sines
and cosines; both sides are compared with cos² = 1 − sin².

References: ``stengle1974nullstellensatz``, ``putinar1993positive``, ``parrilo2003semidefinite``.
"""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass
from fractions import Fraction

from flint import fmpq, fmpq_mpoly, fmpq_mpoly_ctx

from lyapcheck.check.expressions.domain import Comparison, Interval
from lyapcheck.check.expressions.expression import Unsupported, evaluate
from lyapcheck.check.expressions.expression import variables as variables_of
from lyapcheck.check.expressions.normal_form import RationalAlgebra, product, room_for
from lyapcheck.check.expressions.signs import NOT_NEGATIVE, PLUS, above, lower_bounds, of_monomial, of_terms
from lyapcheck.check.numbers.polynomials import rational
from lyapcheck.check.refusal import require
from lyapcheck.check.replay import Pointwise, domain_of, range_text, relation_text, require_relations
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
        over, given = range_text(self.variables), " and ".join(map(relation_text, self.hypotheses))
        start = f"for all {over}: " if over else ""
        return f"{start}{f'if {given}, then ' if given else ''}{relation_text(self.conclusion)}"


@rule(Implies, SignIdentity)
def by_signs(statement: Implies, proof: SignIdentity) -> Accepted:
    """Soundness: see :func:`require_identity`."""
    signs = signs_of(statement)
    require_identity(signs, signs.conclusion, statement.conclusion.strict, proof)
    return Accepted("proved", "exact")


def signs_of(statement: Implies) -> Signs:
    """The polynomials of the statement."""
    return Signs(statement.variables, statement.hypotheses, statement.conclusion)


# --- Sums of squares.

MOST_MONOMIALS, MOST_DEGREE = 200, 64
"""Of all vectors together, and of a monomial."""


@dataclass(frozen=True)
class Squares:
    """``Σ d_k (z_k + Σ_{i>k} L_ik z_i)²``; ``lower`` has the entries of L below its diagonal, row by row."""

    monomials: tuple[Monomial, ...]
    lower: tuple[tuple[Fraction, ...], ...]
    diagonal: tuple[Fraction, ...]


@dataclass(frozen=True)
class Product:
    """``monomial · squares · gap of a hypothesis``, or without that gap."""

    hypothesis: int | None
    monomial: Monomial
    squares: Squares


@dataclass(frozen=True)
class SumOfSquares(Proof):
    """``(1 + lift) · gap of the conclusion = Σ products``."""

    rule = "sum of squares"
    lift: Squares
    products: tuple[Product, ...]


@rule(Implies, SumOfSquares)
def by_squares(statement: Implies, proof: SumOfSquares) -> Accepted:
    """Soundness: take a point of the domain at which every hypothesis holds, in the generators of ``Signs``.

    There μ_k ≥ 0 by the bounds of its variables, σ_k ≥ 0 as D ≥ 0, and H_k ≥ 0. So (1 + σ)C ≥ 0, and C ≥ 0
    as 1 + σ ≥ 1. If μ_k > 0, H_k > 0 (it is 1, or strict) and σ_k > 0 for one k, then C > 0.
    A term of an equation is 0, whatever its factors are. A sine and a cosine are real numbers with
    cos² + sin² = 1; nothing else is used of them.
    For D > 0, σ_k = 0 only if Lᵀz = 0, that is z = 0. This is so nowhere if a monomial of z is positive, as 1
    is. If z has each variable by itself it can be so at the origin alone, which is no such point if a
    variable is positive or a hypothesis without sines fails there.
    """
    signs = signs_of(statement)
    conclusion, *hypotheses = gaps_of(signs)
    size = sum(len(one.monomials) for one in (proof.lift, *(term.squares for term in proof.products)))
    require(size <= MOST_MONOMIALS, "monomials", size, f"must be at most {MOST_MONOMIALS}")
    rest = product(conclusion, squares_of(signs, proof.lift)[0] + 1)
    strict = False
    for term in proof.products:
        gap, positive, equation = signs.ring.constant(1), True, False
        if term.hypothesis is not None:
            k = term.hypothesis
            require(0 <= k < len(hypotheses), "hypothesis", k, "does not exist")
            gap, positive = hypotheses[k], statement.hypotheses[k].strict
            equation = -gap in hypotheses
        over = exponents_of(signs, term.monomial)
        require(equation or signs.monomial_is(over, False), "monomial", term.monomial, "may be negative")
        value, definite = squares_of(signs, term.squares, equation)
        rest -= product(value * signs.ring.from_dict({over: fmpq(1)}), gap)
        strict = strict or (positive and definite and not equation and signs.monomial_is(over, True))
    require(
        signs.algebra.reduced(rest) == 0, "sum of squares", "", "is not the conclusion: both sides differ"
    )
    require(strict or not statement.conclusion.strict, "conclusion", "", "is not shown to be strict")
    return Accepted("proved", "exact")


def gaps_of(signs: Signs) -> list[fmpq_mpoly]:
    """The gaps of the conclusion and of the hypotheses; refused unless they are polynomials over ℚ."""
    tops, known = [signs.conclusion, *(top for top, _ in signs.hypotheses)], letters_of(signs)
    used = {i for top in tops for exponents in top.monoms() for i, e in enumerate(exponents) if e}
    plain = used <= known and all(bottom.is_constant() for bottom in signs.bottoms)
    require(plain, "relations", "", "are not all between polynomials over the rational numbers")
    return [top / bottom.leading_coefficient() for top, bottom in zip(tops, signs.bottoms, strict=True)]


def letters_of(signs: Signs) -> set[int]:
    """The generators that are variables, sines or cosines: each has a value wherever its argument has one."""
    circular = {i for (name, _), i in signs.algebra.uses.items() if name in ("sin", "cos")}
    return {*range(len(signs.algebra.names))} | circular


def squares_of(signs: Signs, squares: Squares, any_sign: bool = False) -> tuple[fmpq_mpoly, bool]:
    """The sum of squares, weights ≥ 0 or of any sign; whether it is positive wherever all hypotheses hold."""
    n, d, count = len(squares.monomials), squares.diagonal, len(signs.algebra.names)
    require(len(d) == n, "diagonal", len(d), f"must have {n} entries")
    shape = [len(row) for row in squares.lower]
    require(shape == list(range(n)), "lower", shape, "must have rows of 0, 1, 2, … entries, one a monomial")
    fits = any_sign or all(weight >= 0 for weight in d)
    require(fits, "diagonal", min(d, default=0), "must not be negative")
    z = [exponents_of(signs, monomial) for monomial in squares.monomials]
    terms = [signs.ring.from_dict({exponents: fmpq(1)}) for exponents in z]
    result = signs.ring.constant(0)
    for k, weight in enumerate(d):
        below = ((i, squares.lower[i][k]) for i in range(k + 1, n))
        row = sum((terms[i] * rational(entry) for i, entry in below if entry), terms[k])
        result += row * row * rational(weight)
    alone = {e.index(1) for e in z if sum(e) == 1}
    origin: Exponents = (0,) * signs.ring.nvars()
    plain = (one for one in signs.hypotheses if not any(any(e[count:]) for e in one[0].monoms()))
    at_origin = ((gap.to_dict().get(origin, 0), strict) for gap, strict in plain)
    excluded = any(value < 0 or (strict and value == 0) for value, strict in at_origin)
    excluded = excluded or any(own == PLUS for _, own in signs.bounds.values())
    apart = excluded and alone >= set(range(count))
    nowhere_0 = apart or any(signs.monomial_is(e, True) for e in z)
    return result, nowhere_0 and all(weight > 0 for weight in d)


def exponents_of(signs: Signs, monomial: Monomial) -> Exponents:
    """The exponents of a monomial in variables, sines and cosines, of a degree within reach."""
    result = signs.exponents(monomial)
    require(sum(result) <= MOST_DEGREE, "degree", sum(result), f"must be at most {MOST_DEGREE}")
    used = {i for i, e in enumerate(result) if e}
    require(used <= letters_of(signs), "monomial", monomial, "must be of variables, sines and cosines alone")
    return result
