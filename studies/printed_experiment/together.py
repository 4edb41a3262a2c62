"""Several printed numbers at one and the same arm."""

from __future__ import annotations

from collections.abc import Callable, Sequence

import numpy as np
from numpy.typing import NDArray

from lyapcheck._types import Array
from studies.printed_experiment.approach import approach
from studies.printed_experiment.design import values
from studies.printed_experiment.printed_numbers import PrintedNumber
from studies.printed_experiment.results import AtOnce, Together
from studies.printed_experiment.trials import Trials

CHILDREN = 12
"""Of each parent in each round of these searches: there is one goal only, and it is narrow."""


def all_sets(trials: Sequence[Trials], common: int, seed: int | None) -> Together | None:
    """The L2 indices of all gain sets at one arm: the bench did not change between the paper's experiments.

    Args:
        trials: one a gain set; the first ``common`` points are the same for all.
        common: how many.
        seed: of the search; none for no search.

    Returns:
        None for fewer than two gain sets.
    """
    if len(trials) < 2:
        return None
    goals = [result.printed[0] for result in trials]

    def indices(points: Array) -> Array:
        return np.column_stack([result.at(points).L2 for result in trials])

    seen = np.column_stack([result.outcomes.L2[:common] for result in trials])
    best, seen = _search(trials[0], trials[0].points[:common], seen, goals, indices, seed)
    return Together(best, _ordered(seen, np.array([goal.value for goal in goals])))


def one_set(result: Trials, seed: int | None) -> AtOnce:
    """The L2 index and the settling times of one gain set at one arm."""
    goals = [number for number in result.printed if number.quantity in ("L2", "settling")]

    def columns(points: Array) -> Array:
        outcomes = result.at(points)
        return np.column_stack([goal.column(outcomes) for goal in goals])

    seen = np.column_stack([goal.column(result.outcomes) for goal in goals])
    return _search(result, result.points, seen, goals, columns, seed)[0]


def _search(
    result: Trials,
    points: Array,
    seen: Array,
    goals: Sequence[PrintedNumber],
    evaluate: Callable[[Array], Array],
    seed: int | None,
) -> tuple[AtOnce, Array]:
    """(the arm whose largest relative difference from the goals is least, all values seen)."""
    collected = [seen]

    def differences(values: Array) -> Array:
        T = result.runs.task.T
        apart = np.column_stack([_apart(goal, values[:, i], T) for i, goal in enumerate(goals)])
        return np.asarray(apart.max(axis=1, keepdims=True))

    def collect(new: Array) -> Array:
        collected.append(evaluate(new))
        return differences(collected[-1])

    if seed is not None:
        more = approach(points, differences(seen), collect, _never, seed, children=CHILDREN)
        points = np.vstack([points, more])
    everything = np.vstack(collected)
    worst = differences(everything)[:, 0]
    best = int(np.argmin(worst))
    at = values(result.runs.assumed, points[best : best + 1])[0]
    finite = tuple(float(x) if np.isfinite(x) else None for x in everything[best])
    return AtOnce(finite, float(worst[best]), tuple(float(x) for x in at), len(points)), everything


def _apart(goal: PrintedNumber, seen: Array, T: float) -> Array:
    """The relative difference from a printed number, 0 where a bound is met; never settled counts as at T."""
    apart = np.where(np.isposinf(seen), T, seen) / goal.value - 1.0
    size = np.maximum(apart, 0.0) if goal.at_most else np.abs(apart)
    return np.where(np.isnan(size), np.inf, size)


def _never(seen: Array) -> NDArray[np.bool_]:
    """A narrow goal is never near enough."""
    return np.zeros(seen.shape[1], bool)


def _ordered(seen: Array, printed: Array) -> float:
    """The share of arms that put the gain sets in the printed order."""
    order = np.argsort(printed)
    return float(np.mean(np.all(np.diff(seen[:, order], axis=1) > 0.0, axis=1)))
