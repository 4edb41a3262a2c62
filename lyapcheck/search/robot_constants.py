"""Certified constants of an arm: λmin(M), λmax(M) = β_M and k_c, each from both sides.

The inside bound is the value at a state found by sampling; the outside bound is proved by covering all angles
(and, for k_c, all directions) with boxes on which an interval matrix is positive definite:

    β I − M(q) ≻ 0,      M(q) − λ I ≻ 0,      κ² ‖x‖² I − C(q,x)ᵀ C(q,x) ≻ 0.

C(q,x) is linear in x, so that x need only run over the faces x_k = 1 of the cube, k = 1 … n.

References: properties 2.1, 2.2 and 2.6 of reyes2019family.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from fractions import Fraction
from functools import lru_cache

import numpy as np
from numpy.typing import NDArray

from lyapcheck.check.enclosure import Enclosure
from lyapcheck.intervals import Interval
from lyapcheck.intervals.arm import ArmIntervals, coriolis
from lyapcheck.intervals.definite import positive_definite
from lyapcheck.lyapunov.scalar import RobotBounds
from lyapcheck.robots import RobotModel
from lyapcheck.robots.numeric import NumericModel
from lyapcheck.search.cover import Boxes, cover

Entries = list[list[Interval | float]]

Array = NDArray[np.float64]

PI_ABOVE = 3.1415926535897936
GAPS = tuple(Fraction(n, 1000) for n in (1, 10, 30, 100, 1000))
"""Relative gaps between the found and the proved bound that are tried, best first."""
MAX_BOXES = 150_000
SAMPLES = 4096
SEED = 20190301


@dataclass(frozen=True)
class RobotConstants:
    """Enclosures of an arm's constants at its nominal parameters, kg·m², with the states that show them."""

    lambda_min: Enclosure
    lambda_max: Enclosure
    k_c: Enclosure
    lambda_min_at: tuple[float, ...]
    lambda_max_at: tuple[float, ...]
    k_c_at: tuple[float, ...]


def robot_bounds(model: RobotModel) -> RobotBounds:
    """The outside bounds that the scalar forms need; see ``robot_constants``."""
    found = robot_constants(model)
    viscous = [number.value for number in model.viscous]
    return RobotBounds(
        found.lambda_max.upper, found.k_c.upper, min(viscous), max(viscous), found.lambda_min.lower
    )


@lru_cache(maxsize=64)
def robot_constants(model: RobotModel) -> RobotConstants:
    """Certified constants of an arm whose uncertain parameters stand at their nominal values.

    Raises:
        ArithmeticError: not even a gap of 100 % could be proved (the arm is far beyond n = 3).

    Soundness: outward-rounded intervals and ``lyapcheck.search.cover``; the inside bounds are evaluated in
        the same intervals, at one point.
    """
    arm = ArmIntervals(model.fixed())
    numeric = NumericModel(model)
    largest = _climb(model.n, len(arm.angles), lambda x: _top(numeric.mass(_angles(arm, x))))
    smallest = _climb(model.n, len(arm.angles), lambda x: -_bottom(numeric.mass(_angles(arm, x))))
    whirl = _climb(model.n, len(arm.angles) + model.n, lambda x: _whirl(numeric, arm, x))
    return RobotConstants(
        lambda_min=_lambda_min(arm, smallest),
        lambda_max=_lambda_max(arm, largest),
        k_c=_k_c(arm, numeric, whirl),
        lambda_min_at=tuple(float(x) for x in _angles(arm, smallest[None])[0]),
        lambda_max_at=tuple(float(x) for x in _angles(arm, largest[None])[0]),
        k_c_at=tuple(float(x) for x in _angles(arm, whirl[None])[0]),
    )


def _lambda_max(arm: ArmIntervals, at: Array) -> Enclosure:
    inside = _rational(_top(NumericModel(arm.model).mass(_angles(arm, at[None])))[0], Fraction(-1, 10**9))
    for gap in GAPS:
        bound = inside * (1 + gap)
        if _proved(arm, _shifted(bound, -1)):
            return Enclosure(inside, bound)
    raise ArithmeticError(_HOPELESS)


def _lambda_min(arm: ArmIntervals, at: Array) -> Enclosure:
    inside = _rational(_bottom(NumericModel(arm.model).mass(_angles(arm, at[None])))[0], Fraction(1, 10**9))
    for gap in GAPS[:-1]:
        bound = inside * (1 - gap)
        if _proved(arm, _shifted(bound, 1)):
            return Enclosure(bound, inside)
    return Enclosure(Fraction(0), inside)


_HOPELESS = "no bound of the arm's constants was proved within the budget of boxes"


def _shifted(s: Fraction, sign: int) -> Callable[[Entries], list[list[Interval]]]:
    """The map from M to ±(M − s I)."""

    def matrix(M: Entries) -> list[list[Interval]]:
        joints = range(len(M))
        return [[_shift(M, i, j, s, sign) for j in joints] for i in joints]

    return matrix


