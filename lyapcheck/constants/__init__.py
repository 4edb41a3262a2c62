"""Constants of an arm: the end that a posture shows, in balls, and the end that the checker accepts for all.

    λmin(M), λmax(M) = β_M,     k_g = sup ‖g(q)‖,     k_gi = sup |g_i(q)|,     k_c = sup ‖C(q,x)y‖ / (‖x‖‖y‖).

For few joints the end for all angles is shown by the sizes of harmonics, by boxes, or by storage forms along
the links where these show more; for more joints by such forms. k_c is reached with x = y.

References: properties 2.1, 2.2, 2.6 and 2.8 of reyes2019family.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace
from fractions import Fraction
from functools import lru_cache
from typing import Any

import numpy as np
from flint import arb

from lyapcheck._types import SEED, Array, Progress
from lyapcheck.asked import bound_of_constant, joints_of
from lyapcheck.check.kinds.chain import ChainAbove, ChainCoriolisBelow
from lyapcheck.check.kinds.coriolis import CoriolisBelow
from lyapcheck.check.kinds.inertia import Bisection, Bound, HarmonicSizes, MassAbove, PostureWitness
from lyapcheck.check.numbers.balls import precision, to_arb
from lyapcheck.check.numbers.polynomials import Enclosure, root_above
from lyapcheck.check.statement import Statement
from lyapcheck.constants.storage import BoundWithProof, storage_proof
from lyapcheck.errors import argument_error
from lyapcheck.lyapunov.scalar import RobotBounds
from lyapcheck.output.digits import decimals
from lyapcheck.robots.dynamics import FEW_JOINTS, Chain
from lyapcheck.robots.numeric import NumericModel
from lyapcheck.robots.plant import RobotModel

MAX_BOXES = 2000
"""How many boxes the checker's rule may cut for one bound."""
MARGINS = tuple(map(Fraction, ("1e-4", "1e-3", "0.02", "0.5")))
"""How far from what is reached a bound may be, relative to it; the smallest that is shown counts."""
MARGINS_OF_CORIOLIS = tuple(map(Fraction, ("0.005", "0.05")))
"""The same for k_c, from the norms that boxes can show, as its boxes cost more."""
SAMPLES = 4096
"""Postures at which these norms are taken."""
NEAR = Fraction(1, 10**4)
"""Where a bound is so near what is reached, relative to it, forms along the links are not asked."""
DIGITS_SHOWN = 6


@dataclass(frozen=True)
class ConstantResult:
    """One constant of an arm.

    Args:
        name: ``lambda_min``, ``lambda_max``, ``k_c``, ``k_g`` or ``k_g1`` and so on.
        unit: SI unit.
        enclosure: the end that a posture reaches, and the end for all angles.
        state: the posture, angles in rad; but for gravity followed by the components of x.
        shown: the bound for all angles and the proof that the checker has accepted, where there is one.
        boxes: the budget of the proof, where that is by boxes.
    """

    name: str
    unit: str
    enclosure: Enclosure
    state: tuple[float, ...]
    shown: BoundWithProof | None = None
    boxes: int = 0

    @property
    def gap(self) -> float:
        """Width of the enclosure relative to its larger end."""
        size = max(abs(self.enclosure.lower), abs(self.enclosure.upper))
        return float(self.enclosure.width / size) if size else 0.0


def arm_constants(
    model: RobotModel,
    max_boxes: int = MAX_BOXES,
    on_progress: Progress | None = None,
    names: Sequence[str] | None = None,
) -> tuple[ConstantResult, ...]:
    """λmin(M), λmax(M), k_c, k_g and every k_gi of an arm whose parameters stand at their nominal values.

    Args:
        model: the arm, of any number of joints.
        max_boxes: how many boxes a bound may take.
        names: of the constants wanted; by default all.

    Soundness: the inside end is taken in balls at a posture; the outside end is what the checker accepts. Of
        λmin(M) without a proof it is −‖M‖, by the sizes of harmonics.
    """
    fixed = model.fixed()
    every = ("lambda_min", "lambda_max", "k_c", "k_g", *(f"k_g{i + 1}" for i in range(model.n)))
    wanted = [name for name in every if names is None or name in names]
    result = []
    for step, name in enumerate(wanted):

        def progress(fraction: float, note: str, step: int = step, name: str = name) -> None:
            if on_progress is not None:
                on_progress((step + fraction) / len(wanted), f"{name}: {note}")

        result.append(_constant(fixed, name, max_boxes, progress))
    return tuple(result)


