"""The limits of an arm before there are gains for it."""

from __future__ import annotations

from fractions import Fraction

from lyapcheck.control.gains import Bounds, GainFile, GainSet
from lyapcheck.control.limits import Limits, limits_for


def arm_limits(robot: str, n: int, bounds: Bounds | None = None) -> Limits:
    """The limits that the gate would judge gains for this arm by.

    Args:
        robot: a built-in arm, or the path of an arm file.
        n: its number of joints.
        bounds: limits to take instead of the arm's.
    """
    ones = (Fraction(1),) * n
    return limits_for(GainFile(robot, robot, (GainSet("limits", 1, ones, ones),), bounds or Bounds()))