def _shift(M: list[list[Interval | float]], i: int, j: int, s: Fraction, sign: int) -> Interval:
    """The entry of ±(M − s I)."""
    entry = M[i][j] * float(sign)
    moved = entry - Interval.of(sign * s) if i == j else entry
    return moved if isinstance(moved, Interval) else Interval.exact(moved)


def _proved(arm: ArmIntervals, matrix: Callable[[Entries], list[list[Interval]]]) -> bool:
    """Whether a matrix made of M is positive definite for all angles."""
    columns = max(len(arm.angles), 1)
    start = np.stack([np.full(columns, -PI_ABOVE), np.full(columns, PI_ABOVE)])[None]

    def prove(boxes: Boxes) -> NDArray[np.bool_]:
        M = arm.at(_boxes(arm, boxes)).mass()
        return np.broadcast_to(positive_definite(matrix(M)), (len(boxes),))

    return cover(start, prove, _longest, MAX_BOXES).proved


def _k_c(arm: ArmIntervals, numeric: NumericModel, at: Array) -> Enclosure:
    if not arm.christoffel:
        return Enclosure.exact(0)
    inside = _rational(_whirl(numeric, arm, at[None])[0], Fraction(-1, 10**9))
    for gap in GAPS:
        if all(_face_proved(arm, k, inside * (1 + gap)) for k in range(arm.n)):
            return Enclosure(inside, inside * (1 + gap))
    raise ArithmeticError(_HOPELESS)


def _face_proved(arm: ArmIntervals, face: int, bound: Fraction) -> bool:
    """Whether ‖C(q,x)‖ < κ‖x‖ for all angles and all x with x_face = 1 and the others in [−1, 1]."""
    first, n = len(arm.angles), arm.n
    low = np.array([-PI_ABOVE] * first + [-1.0] * (n - 1))
    start = np.stack([low, -low])[None]

    def prove(boxes: Boxes) -> NDArray[np.bool_]:
        others = [Interval(boxes[:, 0, first + i], boxes[:, 1, first + i]) for i in range(n - 1)]
        x = [*others[:face], Interval.exact(1.0), *others[face:]]
        C = coriolis(arm.at(_boxes(arm, boxes)).symbols(), x)
        return np.broadcast_to(positive_definite(_gap(C, x, bound)), (len(boxes),))

    return cover(start, prove, _longest, MAX_BOXES).proved


def _gap(C: list[list[Interval | float]], x: list[Interval], bound: Fraction) -> list[list[Interval]]:
    """κ²‖x‖² I − CᵀC."""
    joints = range(len(x))
    size = Interval.exact(0.0)
    for component in x:
        size = size + component.square()
    size = size * Interval.of(bound**2)

    def entry(i: int, j: int) -> Interval:
        total = size if i == j else Interval.exact(0.0)
        for row in C:
            a, b = row[i], row[j]
            if isinstance(a, Interval) and isinstance(b, Interval):
                total = total - (a.square() if i == j else a * b)
        return total

    return [[entry(i, j) for j in joints] for i in joints]


def _boxes(arm: ArmIntervals, boxes: Boxes) -> list[Interval]:
    q = [Interval.exact(0.0)] * arm.n
    for column, joint in enumerate(arm.angles):
        q[joint] = Interval(boxes[:, 0, column], boxes[:, 1, column])
    return q


def _longest(boxes: Boxes) -> NDArray[np.intp]:
    return np.asarray(np.argmax(boxes[:, 1] - boxes[:, 0], axis=1))


def _angles(arm: ArmIntervals, x: Array) -> Array:
    """All joint angles from the columns that matter."""
    q = np.zeros((len(x), arm.n))
    for column, joint in enumerate(arm.angles):
        q[:, joint] = x[:, column]
    return q


def _top(M: Array) -> Array:
    return np.asarray(np.linalg.eigvalsh(M)[:, -1])


def _bottom(M: Array) -> Array:
    return np.asarray(np.linalg.eigvalsh(M)[:, 0])


def _whirl(numeric: NumericModel, arm: ArmIntervals, x: Array) -> Array:
    """‖C(q, x)‖ for the unit vector along the last n columns."""
    first = len(arm.angles)
    direction = x[:, first:] / np.maximum(np.linalg.norm(x[:, first:], axis=1), 1e-9)[:, None]
    C = numeric.coriolis(_angles(arm, x), direction)
    return np.asarray(np.linalg.norm(C, ord=2, axis=(1, 2)))


def _climb(n: int, columns: int, merit: Callable[[Array], Array]) -> Array:
    """A point of large merit: the best of a sample, improved by random steps that shrink."""
    rng = np.random.default_rng(SEED)
    points = rng.uniform(-np.pi, np.pi, (SAMPLES, columns))
    points[: 2 ** min(columns, 8)] = 0.0
    best = points[np.argmax(merit(points))]
    step = 0.5
    for _ in range(60):
        around = best + step * rng.standard_normal((64, columns))
        around[0] = best
        best = around[np.argmax(merit(around))]
        step *= 0.75
    return np.asarray(best)


def _rational(value: float, shift: Fraction) -> Fraction:
    """A rational a little inside of a computed extreme, by far more than that is wrong."""
    return Fraction(value) * (1 + shift)
