"""What is largest along many runs and when each joint settles, between samples too, as in `extremes.c`."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from lyapcheck._types import Array

PARTS = 4
"""Of each step, at the ends of which everything is looked at."""

CUTS, HALVINGS = 16, 48
"""Of an interval that holds the largest torque, by the golden section; and of one that holds a zero."""

GOLDEN = (0.3819660112501051, 0.6180339887498949)

Whole = NDArray[np.intp]
Flags = NDArray[np.bool_]


@dataclass(frozen=True, eq=False)
class StepPart:
    """One step of R runs as columns: from ``y`` (d, R) to ``new`` by the polynomials ``dense`` (7, d, R)."""

    t: Array
    h: Array
    y: Array
    new: Array
    dense: Array
    parameters: Array

    def of(self, chosen: Flags | Whole) -> StepPart:
        """The same of some of the runs."""
        return StepPart(*(x[..., chosen] for x in vars(self).values()))

    def at(
        self, x: Array | float, runs: Whole | slice = slice(None), rows: Whole | slice = slice(None)
    ) -> Array:
        """The states at fractions x of the step; of some runs, and of some components."""
        dense = self.dense[(slice(None), rows, runs)]
        total = x * dense[6]
        for i in reversed(range(6)):
            total = (total + dense[i]) * (x if i % 2 == 0 else 1.0 - x)
        return np.asarray(self.y[rows, runs] + total)


class Seen:
    """What was seen so far of R runs, as columns.

    Args:
        watched: |τ_i| and V (n + 1, R) of states and parameters.
        y: (d, R) at the start.
        parameters: (p, R), of which the first n are the goal.
        bands: (n, R) rad, of the settling times.
    """

    def __init__(
        self, watched: Callable[[Array, Array], Array], y: Array, parameters: Array, bands: Array
    ) -> None:
        n = len(bands)
        self._watched, self.bands, error = watched, bands, parameters[:n] - y[:n]
        self.last = watched(y, parameters)
        self.sign = np.sign(error)
        self.outside: Flags = np.abs(error) > bands
        self.torque, self.beyond, self.settled = (
            self.last[:n].copy(),
            np.zeros_like(error),
            np.zeros_like(error),
        )
        self.first, self.least = self.last[n].copy(), self.last[n].copy()
        self.rise = np.full_like(self.first, -np.inf)
        self.error, self.energy, self.lost = (
            np.zeros_like(self.first),
            np.abs(self.first),
            np.zeros_like(self.first),
        )

    def columns(self) -> Array:
        """(3n + 4, R) as `Paths` has it."""
        settled = np.where(self.outside, np.nan, self.settled)
        return np.vstack([self.torque, self.beyond, settled, self.rise, self.error, self.energy, self.lost])

    def keep(self, on: Flags) -> None:
        """Let go of the runs that are done."""
        for name, value in vars(self).items():
            if isinstance(value, np.ndarray):
                setattr(self, name, value[..., on])

    def look(self, part: StepPart, good: Flags) -> None:
        """One step of the runs that are good."""
        states = [part.y, *(part.at(k / PARTS) for k in range(1, PARTS)), part.new]
        values = [self.last[:, good], *(self._watched(y, part.parameters) for y in states[1:])]
        self._torques(part, good, np.stack(values)[:, :-1])
        self._energies(good, [(value[-1], y[-2]) for value, y in zip(values[1:], states[1:], strict=True)])
        self.last[:, good] = values[-1]
        for k in range(PARTS):
            self._errors(part, good, k, states[k], states[k + 1])

    def _torques(self, part: StepPart, good: Flags, v: Array) -> None:
        """The largest of v (PARTS + 1, n, R), and between where a torque may turn and be largest."""
        top = np.argmax(v, axis=0)
        most = np.max(v, axis=0)
        bend = np.max(np.abs(v[:-2] - 2.0 * v[1:-1] + v[2:]), axis=0)
        sides = np.pad(v, ((1, 1), (0, 0), (0, 0)), constant_values=-np.inf)
        near = np.min(
            [most - np.take_along_axis(sides, top[None] + 1 + k, axis=0)[0] for k in (-1, 1)], axis=0
        )
        best = np.maximum(self.torque[:, good], most)
        joint, run = np.nonzero((near <= bend) & (most + bend > self.torque[:, good]))
        if joint.size:
            low, high = (np.clip(top[joint, run] + k, 0, PARTS) / PARTS for k in (-1, 1))
            np.maximum.at(best, (joint, run), self._search(part.of(run), joint, low, high))
        self.torque[:, good] = best

    def _search(self, part: StepPart, joint: Whole, low: Array, high: Array) -> Array:
        """The largest torque of one joint of each run between two fractions of its step."""
        runs, best = np.arange(joint.size), np.zeros(joint.size)
        for _ in range(CUTS):
            x = [low + share * (high - low) for share in GOLDEN]
            left, right = (self._watched(part.at(each), part.parameters)[joint, runs] for each in x)
            best = np.maximum(best, np.maximum(left, right))
            low, high = np.where(left > right, low, x[0]), np.where(left > right, x[1], high)
        return best

    def _energies(self, good: Flags, ends: list[tuple[Array, Array]]) -> None:
        first = self.first[good]
        for V, lost in ends:
            self.rise[good] = np.maximum(self.rise[good], V - self.least[good])
            self.least[good] = np.minimum(self.least[good], V)
            self.error[good] = np.maximum(self.error[good], np.abs(V + lost - first))
            self.energy[good] = np.maximum(self.energy[good], np.abs(V))
            self.lost[good] = np.maximum(self.lost[good], np.abs(lost))

    def _errors(self, part: StepPart, good: Flags, k: int, y: Array, following: Array) -> None:
        """One part of the step, in which e_i turns where w_i is zero."""
        n = len(self.bands)
        beyond, outside, settled = self.beyond[:, good], self.outside[:, good], self.settled[:, good]
        goal, sign, band = part.parameters[:n], self.sign[:, good], self.bands[:, good]
        last, end = np.full_like(band, k / PARTS), np.full_like(band, (k + 1) / PARTS)
        turns = y[n : 2 * n] * following[n : 2 * n] < 0.0
        if turns.any():
            joint, run = at = np.nonzero(turns)
            x = _crossing(part, (n + joint, run), 0.0, 0.0, last[at], end[at])
            error = goal[at] - part.at(x, run, joint)
            beyond[at] = np.maximum(beyond[at], -sign[at] * error)
            far = np.abs(error) > band[at]
            last[joint[far], run[far]], outside[joint[far], run[far]] = x[far], True
        error = goal - following[:n]
        out: Flags = np.abs(error) > band
        if (came := outside & ~out).any():
            joint, run = at = np.nonzero(came)
            x = _crossing(part, (joint, run), goal[at], band[at], last[at], end[at])
            settled[at] = part.t[run] + part.h[run] * x
        self.beyond[:, good], self.outside[:, good] = np.maximum(beyond, -sign * error), out
        self.settled[:, good] = settled


def _crossing(
    part: StepPart,
    at: tuple[Whole, Whole],
    shift: Array | float,
    band: Array | float,
    low: Array,
    high: Array,
) -> Array:
    """The fraction of the step at which a component less ``shift`` comes into its band."""
    side = np.where(part.at(low, at[1], at[0]) - shift < 0.0, -1.0, 1.0)
    for _ in range(HALVINGS):
        middle = 0.5 * (low + high)
        outside = side * (part.at(middle, at[1], at[0]) - shift) > band
        low, high = np.where(outside, middle, low), np.where(outside, high, middle)
    return np.asarray(0.5 * (low + high))
