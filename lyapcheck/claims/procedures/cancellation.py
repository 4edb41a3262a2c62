"""The search for identities of signs: negative terms of the conclusion are cancelled one after the other."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from fractions import Fraction

from flint import fmpq, fmpq_mpoly

from lyapcheck.check.kinds.signs import Exponents, Monomial, Multiple, SignIdentity, Signs


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
        return None if steps is None else _composed(steps)

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
            return
        e, c = bad
        for f, d in signs.hypotheses[k][0].to_dict().items():
            if c / d <= 0:
                continue
            lift = tuple(max(int(b) - int(a), 0) for a, b in zip(e, f, strict=True))
            over = tuple(max(int(a) - int(b), 0) for a, b in zip(e, f, strict=True))
            if signs.monomial_is(lift, True) and signs.monomial_is(over, False):
                yield CancelledTerm(k, c / d, over, lift)


def _composed(steps: list[CancelledTerm]) -> SignIdentity:
    """One identity from a chain of cancellations: later lifts multiply the hypothesis of a step."""
    multiples: list[Multiple] = []
    lift: Exponents = ()
    for step in reversed(steps):
        weight = Fraction(int(step.weight.p), int(step.weight.q))
        multiples.insert(0, Multiple(step.hypothesis, weight, _sparse(_times(step.over, lift))))
        lift = _times(step.lift, lift)
    return SignIdentity(_sparse(lift), tuple(multiples))


def _times(a: Exponents, b: Exponents) -> Exponents:
    return tuple(x + y for x, y in zip(a, b, strict=True)) if b else a


def _sparse(exponents: Exponents) -> Monomial:
    return tuple((i, e) for i, e in enumerate(exponents) if e)