# --- The constants that certificates of stability need, once an arm.


_NEEDED = ("lambda_min", "lambda_max", "k_c")


@dataclass(frozen=True)
class RobotConstants:
    """Enclosures of an arm's constants at its nominal parameters, kg·m², with the angles that show them."""

    lambda_min: Enclosure
    lambda_max: Enclosure
    k_c: Enclosure
    lambda_min_at: tuple[float, ...]
    lambda_max_at: tuple[float, ...]


def robot_bounds(model: RobotModel) -> RobotBounds:
    """The outside bounds that the scalar forms need; see ``robot_constants``."""
    result = robot_constants(model)
    viscous = [number.value for number in model.viscous]
    return RobotBounds(result.lambda_max.upper, result.k_c.upper, min(viscous), max(viscous))


@lru_cache(maxsize=64)
def robot_constants(model: RobotModel, max_boxes: int = MAX_BOXES) -> RobotConstants:
    """Enclose λmin(M), λmax(M) = β_M and k_c of an arm at its nominal parameters.

    Args:
        model: the arm, of any number of joints.
        max_boxes: how many boxes a bound may take.

    Soundness: see `lyapcheck.constants.arm_constants`.
    """
    smallest, largest, coriolis = arm_constants(model, max_boxes, names=_NEEDED)
    return RobotConstants(
        lambda_min=smallest.enclosure,
        lambda_max=largest.enclosure,
        k_c=coriolis.enclosure,
        lambda_min_at=smallest.state,
        lambda_max_at=largest.state,
    )


# --- The posture at which a constant is reached, as local searches find it; its value in balls.


STARTS = 24
STEPS = 300
DIGITS = 10**7
BITS = 128


def extreme(plant: RobotModel, name: str) -> tuple[PostureWitness, Fraction]:
    """Where λmin(M), λmax(M), k_c, k_g or a k_gi of an arm is reached, and its value, rounded safely.

    By quasi-Newton steps from many starts; there is no direction x for gravity.

    Soundness: the value is taken in balls at the rational posture; that it is the extreme one is not.
    """
    from scipy.optimize import minimize

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
    return at, _in_balls(_state(plant, name, isinstance(plant.dynamics, Chain))(Fraction(0)), at)


def _merit(plant: RobotModel, name: str) -> Callable[..., tuple[float, Array]]:
    """What is to be small at (q, x), by a size, and its slopes."""
    import casadi as ca

    from lyapcheck.lyapunov import graph

    n = plant.n
    z = ca.SX.sym("z", 2 * n)
    q, x = z[:n], z[n:]
    at, square, sign = graph.at_angles(plant, q), ca.dot(x, x), -1 if name == "lambda_min" else 1
    if name in ("lambda_min", "lambda_max"):
        value = ca.dot(x, graph.matrix(at.mass()) @ x) / square
    elif name == "k_c":
        turned = graph.matrix(at.coriolis(ca.vertsplit(x))) @ x
        value = ca.dot(turned, turned) / square**2
    else:
        torque = at.gravity()
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
        excess = statement.excess(witness_of(statement, at))
        square = sum((to_arb(x) ** 2 for x in at.x), arb(int(not at.x)))
        if isinstance(statement, MassAbove | ChainAbove):
            return Enclosure.from_arb(-excess / square).upper
        size = excess / (square**2 if isinstance(statement, CoriolisBelow | ChainCoriolisBelow) else square)
        return Enclosure.from_arb(size.lower().max(arb(0)).sqrt()).lower


def witness_of(statement: Statement, at: PostureWitness) -> PostureWitness:
    """The posture as a witness against a bound; of C as a bilinear map with x = y."""
    return replace(at, y=at.x) if isinstance(statement, CoriolisBelow) else at


def _short(values: Array) -> tuple[Fraction, ...]:
    return tuple(Fraction(round(float(x) * DIGITS), DIGITS) for x in values)


