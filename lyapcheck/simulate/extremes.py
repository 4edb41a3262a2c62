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


def turns(t: Array, q: Array, w: Array) -> Array:
    """(N − 1, n) where each angle turns between two samples, by the cubic of both; else its later value.

    Args:
        t: (N,) times in s.
        q: (N, n) angles in rad.
        w: (N, n) their rates in rad/s.

    Soundness: floating point; exact to the fourth order in the distance of samples.
    """
    h = np.diff(t)[:, None]
    rise, first, last = np.diff(q, axis=0), h * w[:-1], h * w[1:]
    square, middle = 3.0 * (first + last - 2.0 * rise), 3.0 * rise - 2.0 * first - last
    with np.errstate(all="ignore"):
        # the root of first + 2 middle s + square s² between 0 and 1, written so that nothing cancels
        root = np.sqrt(np.maximum(middle * middle - square * first, 0.0))
        s = first / (np.copysign(root, first) - middle)
    value = q[:-1] + s * (first + s * (middle + s * square / 3.0))
    return np.asarray(np.where((first * last < 0.0) & (s > 0.0) & (s < 1.0), value, q[1:]))
