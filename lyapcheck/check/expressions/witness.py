"""Replaying a counterexample: at an exact point the hypotheses hold, the conclusion fails, in balls.

References: ``johansson2017arb``.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from fractions import Fraction

from flint import arb, ctx

from lyapcheck.check.expressions.expression import Tree, ball
from lyapcheck.check.numbers.enclosure import Enclosure, ball_of

Comparison = tuple[Tree, str, Tree]
"""``left operator right`` with the operator ``<=``, ``<`` or ``=``."""


@dataclass(frozen=True)
class Sides:
    """Both sides of a comparison that fails, enclosed."""

    left: Enclosure
    right: Enclosure


def holds(comparison: Comparison, point: Mapping[str, arb]) -> bool | None:
    """Whether a comparison holds at a point; ``None`` where the balls do not decide it."""
    left, operator, right = comparison
    return sign_holds(ball(right, point) - ball(left, point), operator)


def sign_holds(gap: arb, operator: str) -> bool | None:
    """Whether a comparison holds whose sides differ by a gap; ``None`` where its ball does not decide it."""
    if operator == "=":
        return False if gap > 0 or gap < 0 else True if gap.is_zero() else None
    strict = operator == "<"
    if gap > 0 or (not strict and gap >= 0):
        return True
    return False if gap < 0 or (strict and gap <= 0) else None


def refutation(
    conclusion: Comparison,
    point: Mapping[str, Fraction],
    hypotheses: tuple[Comparison, ...] = (),
    bits: int = 192,
) -> Sides | None:
    """Both sides of the conclusion, if the point provably meets the hypotheses and breaks it."""
    with ctx.workprec(bits):
        balls = {name: ball_of(value) for name, value in point.items()}
        if any(holds(hypothesis, balls) is not True for hypothesis in hypotheses):
            return None
        if holds(conclusion, balls) is not False:
            return None
        left, right = ball(conclusion[0], balls), ball(conclusion[2], balls)
        return Sides(Enclosure.from_arb(left), Enclosure.from_arb(right))
