"""Whether a comparison holds at a point, or fails there, in balls.

References: ``johansson2017arb``.
"""

from __future__ import annotations

from collections.abc import Mapping

from flint import arb

from lyapcheck.check.expressions.expression import Tree, ball

Comparison = tuple[Tree, str, Tree]
"""``left operator right`` with the operator ``<=``, ``<`` or ``=``."""


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
