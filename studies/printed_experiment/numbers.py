"""One printed number against all trials."""

from __future__ import annotations

import math

import numpy as np

from lyapcheck._types import Array
from studies.printed_experiment.design import LEVELS, Design, values
from studies.printed_experiment.printed_numbers import PrintedNumber
from studies.printed_experiment.results import Answer, NumberStudy
from studies.printed_experiment.shares import shares
from studies.printed_experiment.trials import Trials

NEAR, LEAST = 0.01, 0.005
"""A value within 1 % and 0.005 ° or s of a printed one is taken for it."""

Ends = tuple[float | None, float | None]


def number_study(number: PrintedNumber, result: Trials, plan: Design) -> NumberStudy:
    """Everything about one number; the trials begin with the points of ``plan`` in their order.

    A joint that does not settle counts as one that settles at the end of the run where shares of the variance
    are computed, and as larger than any printed time where a printed time is looked for.
    """
    seen = number.column(result.outcomes)
    nominal, alone, spread = _parts(seen, plan)
    at, nearest = _nearest(number, result, seen)
    low, high, moved = *ends(seen), result.moved(number)
    return NumberStudy(
        printed=number,
        nominal=finite(nominal),
        low=low,
        high=high,
        typical=_typical(spread),
        unsettled=float(np.mean(np.isinf(spread))) if spread.size else 0.0,
        alone=tuple(ends(row) for row in alone),
        shares=_shares(plan.spread, spread, result),
        answer=_answer(number, seen, nearest) if moved else Answer.NO_PART,
        nearest=nearest,
        at=at if moved else None,
        runs=len(seen),
    )


def _parts(seen: Array, plan: Design) -> tuple[float, Array, Array]:
    """(nominal, (d, LEVELS) one at a time, (N,) spread)."""
    size = plan.nominal.size
    alone = seen[1 : 1 + size * LEVELS].reshape(size, LEVELS)
    start = 1 + size * LEVELS
    return float(seen[0]), alone, seen[start : start + len(plan.spread)]


def _typical(spread: Array) -> Ends:
    if not spread.size:
        return None, None
    low, high = np.quantile(np.nan_to_num(spread, nan=np.inf, posinf=np.inf), (0.05, 0.95), method="nearest")
    return finite(float(low)), finite(float(high))


def _shares(points: Array, spread: Array, result: Trials) -> tuple[float, ...] | None:
    good = ~np.isnan(spread)
    if good.sum() < 2:
        return None
    known = np.where(np.isinf(spread), result.runs.task.T, spread)[good]
    whole = shares(points[good], known)
    return None if whole is None else tuple(float(x) for x in whole)


def _answer(number: PrintedNumber, seen: Array, nearest: float | None) -> Answer:
    known = seen[~np.isnan(seen)]
    below, above = bool(np.any(known <= number.value)), bool(np.any(known >= number.value))
    if number.at_most or not (below and above):
        return Answer.YES if below and number.at_most else Answer.NO
    if nearest is not None and abs(nearest - number.value) <= NEAR * abs(number.value) + LEAST:
        return Answer.YES
    return Answer.BETWEEN


def _nearest(
    number: PrintedNumber, result: Trials, seen: Array
) -> tuple[tuple[float, ...] | None, float | None]:
    """(the assumed numbers, the value) nearest to the printed one; the smallest one for a printed bound."""
    distance = np.where(np.isfinite(seen), np.abs(seen - number.value), np.inf)
    if number.at_most:
        distance = np.where(np.isfinite(seen), seen, np.inf)
    best = int(np.argmin(distance))
    if not math.isfinite(distance[best]):
        return None, None
    at = values(result.runs.assumed, result.points[best : best + 1])[0]
    return tuple(float(x) for x in at), float(seen[best])


def ends(seen: Array) -> Ends:
    """The least and the largest finite value; none where there is none."""
    known = seen[np.isfinite(seen)]
    return (float(known.min()), float(known.max())) if known.size else (None, None)


def finite(value: float) -> float | None:
    """The value, none if it is not finite."""
    return value if math.isfinite(value) else None
