"""A solution at the times at which something of it is largest or smallest, between samples too."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np

from lyapcheck._types import Array
from lyapcheck.simulate.integrate import Trajectory

PARTS = 4
"""Of each step of the integrator, at the ends of which extremes are looked for."""

CUTS = 8
"""Of the interval that holds an extreme, in each round; two of them hold it in the next."""

ROUNDS = 7
"""Then the interval is 4⁷ times shorter, and a smooth signal off its extreme by 4⁻¹⁴ of what it was."""

Signals = Callable[[Trajectory], Array]
"""A solution at N times to (N, k) numbers of which the extremes matter."""


def with_extremes(path: Trajectory, signals: Signals) -> Trajectory:
    """The solution at its samples, between the integrator's steps, and where a signal has a local extreme.

    Args:
        path: a solution.
        signals: smooth numbers of a state.

    Soundness: floating point; an extreme that begins and ends within a quarter of one step is not seen.
    """
    steps = path.steps
    parts = steps[:-1] + np.diff(steps) * np.linspace(0.0, 1.0, PARTS, endpoint=False)[:, None]
    t = np.unique(np.concatenate((path.t, parts.ravel(), steps)))
    slopes = np.sign(np.diff(signals(path.at(t)), axis=0))
    turns, column = np.nonzero(slopes[:-1] * slopes[1:] < 0)
    if not turns.size:
        return path.at(t)
    low, high, sign = t[turns], t[turns + 2], slopes[turns, column]
    for _ in range(ROUNDS):
        times = np.linspace(low, high, CUTS + 1)
        every, places = np.unique(times, return_inverse=True)
        values = signals(path.at(every))[places.reshape(times.shape), column] * sign
        top = np.clip(np.argmax(values, axis=0), 1, CUTS - 1)
        low, high = (np.take_along_axis(times, (top + k)[None], axis=0)[0] for k in (-1, 1))
    return path.at(np.unique(np.concatenate((t, (low + high) / 2))))
