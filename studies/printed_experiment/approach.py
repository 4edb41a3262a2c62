"""A search for arms in range that come as close as possible to what is printed."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np
from numpy.typing import NDArray

from lyapcheck._types import Array

PARENTS = 8
CHILDREN = 6
"""Of each parent in each round, unless told otherwise."""

STEPS = (0.4, 0.25, 0.12, 0.05, 0.02)
"""Standard deviations of the rounds, in widths of the ranges."""


def approach(
    points: Array,
    differences: Array,
    evaluate: Callable[[Array], Array],
    reached: Callable[[Array], NDArray[np.bool_]],
    seed: int,
    children: int = CHILDREN,
) -> Array:
    """More points, around those that come nearest to each of several goals.

    In each round the `PARENTS` nearest points of a goal get ``children`` each, at random around them, cut at
    the ends of the ranges; a goal that is reached drops out.

    Args:
        points: (R, d) in the unit cube.
        differences: (R, goals) how far each point is from each goal, of any sign, ∞ where nothing is known.
        evaluate: the differences at new points.
        reached: (goals,) which goals all differences so far have reached.
        seed: of the random numbers.
        children: of each parent in each round.

    Returns:
        (R', d) the new points, in the order in which they were evaluated.

    Soundness: a goal that is not reached may still be in reach: a search, not a proof.
    """
    draw = np.random.default_rng(seed)
    start = len(points)
    for step in STEPS:
        goals = np.flatnonzero(~reached(differences))
        if goals.size == 0:
            break
        fresh = np.vstack(
            [_around(points, np.abs(differences[:, goal]), children, step, draw) for goal in goals]
        )
        points, differences = np.vstack([points, fresh]), np.vstack([differences, evaluate(fresh)])
    return points[start:]


def _around(points: Array, distances: Array, children: int, step: float, draw: np.random.Generator) -> Array:
    parents = points[np.argsort(distances, kind="stable")[:PARENTS]]
    around = np.repeat(parents, children, axis=0)
    return np.clip(around + step * draw.standard_normal(around.shape), 0.0, 1.0)


HALVINGS = 12


def between(points: Array, differences: Array, evaluate: Callable[[Array], Array]) -> Array:
    """Points ever nearer to where the difference from each goal changes sign.

    For each goal the way from the nearest point below to the nearest above is halved `HALVINGS` times: where
    the difference is continuous it tends to 0, where it jumps the jump is found.

    Args:
        points: (R, d) in the unit cube.
        differences: (R, goals), of both signs for each goal.
        evaluate: points (goals, d), one a goal, to their differences (goals,).

    Returns:
        (HALVINGS · goals, d) the points in the middle.
    """
    below = points[np.argmin(np.where(differences <= 0.0, -differences, np.inf), axis=0)]
    above = points[np.argmin(np.where(differences >= 0.0, differences, np.inf), axis=0)]
    result = []
    for _ in range(HALVINGS):
        middle = (below + above) / 2
        result.append(middle)
        under = (evaluate(middle) <= 0.0)[:, None]
        below, above = np.where(under, middle, below), np.where(under, above, middle)
    return np.vstack(result)
