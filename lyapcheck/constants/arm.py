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
from fractions import Fraction
from functools import lru_cache
from typing import Any

import numpy as np
from flint import arb

from lyapcheck._types import SEED, Array, Progress, silent
from lyapcheck.check.kinds.chain import ChainAbove, ChainCoriolisBelow
from lyapcheck.check.kinds.inertia import PostureWitness
from lyapcheck.check.numbers.balls import precision, to_arb
from lyapcheck.check.numbers.polynomials import Enclosure
from lyapcheck.constants.constant import ConstantResult, SupremumTask
from lyapcheck.constants.spectrum import (
    ArmHarmonics,
    coriolis_task,
    gravity_task,
    lambda_max_task,
    lambda_min_task,
)
from lyapcheck.constants.storage import Bound, joints_of, storage_proof, zero_bound
from lyapcheck.errors import argument_error
from lyapcheck.lyapunov.scalar import RobotBounds
from lyapcheck.robots.dynamics import FEW_JOINTS, Chain
from lyapcheck.robots.plant import RobotModel

GAP = 1e-3
GAP_OF_MANY = 2e-2
MAX_BOXES = 60_000


def arm_constants(
    model: RobotModel,
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
        `lyapcheck.constants.constant` and `lyapcheck.constants.spectrum`; along the chain rational arithmetic
        and balls, see `lyapcheck.constants.storage`; the inside ends are bounds at the state given.
    """
    fixed = model.fixed()
    along = model.n > FEW_JOINTS and fixed.chain is not None
    arm = None if along else ArmHarmonics(fixed)
    enough = GAP if model.n <= FEW_JOINTS else GAP_OF_MANY
    every = ("lambda_min", "lambda_max", "k_c", "k_g", *(f"k_g{i + 1}" for i in range(model.n)))
    wanted = [name for name in every if names is None or name in names]
    result = []
    for step, name in enumerate(wanted):

        def progress(fraction: float, note: str, step: int = step, name: str = name) -> None:
            if on_progress is not None:
                on_progress((step + fraction) / len(wanted), f"{name}: {note}")

        if arm is None:
            result.append(chain_constant(fixed, name, progress))
        else:
            progress(0.0, "sampling")
            result.append(_task(arm, name).solve(max_boxes, enough, progress))
    return tuple(result)


def _task(arm: ArmHarmonics, name: str) -> SupremumTask:
    tasks = {"lambda_min": lambda_min_task, "lambda_max": lambda_max_task, "k_c": coriolis_task}
    return tasks[name](arm) if name in tasks else gravity_task(arm, name, joints_of(name, arm.n))


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


def robot_bounds(model: RobotModel, max_boxes: int | None = None) -> RobotBounds:
    """The outside bounds that the scalar forms need; see ``robot_constants``."""
    result = robot_constants(model, max_boxes)
    viscous = [number.value for number in model.viscous]
    return RobotBounds(
        result.lambda_max.upper, result.k_c.upper, min(viscous), max(viscous), result.lambda_min.lower
    )


@lru_cache(maxsize=64)
def robot_constants(model: RobotModel, max_boxes: int | None = None) -> RobotConstants:
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


# --- The posture at which a constant of a chain is reached, as local searches find it; its value in balls.


STARTS = 24
STEPS = 300
DIGITS = 10**7
BITS = 128


def extreme(plant: RobotModel, name: str) -> tuple[PostureWitness, Fraction]:
    """Where λmin(M), λmax(M), k_c, k_g or a k_gi of a chain is reached, and its value, rounded safely.

    By quasi-Newton steps from many starts; there is no direction x for gravity.

    Soundness: the value is taken in balls at the rational posture; that it is the extreme one is not.
    """
    from scipy.optimize import minimize

    chain = plant.dynamics
    assert isinstance(chain, Chain)
    n, directed, merit = plant.n, not name.startswith("k_g"), _merit(plant, name)
    rng = np.random.default_rng(SEED)
    turns = rng.uniform(-np.pi, np.pi, (STARTS, n))
    starts = np.hstack([turns * (np.arange(STARTS) > 0)[:, None], rng.normal(size=(STARTS, n))])
    best = max(starts, key=lambda start: abs(merit(start)[0]))
    for start in [*starts, None]:
        # steps end at slopes below 1e-5: relative to what was found, or all of them are for an arm of 0.1 kg
        size = abs(merit(best)[0]) or 1.0
        begin = best if start is None else start
        found = minimize(merit, begin, args=(size,), jac=True, options={"maxiter": STEPS}).x
        best = min(best, found, key=lambda point: merit(point)[0])
    q = best[:n] - 2 * np.pi * np.round(best[:n] / (2 * np.pi))
    x = best[n:] / np.linalg.norm(best[n:])
    at = PostureWitness(_short(q), (), _short(x) if directed else ())
    return at, _in_balls(zero_bound(chain, name), at)


def _merit(plant: RobotModel, name: str) -> Callable[..., tuple[float, Array]]:
    """What is to be small at (q, x), by a size, and its slopes."""
    import casadi as ca

    from lyapcheck.lyapunov import graph

    n = plant.n
    z = ca.SX.sym("z", 2 * n)
    q, x = z[:n], z[n:]
    square, sign = ca.dot(x, x), -1 if name == "lambda_min" else 1
    if name in ("lambda_min", "lambda_max"):
        value = ca.dot(x, graph.mass(plant, q) @ x) / square
    elif name == "k_c":
        turned = graph.coriolis(plant, q, x) @ x
        value = ca.dot(turned, turned) / square**2
    else:
        torque = graph.gravity(plant, q)
        counted = ca.vertcat(*(torque[i] for i in joints_of(name, n)))
        value = ca.dot(counted, counted)
    aim = -sign * value
    function = ca.Function("merit", [z], [aim, ca.densify(ca.gradient(aim, z))])

    def merit(point: Array, size: float = 1.0) -> tuple[float, Array]:
        result: Any = function(point)
        return float(result[0]) / size, np.array(result[1])[:, 0] / size

    return merit


def _in_balls(statement: Bound, at: PostureWitness) -> Fraction:
    """The constant there, on the safe side, from how far a bound of 0 fails."""
    with precision(BITS):
        excess, square = statement.excess(at), sum((to_arb(x) ** 2 for x in at.x), arb(int(not at.x)))
        if isinstance(statement, ChainAbove):
            return Enclosure.from_arb(-excess / square).upper
        size = excess / (square**2 if isinstance(statement, ChainCoriolisBelow) else square)
        return Enclosure.from_arb(size.lower().max(arb(0)).sqrt()).lower


def _short(values: Array) -> tuple[Fraction, ...]:
    return tuple(Fraction(round(float(x) * DIGITS), DIGITS) for x in values)


def chain_constant(plant: RobotModel, name: str, on_progress: Progress = silent) -> ConstantResult:
    """λmin(M), λmax(M), k_c, k_g or a k_gi of a chain of exact links.

    Soundness: the inside end is taken in balls at a posture; the outside end is what the checker accepts.
    """
    on_progress(0.0, "posture")
    (at, inner), chain = extreme(plant, name), plant.chain
    assert chain is not None
    still = name.startswith("k_g") and inner == 0
    shown = storage_proof(chain, name, still=True) if still else None
    if shown is None:
        on_progress(0.1, "forms along the links")
        shown = storage_proof(chain, name)
    if shown is None and name != "lambda_min":
        rule = "has no bound along the links that the checker accepts"
        raise argument_error(name, "", rule, "correct the masses and inertias")
    # bodies without mass may leave nothing to show, but that M(q) of links is never negative
    low, high = sorted((inner, shown.bound if shown else Fraction(0)))
    unit = "N·m" if name.startswith("k_g") else "kg·m²"
    return ConstantResult(name, unit, Enclosure(low, high), tuple(map(float, (*at.q, *at.x))), 0, shown)
