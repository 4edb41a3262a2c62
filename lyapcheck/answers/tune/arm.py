"""The limits of an arm before there are gains for it."""

from __future__ import annotations

from fractions import Fraction
from typing import TYPE_CHECKING

from lyapcheck.control.arm_limits import varied_limits
from lyapcheck.control.gains import Bounds, GainFile, GainSet
from lyapcheck.control.limits import Limits, limits_for

if TYPE_CHECKING:
    from lyapcheck.robots.vary import Vary


def arm_limits(robot: str, n: int, bounds: Bounds | None = None, varies: tuple[Vary, ...] = ()) -> Limits:
    """The limits that the gate would judge gains for this arm by.

    Args:
        robot: a built-in arm, or the path of an arm file.
        n: its number of joints.
        bounds: limits to take instead of the arm's.
        varies: ranges that the limits are to hold for.
    """
    ones = (Fraction(1),) * n
    arms = {robot: varied_limits(robot, varies)} if varies else None
    return limits_for(
        GainFile(robot, robot, (GainSet("limits", 1, ones, ones),), bounds or Bounds()), None, arms
    )
