"""Implications between inequalities: proved by a certificate of signs, refuted by an exact point.

The proof is an identity  μ·C = Σ λ_k μ_k H_k + R  in which C is the gap of the conclusion, H_k are gaps of
hypotheses, λ_k > 0 are rational, μ and μ_k are monomials that are positive, and R has no negative term. It is
found by cancelling the negative terms of C one after the other.

References: ``stengle1974nullstellensatz`` (the certificates are its simplest members).
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from fractions import Fraction

from flint import fmpq, fmpq_mpoly, fmpq_mpoly_ctx

from lyapcheck.check.enclosure import Enclosure
from lyapcheck.check.functions import LEAVES, Tree, Unsupported, evaluate, variables
from lyapcheck.check.normal_form import RationalAlgebra, functions_in
from lyapcheck.claims.decision import Decision, proved, refuted, undecided
from lyapcheck.claims.expressions import Relation, expr
from lyapcheck.claims.procedures.search import first_refutation, witness_data
from lyapcheck.claims.statements import Implies, Variable
from lyapcheck.verdicts import Grade

METHOD = "implication between inequalities"
EFFORT = ((1, 40), (2, 80), (3, 160), (4, 320), (5, 640), (7, 2000))
"""Depth and number of nodes of the tries at a certificate."""
SEARCH_AFTER = 2
"""The depth after which counterexamples are searched, before deeper certificates are."""

ARITHMETIC = ("add", "mul", "neg", "div", "pow", "sqrt")

Exponents = tuple[int, ...]


def decide_implies(statement: Implies) -> Decision:
    """Decide whether hypotheses give a conclusion for all values of the variables.

    Soundness: ``proved`` rests on a polynomial identity in which every term has a sign that is known;
    ``refuted`` on one rational point, where balls show each hypothesis and the failure of the conclusion.
    """
    if not all(is_algebraic(r.gap) for r in (*statement.hypotheses, statement.conclusion)):
        return search(statement) or undecided(
            "no counterexample among the points tried, and no proof for functions that are not algebraic; "
            "bound them by claims of one variable and name the bounds",
            METHOD,
        )
    for depth, nodes in EFFORT:
        if _certified(statement, depth, nodes):
            return proved(Grade.EXACT, f"{METHOD}: identity with terms of known sign")
        found = search(statement) if depth == SEARCH_AFTER else None
        if found is not None:
            return found
    return undecided(
        "no certificate of signs and no counterexample among the points tried; "
        "split the claim, or add a hypothesis that bounds the variables",
        METHOD,
    )


def is_algebraic(tree: Tree) -> bool:
    """Whether an expression is built from numbers and variables by arithmetic and roots."""
    if tree[0] in LEAVES:
        return True
    return tree[0] in ARITHMETIC and all(is_algebraic(part) for part in tree[1:] if isinstance(part, tuple))


def search(statement: Implies) -> Decision | None:
    """A refutation by a point that balls confirm, or None."""
    from lyapcheck.claims.procedures.sampling import SAMPLES, SEED, candidates

    given = (*statement.hypotheses, *(_bound(v) for v in statement.variables if v.low is not None))
    points = candidates(statement.variables, statement.hypotheses, statement.conclusion)
    found = first_refutation(statement.conclusion, points, given)
    if found is None:
        return None
    data = witness_data(*found)
    return refuted(Grade.ENCLOSURE, f"{METHOD}: a point where it fails", data, samples=SAMPLES, seed=SEED)


def _bound(variable: Variable) -> Relation:
    low: Tree = expr(variable.low).tree
    return Relation(low, "<" if variable.strict else "<=", ("var", variable.name))


def _certified(statement: Implies, depth: int, nodes: int) -> bool:
    """Whether a certificate of signs is found within the effort."""
    try:
        signs = Signs(statement)
        conclusion = signs.polynomial(statement.conclusion)
        hypotheses = [(signs.polynomial(h), h.strict) for h in statement.hypotheses]
    except Unsupported:
        return False
    return Cancellation(signs, hypotheses, nodes).reaches(conclusion, statement.conclusion.strict, depth)


class Signs:
    """The polynomial ring of a statement, and which generators are positive, non-negative or of any sign."""

    def __init__(self, statement: Implies) -> None:
        relations = (*statement.hypotheses, statement.conclusion)
        self.known = {v.name: v for v in statement.variables}
        names = sorted({name for r in relations for name in variables(r.gap)})
        slots = sum(2 * functions_in(r.gap) for r in relations) + 4
        self.algebra = RationalAlgebra(names, slots)
        self.ring: fmpq_mpoly_ctx = self.algebra.ring

    def polynomial(self, relation: Relation) -> fmpq_mpoly:
        """A polynomial with the sign of the gap, in generators shifted to be >= 0 where possible."""
        values = {name: self.algebra.variable(name) for name in self.algebra.names}
        ratio = evaluate(relation.gap, values, self.algebra)
        top, bottom = (self._shifted(self.algebra.reduced(p)) for p in (ratio.top, ratio.bottom))
        if not self.is_positive(bottom):
            raise Unsupported("a denominator whose sign is not plain from its terms")
        return top

    def _shifted(self, polynomial: fmpq_mpoly) -> fmpq_mpoly:
        generators = list(self.ring.gens())
        for i, name in enumerate(self.algebra.names):
            low = self.known[name].low
            if low:
                generators[i] += self.ring.constant(fmpq(low.numerator, low.denominator))
        for i, ball in self.algebra.constants().items():
            generators[i] += self.ring.constant(_below(Enclosure.from_arb(ball).lower))
        return polynomial.compose(*generators, ctx=self.ring)

    def kind(self, index: int) -> str:
        """``positive``, ``nonnegative`` or ``real``, of a generator after the shift."""
        if index < len(self.algebra.names):
            variable = self.known[self.algebra.names[index]]
            if variable.low is None:
                return "real"
            return "positive" if variable.strict else "nonnegative"
        return "nonnegative" if index in self.algebra.constants() else "real"

    def monomial_is(self, exponents: Exponents, positive: bool) -> bool:
        """Whether a monomial is >= 0 everywhere (> 0, if ``positive``)."""
        kinds = [(self.kind(i), int(e)) for i, e in enumerate(exponents) if e]
        if positive:
            return all(kind == "positive" for kind, _ in kinds)
        return all(kind != "real" or e % 2 == 0 for kind, e in kinds)

    def is_nonnegative(self, polynomial: fmpq_mpoly) -> bool:
        """Whether every term is plainly >= 0."""
        return all(c > 0 and self.monomial_is(e, False) for e, c in polynomial.to_dict().items())

    def is_positive(self, polynomial: fmpq_mpoly) -> bool:
        """Whether every term is plainly >= 0 and one of them > 0."""
        terms = polynomial.to_dict()
        return self.is_nonnegative(polynomial) and any(self.monomial_is(e, True) for e in terms)


def _below(value: Fraction) -> fmpq:
    """A short rational at or below a positive number."""
    return fmpq(int(value * 16), 16)


@dataclass
class Cancellation:
    """The search for μ·C = Σ λ_k μ_k H_k + R, within a number of nodes."""

    signs: Signs
    hypotheses: list[tuple[fmpq_mpoly, bool]]
    nodes: int

    def reaches(self, goal: fmpq_mpoly, strict: bool, depth: int) -> bool:
        """Whether goal >= 0 (> 0 if strict) follows; a strict hypothesis, once used, leaves >= 0 to show."""
        self.nodes -= 1
        if self.signs.is_positive(goal) if strict else self.signs.is_nonnegative(goal):
            return True
        if depth == 0:
            return False
        return any(self.reaches(goal, still, depth - 1) for goal, still in self._next(goal, strict))

    def _next(self, goal: fmpq_mpoly, strict: bool) -> Iterator[tuple[fmpq_mpoly, bool]]:
        for hypothesis, hypothesis_strict in self.hypotheses:
            for remainder, positive in _cancellations(self.signs, goal, hypothesis):
                if self.nodes <= 0:
                    return
                yield remainder, strict and not (hypothesis_strict and positive)


def _cancellations(
    signs: Signs, goal: fmpq_mpoly, hypothesis: fmpq_mpoly
) -> Iterator[tuple[fmpq_mpoly, bool]]:
    """Remainders μ·goal − λ·μ'·hypothesis without one negative term of the goal, and whether μ' > 0."""
    bad = [(e, c) for e, c in goal.to_dict().items() if c < 0 or not signs.monomial_is(e, False)]
    for e, c in bad[:1]:
        for f, d in hypothesis.to_dict().items():
            if c / d <= 0:
                continue
            up = tuple(max(int(b) - int(a), 0) for a, b in zip(e, f, strict=True))
            over = tuple(max(int(a) - int(b), 0) for a, b in zip(e, f, strict=True))
            if signs.monomial_is(up, True) and signs.monomial_is(over, False):
                lift, weight = signs.ring.from_dict({up: fmpq(1)}), signs.ring.from_dict({over: c / d})
                yield goal * lift - hypothesis * weight, signs.monomial_is(over, True)