def _state(arm: RobotModel, name: str, along_links: bool) -> Callable[[Fraction], Any]:
    """A bound of a constant as a statement, by its number."""
    return lambda end: bound_of_constant(name, arm, end, along_links)


# --- The end for all angles: what the checker's own bounds show, or forms along the links.


def _constant(arm: RobotModel, name: str, max_boxes: int, on_progress: Progress) -> ConstantResult:
    """A constant of an arm without uncertain parameters."""
    on_progress(0.0, "posture")
    at, inner = extreme(arm, name)
    if arm.n > FEW_JOINTS and arm.chain is not None:
        on_progress(0.1, "forms along the links")
        still = name.startswith("k_g") and inner == 0
        shown = storage_proof(arm.chain, name, still=True) if still else None
        shown = shown or storage_proof(arm.chain, name)
        if shown is None and name != "lambda_min":
            rule = "has no bound along the links that the checker accepts"
            raise argument_error(name, "", rule, "correct the masses and inertias")
        # bodies without mass may leave nothing to show, but that M(q) of links is never negative
        outer = Fraction(0)
    else:
        on_progress(0.1, "boxes")
        shown, outer = _by_sizes_and_boxes(arm, name, inner, max_boxes)
    low, high = sorted((inner, shown.bound if shown else outer))
    boxes = max_boxes if shown and isinstance(shown.proof, Bisection) else 0
    unit = "N·m" if name.startswith("k_g") else "kg·m²"
    return ConstantResult(name, unit, Enclosure(low, high), tuple(map(float, (*at.q, *at.x))), shown, boxes)


def _by_sizes_and_boxes(
    arm: RobotModel, name: str, inner: Fraction, max_boxes: int
) -> tuple[BoundWithProof | None, Fraction]:
    """The best bound that is shown, and one that the sizes of harmonics give without a proof."""
    state, sign = _state(arm, name, along_links=False), -1 if name == "lambda_min" else 1
    best: BoundWithProof | None = None
    zero = state(Fraction(0))
    if isinstance(zero, MassAbove):
        coarse = -zero.inertia.largest_row
    else:
        coarse = root_above(zero.square_by_sizes())
        value = rounded(coarse, sign)
        best = BoundWithProof(state(value), HarmonicSizes())
    # forms along the links take less time than the boxes that they spare
    if arm.chain is not None and (best is None or best.bound > inner * (1 + NEAR)):
        found = storage_proof(arm.chain, name)
        if found is not None and (best is None or sign * found.bound < sign * best.bound):
            best = found
    if arm.n > FEW_JOINTS:  # M(q) as a source prints it: its boxes would take minutes
        return best, coarse
    start, margins = (_unfolded(arm), MARGINS_OF_CORIOLIS) if name == "k_c" else (inner, MARGINS)
    for margin in margins:
        value = rounded(start * (1 + sign * margin), sign)
        if value <= 0 or (best is not None and sign * best.bound <= sign * value):
            break
        statement = state(value)
        if statement.shown_by_boxes(max_boxes):
            return BoundWithProof(statement, Bisection()), coarse
    return best, coarse


def _unfolded(arm: RobotModel) -> Fraction:
    """About the least bound of ‖C(q, x)y‖ that boxes can show: that of the better unfolding of the c_ijk."""
    states = np.random.default_rng(SEED).uniform(-np.pi, np.pi, (SAMPLES, arm.n))
    c = NumericModel(arm).christoffel(states)
    both = (np.einsum("bijk,bijl->bkl", c, c), np.einsum("bijk,bljk->bil", c, c))
    tops = [np.linalg.eigvalsh(square)[:, -1] for square in both]
    return Fraction(float(np.sqrt(max(np.max(np.minimum(*tops)), 0.0))))


def rounded(value: Fraction, sign: int) -> Fraction:
    """The nearest decimal number of a few digits that is not below (sign > 0), or not above."""
    return Fraction(decimals(Enclosure.exact(value), DIGITS_SHOWN)[1 if sign > 0 else 0])


__all__ = ["SEED", "ConstantResult", "RobotConstants", "arm_constants", "robot_bounds", "robot_constants"]
