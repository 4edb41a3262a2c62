"""The largest value of a function of many variables, as far as samples and small steps find it."""

from __future__ import annotations

from collections.abc import Callable
from random import Random
from typing import Any

import numpy as np

SAMPLES = 300
ROUNDS = 14
STEPS = 40
BEST = 3

Function = Callable[[Any], Any]
"""From columns of points to one value a column."""


def climbed(
    function: Function,
    start: Callable[[Any, int], Any],
    random: Random,
    samples: int = SAMPLES,
    rounds: int = ROUNDS,
) -> tuple[float, Any]:
    """The largest value met, and where: samples, then ever smaller steps from the best of them.

    Values that are no numbers count as the least.
    """
    generator = np.random.default_rng(random.getrandbits(32))
    points = start(generator, samples)
    values = _plain(function(points))
    chosen = np.argsort(values)[-BEST:]
    best, tops = points[:, chosen], values[chosen]
    width = 0.5
    for _ in range(rounds):
        size = np.maximum(np.abs(best), 0.1)
        steps = width * generator.standard_normal((*best.shape, STEPS)) * size[..., None]
        near = best[..., None] + steps * (generator.random(steps.shape) < 0.7)
        result = _plain(function(near.reshape(len(best), -1))).reshape(best.shape[1], STEPS)
        for k, row in enumerate(result):
            step = int(np.argmax(row))
            if row[step] > tops[k]:
                best[:, k], tops[k] = near[:, k, step], row[step]
        width *= 0.5
    top = int(np.argmax(tops))
    return float(tops[top]), best[:, top]


def _plain(values: Any) -> Any:
    return np.where(np.isfinite(values), values, -np.inf)
