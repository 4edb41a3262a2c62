"""Statements about every state of one arm under one controller, from a robot and a gain set."""

from __future__ import annotations

from typing import Any

from lyapcheck.check.kinds.damping import DampingBelow
from lyapcheck.check.kinds.decreasing import Decreasing
from lyapcheck.claims.case import lacking
from lyapcheck.claims.exact import exact_value
from lyapcheck.claims.expressions import expr


def decreasing(robot: Any, gains: Any, eps0: object, ranges: bool = False) -> Decreasing:
    """dV/dt < 0 along (11) at every state but the origin, with (13) for V and this ε₀.

    Args:
        robot: the arm, at its nominal numbers.
        gains: of a bounded family, N·m.
        eps0: an exact positive number.
        ranges: for all values of the arm's uncertain numbers instead.

    Raises:
        Lacking: the gains are for another number of joints, or h is unbounded.
        ValueError: ε₀ is no exact number.
    """
    from lyapcheck.check.kinds.decreasing import statement_of
    from lyapcheck.search.controlled_arm import ControlledArm

    if len(gains.kp) != robot.n:
        raise lacking(f"the gains are for {len(gains.kp)} joints, {robot.name} has {robot.n}")
    controlled = ControlledArm(gains, robot, ranges)
    if not controlled.family.bounded:
        raise lacking("h is unbounded; give gains of a bounded family")
    return statement_of(controlled.loop(exact_value(eps0)))


def damping_below(robot: Any, gains: Any, bound: object) -> DampingBelow:
    """A bound of λmax(K_v) is necessary: wherever some ε₀ > 0 gives dV/dt < 0 with K_p and κK_v, κ > 0.

    Args:
        robot: the arm, at its nominal numbers.
        gains: K_p, and K_v up to the factor κ; N·m.
        bound: a number, N·m.

    Raises:
        Lacking: the gains are for another number of joints, or h is unbounded.
    """
    return DampingBelow.about(decreasing(robot, gains, 1).closed_loop, bound=expr(bound).tree)
