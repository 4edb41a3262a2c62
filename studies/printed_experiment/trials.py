"""The bench runs made so far for one gain set, and the numbers the paper prints of it."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, fields, replace

import numpy as np
from numpy.typing import NDArray

from lyapcheck._types import Array
from studies.printed_experiment.approach import approach, between
from studies.printed_experiment.bench_runs import BenchRuns, Outcomes
from studies.printed_experiment.design import values
from studies.printed_experiment.printed_numbers import PrintedNumber

Mask = NDArray[np.bool_]

SAME = 1e-9
"""A number that no arm changes by more than this, relatively, does not depend on the arm."""


@dataclass(frozen=True, eq=False)
class Trials:
    """Points of the unit cube with what came of them.

    Args:
        runs: the bench with the gain set.
        printed: what the paper prints of it.
        points: (R, d), those of the design first.
        outcomes: of each point.
    """

    runs: BenchRuns
    printed: tuple[PrintedNumber, ...]
    points: Array
    outcomes: Outcomes

    def at(self, points: Array) -> Outcomes:
        """What comes of other points."""
        return self.runs(values(self.runs.assumed, points))

    def searched(self, seed: int) -> Trials:
        """These trials and those of a search for arms that do what is printed, number by number.

        First for an arm on either side of each printed number, then by halving the way between the two.
        """
        goals = [number for number in self.printed if self.moved(number)]
        if not goals:
            return self
        result = self._widened(goals, seed)
        sides = [number for number in goals if not number.at_most and result._both_sides(number)]
        return result._halved(sides) if sides else result

    def moved(self, number: PrintedNumber) -> bool:
        """Whether the arm has any influence on a number."""
        seen = number.column(self.outcomes)
        finite = seen[np.isfinite(seen)]
        return finite.size != seen.size or bool(np.ptp(finite) > SAME * np.abs(finite).max())

    def _widened(self, goals: Sequence[PrintedNumber], seed: int) -> Trials:
        bound = np.array([number.at_most for number in goals])

        def reached(seen: Array) -> Mask:
            below, above = np.any(seen <= 0.0, axis=0), np.any(seen >= 0.0, axis=0)
            return np.asarray(below & (above | bound))

        fresh: list[Outcomes] = []

        def evaluate(points: Array) -> Array:
            fresh.append(self.at(points))
            return differences(goals, fresh[-1])

        result = approach(self.points, differences(goals, self.outcomes), evaluate, reached, seed)
        return self._with(result, fresh)

    def _both_sides(self, number: PrintedNumber) -> bool:
        seen = differences([number], self.outcomes)
        return bool(np.any(seen <= 0.0) and np.any(seen >= 0.0))

    def _halved(self, goals: Sequence[PrintedNumber]) -> Trials:
        fresh: list[Outcomes] = []

        def evaluate(points: Array) -> Array:
            fresh.append(self.at(points))
            return np.diagonal(differences(goals, fresh[-1]))

        result = between(self.points, differences(goals, self.outcomes), evaluate)
        return self._with(result, fresh)

    def _with(self, points: Array, fresh: Sequence[Outcomes]) -> Trials:
        """These trials and new ones, in the same order."""
        parts = [self.outcomes, *fresh]
        columns = {name: np.concatenate([getattr(part, name) for part in parts]) for name in _COLUMNS}
        return replace(self, points=np.vstack([self.points, points]), outcomes=Outcomes(**columns))


_COLUMNS = tuple(one.name for one in fields(Outcomes))


def differences(goals: Sequence[PrintedNumber], outcomes: Outcomes) -> Array:
    """(R, goals) what is seen less what is printed; ∞ for a joint that does not settle, or no outcome."""
    columns = np.column_stack([number.column(outcomes) - number.value for number in goals])
    return np.where(np.isnan(columns), np.inf, columns)


def first_trials(runs: BenchRuns, printed: tuple[PrintedNumber, ...], points: Array) -> Trials:
    """The trials at the points of a design."""
    return Trials(runs, printed, points, runs(values(runs.assumed, points)))
