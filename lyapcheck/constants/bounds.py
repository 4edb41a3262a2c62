"""The constants that certificates of stability need, once an arm."""

from __future__ import annotations

from dataclasses import dataclass
from functools import lru_cache

from lyapcheck.check.numbers.enclosure import Enclosure
from lyapcheck.constants.arm import arm_constants
from lyapcheck.lyapunov.scalar import RobotBounds
from lyapcheck.robots.plant import Plant

MAX_BOXES = 40_000
"""Over the square of the number of joints: the budget that takes a second or so."""
_NEEDED = ("lambda_min", "lambda_max", "k_c")


@dataclass(frozen=True)
class RobotConstants:
    """Enclosures of an arm's constants at its nominal parameters, kg·m², with the angles that show them."""

    lambda_min: Enclosure
    lambda_max: Enclosure
    k_c: Enclosure
    lambda_min_at: tuple[float, ...]
    lambda_max_at: tuple[float, ...]


def robot_bounds(model: Plant, max_boxes: int | None = None) -> RobotBounds:
    """The outside bounds that the scalar forms need; see ``robot_constants``."""
    result = robot_constants(model, max_boxes)
    viscous = [number.value for number in model.viscous]
    return RobotBounds(
        result.lambda_max.upper, result.k_c.upper, min(viscous), max(viscous), result.lambda_min.lower
    )


@lru_cache(maxsize=64)
def robot_constants(model: Plant, max_boxes: int | None = None) -> RobotConstants:
    """λmin(M), λmax(M) = β_M and k_c, enclosed, of an arm whose parameters stand at their nominal values.

    Args:
        model: the arm, of any number of joints.
        max_boxes: budget of each constant; by default fewer for more joints, whose boxes cost more.

    Returns:
        The enclosures; where the budget did not suffice they are wide.

    Soundness: see `lyapcheck.constants.arm_constants`.
    """
    budget = MAX_BOXES // model.n**2 if max_boxes is None else max_boxes
    smallest, largest, coriolis = arm_constants(model, budget, names=_NEEDED)
    return RobotConstants(
        lambda_min=smallest.enclosure,
        lambda_max=largest.enclosure,
        k_c=coriolis.enclosure,
        lambda_min_at=smallest.state,
        lambda_max_at=largest.state,
    )
