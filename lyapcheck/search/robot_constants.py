"""Certified constants of an arm: λmin(M), λmax(M) = β_M and k_c, each from both sides.

The inside bound belongs to one state, evaluated in intervals (``lyapcheck.search.extreme_states``); the
outside bound is proved by covering all angles (and, for k_c, all directions) with boxes on which an interval
matrix is positive definite:

    β I − M(q) ≻ 0,      M(q) − λ I ≻ 0,      κ² ‖x‖² I − C(q,x)ᵀ C(q,x) ≻ 0.

C(q,x) is linear in x, so that x need only run over the faces x_k = 1 of the cube, k = 1 … n. Where
the budget of boxes does not reach, the outside bound is the coarse one of the whole torus as a single box.

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
from lyapcheck.intervals import Interval, norm
from lyapcheck.intervals.arm import ArmBox, ArmIntervals, coriolis
from lyapcheck.intervals.definite import positive_definite
from lyapcheck.lyapunov.scalar import RobotBounds
from lyapcheck.robots import RobotModel
from lyapcheck.search.cover import Boxes, cover
from lyapcheck.search.extreme_states import ExtremeStates

Entries = list[list[Interval | float]]

Array = NDArray[np.float64]

PI_ABOVE = 3.1415926535897936
GAPS = tuple(Fraction(n, 1000) for n in (1, 10, 30, 100, 1000))
"""Relative gaps between the found and the proved bound that are tried, best first."""
MAX_BOXES = 150_000


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

    Soundness: outward-rounded intervals and ``lyapcheck.search.cover``; the inside bounds are evaluated in
        the same intervals, at one point.
    """
    arm = ArmIntervals(model.fixed())
    states = ExtremeStates(arm)
    lambda_min_at, least = states.eigenvalue(0)
    lambda_max_at, largest = states.eigenvalue(-1)
    k_c_at, whirl = states.whirl()
    return RobotConstants(
        lambda_min=_lambda_min(arm, Fraction(float(least.hi))),
        lambda_max=_lambda_max(arm, Fraction(float(largest.lo))),
        k_c=_k_c(arm, Fraction(float(whirl.lo))),
        lambda_min_at=tuple(lambda_min_at.tolist()),
        lambda_max_at=tuple(lambda_max_at.tolist()),
        k_c_at=tuple(k_c_at.tolist()),
    )


def _lambda_max(arm: ArmIntervals, inside: Fraction) -> Enclosure:
    bounds = (inside * (1 + gap) for gap in GAPS)
    proved = next((bound for bound in bounds if _proved(arm, _shifted(bound, -1))), None)
    coarse = coarse_eigenvalues(arm).upper
    return Enclosure(inside, coarse if proved is None else min(proved, coarse))


def _lambda_min(arm: ArmIntervals, inside: Fraction) -> Enclosure:
    bounds = (inside * (1 - gap) for gap in GAPS)
    proved = next((bound for bound in bounds if _proved(arm, _shifted(bound, 1))), None)
    coarse = coarse_eigenvalues(arm).lower
    return Enclosure(coarse if proved is None else max(proved, coarse), inside)


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


def _k_c(arm: ArmIntervals, inside: Fraction) -> Enclosure:
    if not arm.christoffel:
        return Enclosure.exact(0)
    bounds = (inside * (1 + gap) for gap in GAPS)
    proved = next((b for b in bounds if all(_face_proved(arm, k, b) for k in range(arm.n))), None)
    coarse = coarse_k_c(arm)
    return Enclosure(inside, coarse if proved is None else min(proved, coarse))


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


def coarse_eigenvalues(arm: ArmIntervals) -> Enclosure:
    """All eigenvalues of all M(q), by Gershgorin's discs over the whole torus."""
    discs = []
    for i, row in enumerate(_torus(arm).mass()):
        reach = sum((_size(x) for j, x in enumerate(row) if j != i), Interval.exact(0.0)).hi
        discs.append(row[i] + Interval(-reach, reach))
    return Enclosure(
        min(Fraction(float(disc.lo)) for disc in discs), max(Fraction(float(disc.hi)) for disc in discs)
    )


def coarse_k_c(arm: ArmIntervals) -> Fraction:
    """(Σ c_ijk²)^½, which ‖C(q,x)y‖/(‖x‖‖y‖) never exceeds, over the whole torus."""
    symbols = _torus(arm).symbols().items()
    doubled = [symbol for (_, j, k), symbol in symbols for _ in range(1 if j == k else 2)]
    return Fraction(float(norm(doubled).hi))


def _torus(arm: ArmIntervals) -> ArmBox:
    return arm.at([Interval(np.asarray(-PI_ABOVE), np.asarray(PI_ABOVE))] * arm.n)


def _size(entry: Interval | float) -> Interval:
    """[0, max |x|]."""
    zero = np.asarray(0.0)
    return Interval(zero, np.maximum(-entry.lo, entry.hi) if isinstance(entry, Interval) else zero)
