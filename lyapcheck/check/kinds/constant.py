"""Relations between numbers: exactly where the difference is rational, else by balls that do not touch."""

from __future__ import annotations

from dataclasses import dataclass

from flint import arb, ctx

from lyapcheck.check.expressions.domain import Domain
from lyapcheck.check.expressions.expression import Tree, ball
from lyapcheck.check.expressions.normal_form import rational_value
from lyapcheck.check.expressions.witness import sign_holds
from lyapcheck.check.kinds.parts import relation_text, require_relations, terms_of
from lyapcheck.check.refusal import Refused
from lyapcheck.check.replay import require_bits
from lyapcheck.check.statement import OfTerms, Proof, Relation
from lyapcheck.check.verify import Accepted, rule

MOST_BALLS = 256
_BALLS: dict[tuple[int, int], tuple[Tree, arb]] = {}


@dataclass(frozen=True)
class Constant(OfTerms):
    """A relation between numbers."""

    relation: Relation

    def require_well_formed(self) -> None:
        """Refuse what the rules should not have to look at."""
        require_relations([self.relation], [])

    def terms(self) -> list[tuple[Tree, Domain]]:
        """Both sides."""
        return terms_of([self.relation], {})

    def text(self) -> str:
        """The statement in one line."""
        return relation_text(self.relation)


@dataclass(frozen=True)
class ExactNumbers(Proof):
    """The difference of both sides is rational, or its normal form is zero."""

    rule = "exact numbers"


@dataclass(frozen=True)
class SeparateBalls(Proof):
    """Both sides lie in balls of ``bits`` that tell them apart."""

    rule = "separate balls"
    bits: int


@rule(Constant, ExactNumbers)
def by_exact_numbers(statement: Constant, proof: ExactNumbers) -> Accepted:
    """Soundness: the sign of one rational number."""
    truth = exact_truth(statement.relation)
    if truth is None:
        raise Refused("difference", "", "of both sides is not rational")
    return _with_values(statement, truth, "exact")


@rule(Constant, SeparateBalls)
def by_separate_balls(statement: Constant, proof: SeparateBalls) -> Accepted:
    """Soundness: the ball of the difference does not touch 0."""
    relation = statement.relation
    with ctx.workprec(require_bits(proof.bits)):
        truth = sign_holds(_ball(relation.right) - _ball(relation.left), relation.operator)
    if truth is None:
        raise Refused("bits", proof.bits, "are too few to tell both sides apart")
    return _with_values(statement, truth, "enclosure")


def _ball(tree: Tree) -> arb:
    """A ball for a side; that of an operation is kept, since one limit is compared with many numbers.

    A statement is immutable once it is well-formed, and kept with its ball, so that its id stays its own.
    """
    if len(tree) <= 2:
        return ball(tree)
    key = id(tree), ctx.prec
    if key not in _BALLS:
        if len(_BALLS) >= MOST_BALLS:
            _BALLS.clear()
        _BALLS[key] = tree, ball(tree)
    return _BALLS[key][1]


def _with_values(statement: Constant, truth: bool, grade: str) -> Accepted:
    """The verdict, if both sides have values: a refutation needs them as much as a proof."""
    statement.require_defined()
    return Accepted("proved" if truth else "refuted", grade)


def exact_truth(relation: Relation) -> bool | None:
    """The truth of a relation between numbers whose difference is rational, else ``None``."""
    gap = rational_value(relation.gap)
    return None if gap is None else bool(gap > 0 or (gap == 0 and not relation.strict))
