"""Constants of any arm enclosed from both sides in floating point, wider where the budget of boxes ends.

    λmin(M), λmax(M) = β_M,     k_g = sup ‖g(q)‖,     k_gi = sup |g_i(q)|,     k_c = sup ‖C(q,x)y‖ / (‖x‖‖y‖).

Over a box each of these is bounded at the corners of a linear part, because eigenvalues and norms are convex
functions of the entries (λmin is concave); near an extremum that leaves an error of second order. For more
than three joints bounds along the chain of links take their place.

References: properties 2.1, 2.2, 2.6 and 2.8 of reyes2019family.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from functools import lru_cache

from lyapcheck._types import Progress
from lyapcheck.check.numbers.polynomials import Enclosure
from lyapcheck.constants.chain import chain_constant
from lyapcheck.constants.constant import ConstantResult, SupremumTask, from_distances
from lyapcheck.constants.coriolis import coriolis_task
from lyapcheck.constants.spectrum import ArmHarmonics, gravity_task, lambda_max_task, lambda_min_task
from lyapcheck.lyapunov.scalar import RobotBounds
from lyapcheck.robots.dynamics import FEW_JOINTS
from lyapcheck.robots.plant import Plant

GAP = 1e-3
GAP_OF_MANY = 2e-2
MAX_BOXES = 60_000


def arm_constants(
    model: Plant,
    max_boxes: int = MAX_BOXES,
    on_progress: Progress | None = None,
    names: Sequence[str] | None = None,
) -> tuple[ConstantResult, ...]:
    """λmin(M), λmax(M), k_c, k_g and every k_gi of an arm whose parameters stand at their nominal values.

    Args:
        model: the arm, of any number of joints.
        max_boxes: how many boxes each constant may take; k_c of n joints, whose boxes cost more, an nth of
            that.
        names: of the constants wanted; by default all.

    Returns:
        The constants; where the budget did not suffice their enclosures are wider than ``GAP``.

    Soundness: floating point with residuals and bounds of its error beforehand, see
        `lyapcheck.constants.torus` and `lyapcheck.constants.spectrum`; along the chain rational arithmetic
        and balls, see `lyapcheck.constants.storage`; the inside ends are bounds at the state given.
    """
    fixed, makers = model.fixed(), _makers(model.n)
    along = model.n > FEW_JOINTS and fixed.chain is not None
    arm = None if along else ArmHarmonics(fixed)
    enough = GAP if model.n <= FEW_JOINTS else GAP_OF_MANY
    wanted = [name for name in makers if names is None or name in names]
    result = []
    for step, name in enumerate(wanted):

        def progress(fraction: float, note: str, step: int = step, name: str = name) -> None:
            if on_progress is not None:
                on_progress((step + fraction) / len(wanted), f"{name}: {note}")

        if arm is None:
            result.append(chain_constant(fixed, name, progress))
        else:
            progress(0.0, "sampling")
            result.append(makers[name](arm).solve(max_boxes, enough, progress, from_distances(fixed, name)))
    return tuple(result)


def _makers(n: int) -> dict[str, Callable[[ArmHarmonics], SupremumTask]]:
    """How each constant becomes a task, in the order in which they are reported."""

    def component(i: int) -> Callable[[ArmHarmonics], SupremumTask]:
        return lambda arm: gravity_task(arm, f"k_g{i + 1}", [i])

    makers: dict[str, Callable[[ArmHarmonics], SupremumTask]] = {
        "lambda_min": lambda_min_task,
        "lambda_max": lambda_max_task,
        "k_c": coriolis_task,
        "k_g": lambda arm: gravity_task(arm, "k_g", range(arm.n)),
    }
    return makers | {f"k_g{i + 1}": component(i) for i in range(n)}


# --- The constants that certificates of stability need, once an arm.


BOUNDS_MAX_BOXES = 40_000
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
    """Enclose λmin(M), λmax(M) = β_M and k_c of an arm at its nominal parameters.

    Args:
        model: the arm, of any number of joints.
        max_boxes: budget of each constant; by default fewer for more joints, whose boxes cost more.

    Returns:
        The enclosures. They are wide if the number of boxes did not suffice.

    Soundness: see `lyapcheck.constants.arm_constants`.
    """
    budget = BOUNDS_MAX_BOXES // model.n**2 if max_boxes is None else max_boxes
    smallest, largest, coriolis = arm_constants(model, budget, names=_NEEDED)
    return RobotConstants(
        lambda_min=smallest.enclosure,
        lambda_max=largest.enclosure,
        k_c=coriolis.enclosure,
        lambda_min_at=smallest.state,
        lambda_max_at=largest.state,
    )
