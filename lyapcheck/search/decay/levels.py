"""Levels of V and the λ of each band between them: floating-point choices that the checker looks at again."""

from __future__ import annotations

import math
from collections.abc import Callable, Iterator
from fractions import Fraction

import numpy as np

from lyapcheck.check.loop.decay.estimate import Estimate
from lyapcheck.family import Family

POINTS = 161
STEPS = 40
MOST_LEVELS = 4_000


class Slopes:
    """Chooses λ for bands of levels, by minima over a grid of each error.

    Args:
        estimate: what the bands are for.
        family: the same function h, in NumPy.
    """

    def __init__(self, estimate: Estimate, family: Family) -> None:
        self.estimate = estimate
        self.steepest = float(estimate.steepest)
        self.family = family
        self.kp = [float(k) for k in estimate.margin.loop.kp]
        self.c = [float(c) for c in estimate.stiffness]
        self.f = [float(f) for f in estimate.disturbance.dry]

    def best(self, low: Fraction, high: Fraction) -> Fraction:
        """The λ that makes λ·low + Σ min (c h² − f h − λ k U) largest, nearly: it is concave in λ."""
        share = np.linspace(0.0, 1.0, POINTS) ** 2
        parts = []
        rows = zip(self.estimate.reach(high), self.c, self.f, self.kp, strict=True)
        for end, c, f, k in rows:
            x = end * share
            h = self.family.h(x)
            parts.append((c * h * h - f * h, k * self.family.potential(x)))

        def inside(slope: float) -> float:
            return slope * float(low) + sum(float(np.min(g - slope * u)) for g, u in parts)

        result = min(Fraction(_peak(inside, self.steepest)), self.estimate.steepest)
        return result


def _peak(value: Callable[[float], float], end: float) -> float:
    """The place of the largest value of a concave function on [0, end], by the golden section."""
    ratio = (math.sqrt(5.0) - 1.0) / 2.0
    low, high = 0.0, end
    a, b = high - ratio * (high - low), low + ratio * (high - low)
    at_a, at_b = value(a), value(b)
    for _ in range(STEPS):
        if at_a >= at_b:
            high, b, at_b = b, a, at_a
            a = high - ratio * (high - low)
            at_a = value(a)
        else:
            low, a, at_a = a, b, at_b
            b = low + ratio * (high - low)
            at_b = value(b)
    # the last comparison may favour the very end
    return end if value(end) >= max(at_a, at_b) else 0.5 * (low + high)


def falling(start: Fraction, goal: Fraction, ratio: float) -> Iterator[Fraction]:
    """Levels from the start down to the goal, each ``ratio`` of the one before; short binary fractions."""
    yield start
    steps = max(1, math.ceil(math.log(float(start / goal)) / -math.log(ratio)))
    for k in range(1, min(steps, MOST_LEVELS)):
        yield Fraction(float(start) * ratio**k)
    yield goal
