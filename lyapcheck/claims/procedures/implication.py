"""Implications between inequalities, also for every small ε: certificates of signs or squares, exact points.

A certificate of signs is an identity  μ·C = Σ λ_k μ_k H_k + R.  C is the gap of the conclusion, H_k are gaps
of hypotheses, λ_k > 0 are rational, μ and μ_k are positive monomials, and R has no negative term. It is
found by cancelling the negative terms of C one after the other. ``squares`` has the sums of squares.

References: ``stengle1974nullstellensatz`` (the certificates are its simplest members).
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from contextlib import suppress
from dataclasses import dataclass
from fractions import Fraction

from flint import ctx, fmpq, fmpq_mpoly

from lyapcheck.check.expressions.domain import Comparison
from lyapcheck.check.expressions.expression import LEAVES, Tree, Unsupported, ball
from lyapcheck.check.kinds.for_small import (
    ForSmall,
    LeadingTerm,
    SmallWitness,
    at,
    leading_term,
    sign_for_small,
)
from lyapcheck.check.kinds.for_small import signs_of as small_signs
from lyapcheck.check.kinds.implies import (
    Exponents,
    Implies,
    Monomial,
    Multiple,
    SignIdentity,
    Signs,
    gaps_of,
    signs_of,
)
from lyapcheck.check.numbers.polynomials import Enclosure, ball_of, fraction
from lyapcheck.check.refusal import Refused
from lyapcheck.check.statement import Relation, Variable
from lyapcheck.check.verify import verify
from lyapcheck.claims.procedures.descents import lowest_points
from lyapcheck.claims.procedures.search import (
    BITS,
    Failure,
    Point,
    first_refutation,
    point_of,
    round_points,
    rounder,
    witness_data,
    witness_of,
)
from lyapcheck.claims.procedures.squares import NEEDED, by_equations, by_squares
from lyapcheck.claims.search_result import SearchResult, broken, failing, procedure, shown, still_open
from lyapcheck.control.judgement import refutes
from lyapcheck.errors import PACKAGES, installed, repair

# --- The search for identities of signs: negative terms of the conclusion are cancelled one after the other.


@dataclass(frozen=True)
class CancelledTerm:
    """goal · lift − weight · over · hypothesis: the goal without one of its negative terms."""

    hypothesis: int
    weight: fmpq
    over: Exponents
    lift: Exponents


@dataclass
class Cancellation:
    """The search for μ·C = Σ λ_k μ_k H_k + R, within a number of nodes."""

    signs: Signs
    nodes: int

    def identity(self, goal: fmpq_mpoly, strict: bool, depth: int) -> SignIdentity | None:
        """An identity that shows goal >= 0 (> 0 if strict), or None."""
        steps = self._steps(goal, strict, depth)
        if steps is None:
            return None
        multiples: list[Multiple] = []
        lift: Exponents = ()
        for step in reversed(steps):  # later lifts multiply the hypothesis of a step
            weight = fraction(step.weight)
            multiples.insert(0, Multiple(step.hypothesis, weight, _sparse(_times(step.over, lift))))
            lift = _times(step.lift, lift)
        return SignIdentity(_sparse(lift), tuple(multiples))

    def _steps(self, goal: fmpq_mpoly, strict: bool, depth: int) -> list[CancelledTerm] | None:
        """The cancellations that lead to the end; a strict hypothesis, once used, leaves >= 0 to show."""
        self.nodes -= 1
        if self.signs.is_positive(goal) if strict else self.signs.is_nonnegative(goal):
            return []
        if depth == 0:
            return None
        for step, remainder, still in self._next(goal, strict):
            rest = self._steps(remainder, still, depth - 1)
            if rest is not None:
                return [step, *rest]
        return None

    def _next(self, goal: fmpq_mpoly, strict: bool) -> Iterator[tuple[CancelledTerm, fmpq_mpoly, bool]]:
        for k, (hypothesis, hypothesis_strict) in enumerate(self.signs.hypotheses):
            for step in self._cancellations(goal, k):
                if self.nodes <= 0:
                    return
                lift = self.signs.ring.from_dict({step.lift: fmpq(1)})
                over = self.signs.ring.from_dict({step.over: step.weight})
                helps = hypothesis_strict and self.signs.monomial_is(step.over, True)
                yield step, goal * lift - hypothesis * over, strict and not helps

    def _cancellations(self, goal: fmpq_mpoly, k: int) -> Iterator[CancelledTerm]:
        """The ways to cancel the first term of the goal that may be negative."""
        signs = self.signs
        terms = goal.to_dict().items()
        bad = next(((e, c) for e, c in terms if c < 0 or not signs.monomial_is(e, False)), None)
        if bad is None:
            yield from self._strict_parts(goal, k)
            return
        e, c = bad
        for f, d in signs.hypotheses[k][0].to_dict().items():
            if c / d <= 0:
                continue
            lift = tuple(max(int(b) - int(a), 0) for a, b in zip(e, f, strict=True))
            over = tuple(max(int(a) - int(b), 0) for a, b in zip(e, f, strict=True))
            if signs.monomial_is(lift, True) and signs.monomial_is(over, False):
                yield CancelledTerm(k, c / d, over, lift)

    def _strict_parts(self, goal: fmpq_mpoly, k: int) -> Iterator[CancelledTerm]:
        """The most of a strict hypothesis, times a positive monomial, that leaves no term below 0."""
        hypothesis, strict = self.signs.hypotheses[k]
        terms, parts = goal.to_dict(), hypothesis.to_dict()
        if not strict:
            return
        quotients = {tuple(int(a) - int(b) for a, b in zip(e, f, strict=True)) for e in terms for f in parts}
        for over in sorted(quotients):
            if min(over) < 0 or not self.signs.monomial_is(over, True):
                continue
            moved = {_times(f, over): d for f, d in parts.items()}
            if all(self.signs.monomial_is(f, False) for f in moved):
                most = min((terms.get(f, fmpq(0)) / d for f, d in moved.items() if d > 0), default=fmpq(1))
                if most > 0:
                    yield CancelledTerm(k, most, over, (0,) * len(over))


def _times(a: Exponents, b: Exponents) -> Exponents:
    return tuple(x + y for x, y in zip(a, b, strict=True)) if b else a


def _sparse(exponents: Exponents) -> Monomial:
    return tuple((i, e) for i, e in enumerate(exponents) if e)


METHOD = "implication between inequalities"
EFFORT = ((1, 40), (2, 80), (3, 160), (4, 320), (5, 640), (7, 2000))
"""Depth and number of nodes of the tries at a certificate."""
SEARCH_AFTER = 2
"""The depth after which counterexamples are searched, before deeper certificates are."""

ARITHMETIC = ("add", "mul", "neg", "div", "pow", "sqrt", "sin", "cos")


@procedure(Implies)
def find_implies(statement: Implies) -> SearchResult:
    """Look for an identity of signs, for counterexamples and equations by turns, then for sums of squares."""
    if not all(is_algebraic(r.gap) for r in (*statement.hypotheses, statement.conclusion)):
        return _refuted(statement) or still_open(
            "no counterexample among the points tried, and no proof for functions that are not algebraic; "
            "bound them by claims of one variable and name the bounds",
            METHOD,
        )
    signs: Signs | None = None
    with suppress(Unsupported):
        signs = signs_of(statement)
    for depth, nodes in EFFORT:
        if signs is not None:
            search = Cancellation(signs, nodes)
            identity = search.identity(signs.conclusion, statement.conclusion.strict, depth)
            if identity is not None:
                return shown(identity, f"{METHOD}: identity with terms of known sign")
        if depth == SEARCH_AFTER:
            result = _refuted(statement) or _by_equations(statement, signs)
            if result is not None:
                return result
    result = None if signs is None else _by_squares(statement, signs)
    return result or still_open(
        "no certificate of signs and no counterexample among the points tried; "
        "split the claim, or add a hypothesis: a bound of the variables, or what always holds, as "
        "0 <= (x - y)**2",
        METHOD,
    )


def _by_equations(statement: Implies, signs: Signs | None) -> SearchResult | None:
    if signs is None:
        return None
    try:
        proof = by_equations(statement)
        if proof is not None:
            verify(statement, proof)
    except (Refused, Unsupported):
        return None
    return None if proof is None else shown(proof, f"{METHOD}: equations")


def _by_squares(statement: Implies, signs: Signs) -> SearchResult | None:
    """The points where descents end, then sums of squares, for polynomials."""
    try:
        gaps_of(signs)
    except Refused:
        return None
    missing = next((one for one in NEEDED if not installed(one)), None)
    if missing is not None:
        return still_open(
            f"no certificate of signs, and sums of squares need {PACKAGES[missing]}; {repair(missing)}",
            METHOD,
        )
    result = _refuted(statement, lowest_points(statement, signs))
    if result is not None:
        return result
    squares = by_squares(statement, signs)
    return None if squares is None else shown(squares, f"{METHOD}: sum of squares")


def is_algebraic(tree: Tree) -> bool:
    """Whether an expression is built from numbers and variables by arithmetic, roots, sines and cosines."""
    if tree[0] in LEAVES:
        return True
    return tree[0] in ARITHMETIC and all(is_algebraic(part) for part in tree[1:] if isinstance(part, tuple))


def counterexample(statement: Implies, points: Iterable[dict[str, Fraction]] | None = None) -> Failure | None:
    """A point that balls confirm, among those given or those that sampling finds, or None."""
    from lyapcheck.claims.procedures.search import candidates

    given = [hypothesis.comparison for hypothesis in statement.hypotheses]
    given += [bound_of(v) for v in statement.variables if v.low is not None]
    if points is None:
        points = candidates(statement.variables, statement.hypotheses, statement.conclusion)
    result = first_refutation(statement.conclusion.comparison, points, given)
    return None if result is None else rounder(result, given)


def sampled() -> dict[str, int]:
    """How counterexamples are searched, for the record."""
    from lyapcheck.claims.procedures.search import SAMPLES
    from lyapcheck.claims.procedures.search import SAMPLING_SEED as SEED

    return {"samples": SAMPLES, "seed": SEED}


def _refuted(statement: Implies, points: Iterable[dict[str, Fraction]] | None = None) -> SearchResult | None:
    result = counterexample(statement, points)
    if result is None:
        return None
    return broken(witness_of(result), f"{METHOD}: a point where it fails", witness_data(result), **sampled())


def bound_of(variable: Variable) -> Comparison:
    """The lower bound of a variable as a relation."""
    return ("num", str(variable.low)), "<" if variable.strict else "<=", ("var", variable.name)


# --- Relations for every small enough ε: a leading term of known sign, or a point at which they fail.
#
# See ``check.kinds.for_small`` for why these decide.

SMALL = "small parameter"
BELOW = (Fraction(1), Fraction(1, 2**10))


@procedure(ForSmall)
def find_for_small(statement: ForSmall) -> SearchResult:
    """Search an identity of signs for the leading term, then a point at which the relation fails."""
    proved = _leading(statement)
    if proved.is_proof:
        return proved
    method = f"{SMALL}: a point at which it fails for all small {statement.small}"
    unit = [Variable(name, Fraction(0)) for name in statement.bounded]
    for drawn in round_points([*statement.variables, *unit]):
        # variables that run over (0, 1] are 1 at most
        point = drawn | {name: min(drawn[name], Fraction(1)) for name in statement.bounded}
        if _breaks(statement, point):
            for below in BELOW:
                proof = SmallWitness(point_of(point), below)
                if refutes(statement, proof):
                    return broken(proof, method, _data(statement, point, below))
    return proved


def _leading(statement: ForSmall) -> SearchResult:
    """An identity of signs for the leading term."""
    try:
        signs = small_signs(statement)
        limit = leading_term(signs, statement)
    except Unsupported as problem:
        return still_open(f"{problem}; write the relation between polynomials", SMALL)
    if limit is None:
        return still_open("the leading term depends on a bounded variable; state the claim without it", SMALL)
    depth, nodes = EFFORT[-1]
    identity = Cancellation(signs, nodes).identity(limit, True, depth)
    if identity is not None:
        return shown(
            LeadingTerm(identity),
            f"{SMALL}: the leading term is positive by an identity with terms of known sign",
        )
    return still_open(
        "the leading term is not shown to be positive; add the hypothesis that makes it so", SMALL
    )


def _breaks(statement: ForSmall, point: Point) -> bool:
    """Whether the conclusion fails for all small ε and every hypothesis holds."""
    try:
        fails = not _holds(statement.conclusion, point)
        return fails and all(_holds(hypothesis, point) for hypothesis in statement.hypotheses)
    except (Refused, Unsupported, ZeroDivisionError):
        return False


def _holds(relation: Relation, point: Point) -> bool:
    sign = sign_for_small(at(point, relation.gap))
    return sign > 0 or (sign == 0 and not relation.strict)


def _data(statement: ForSmall, point: Point, below: Fraction) -> dict[str, object]:
    """The point, and both sides at one small value."""
    whole = point | {statement.small: below / 2**20}
    balls = {name: ball_of(value) for name, value in whole.items()}
    claim = statement.conclusion
    with ctx.workprec(BITS):
        left, right = (Enclosure.from_arb(ball(side, balls)) for side in (claim.left, claim.right))
    return failing(dict(sorted(whole.items())), left, claim.operator, right)
