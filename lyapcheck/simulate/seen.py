"""What is largest along many runs and when each joint settles, between samples too.

Each step of the integrator is looked at in `PARTS` parts, by its own polynomial: where a joint turns, where
it comes into its band, and the torques and V at the ends of the parts. The part that should hold the largest
torque of a joint is kept, and searched once all runs are over.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from lyapcheck._types import Array
from lyapcheck.family import Family
from lyapcheck.family.base import Arithmetic
from lyapcheck.lyapunov.along import AtState, FormsAt, total
from lyapcheck.lyapunov.numeric import Formula
from lyapcheck.robots import RobotModel

# --- The closed loop (11) of many runs: their rates, torques and V, compiled where possible, else by NumPy.
#
# References: (6), (11), (12) of ``reyes2019family``.


Columns = Sequence[Any]


class RightSide:
    """One arm under one family; states y = (q, w, D, S) and parameters as columns.

    D is the energy that damping has taken, whose error counts for the sizes of steps, and S = ∫‖e‖².
    Parameters are q_d, K_p, K_v and B (n each), the uncertain numbers of the arm, and ε₀.
    """

    def __init__(self, model: RobotModel, family: Family) -> None:
        self.n, n = model.n, model.n
        sizes = 2 * n + 2, 4 * n + len(model.parameters) + 1
        self.rate = Formula("motion", model, family, sizes, 2 * n + 2, _rate)
        """ẏ (2n + 2, R): w, ẇ, wᵀBw + wᵀK_v h(w), ‖e‖²."""
        self.watched = Formula("watched", model, family, sizes, n + 1, _watched)
        """(n + 1, R) |τ_i| and V."""

    @property
    def engine(self) -> str:
        """``compiled`` or ``numpy``."""
        return "numpy" if None in (self.rate.loop, self.watched.loop) else "compiled"


def _at(model: RobotModel, of: Arithmetic, forms: FormsAt, y: Columns, parameters: Columns) -> AtState:
    n = model.n
    q, w = list(y[:n]), list(y[n : 2 * n])
    goal, kp, kv, viscous = (parameters[i * n : (i + 1) * n] for i in range(4))
    e = of.names([d - x for d, x in zip(goal, q, strict=True)])
    uncertain = dict(zip(model.parameters, parameters[4 * n : -1], strict=True))
    return AtState(model, of, forms, q, e, w, kp, kv, viscous, uncertain)


def _rate(*known: Any) -> list[Any]:
    at = _at(*known)
    return [*at.w, *at.acceleration(), at.damping(), total(x * x for x in at.e)]


def _watched(*known: Any) -> list[Any]:
    at, (*_, eps0) = _at(*known), known[-1]
    return [*map(at.of.fabs, at.torque()), at.value(eps0)]


PARTS = 4
"""Of each step, at the ends of which everything is looked at."""
CUTS, ROUNDS, SHARP = 20, 12, 1e-13
"""Golden sections of the part of a largest torque; steps towards a zero in one, and when it is found."""
GOLDEN = (0.3819660112501051, 0.6180339887498949)
Whole = NDArray[np.intp]
Flags = NDArray[np.bool_]
Curve = Callable[[Array | float], Array]


@dataclass(frozen=True, eq=False)
class Step:
    """One step of R runs as columns: from ``y`` (d, R) to ``new`` by the polynomials ``dense`` (7, d, R)."""

    t: Array
    h: Array
    y: Array
    new: Array
    dense: Array
    parameters: Array

    def of(self, chosen: Flags) -> Step:
        """The same of some of the runs."""
        return Step(*(np.compress(chosen, x, axis=-1) for x in vars(self).values()))

    def curve(self, runs: Whole | slice = slice(None), rows: Whole | slice = slice(None)) -> Curve:
        """The states at fractions x of the step; of some runs, and of some components."""
        return curve(self.y[rows, runs], self.dense[:, rows, runs])


def curve(y: Array, dense: Array) -> Curve:
    """The polynomial of degree 7 from y on."""

    def at(x: Array | float) -> Array:
        total, rest = x * dense[6], 1.0 - x
        for i in reversed(range(6)):
            total += dense[i]
            total *= x if i % 2 == 0 else rest
        return np.asarray(y + total)

    return at


class Peaks:
    """The largest torque of each joint of R runs, by the part of a step in which a parabola has it."""

    def __init__(self, side: RightSide, y: Array, parameters: Array, torque: Array) -> None:
        self._side, self._p = side, parameters
        self.seen, self.expected = torque.copy(), torque.copy()
        self.part = np.full(torque.shape, -1)
        self.held = np.zeros((8, len(y), *torque.shape))

    def look(self, who: Whole, step: Step, torque: Array) -> None:
        """One step of some runs, with |τ| (PARTS + 1, n, R) at the ends of its parts."""
        self.seen[:, who] = np.maximum(self.seen[:, who], torque.max(axis=0))
        first, second = np.diff(torque, axis=0), np.diff(torque, n=2, axis=0)
        expected = np.maximum(torque[:-1], torque[1:])
        for k in range(PARTS):
            for j in {max(k - 1, 0), min(k, PARTS - 2)}:  # the parabola through the ends j, j + 1, j + 2
                bend = np.minimum(second[j], -1e-300)
                place = 0.5 - first[j] / bend  # of its top, in parts from the end j
                top = torque[j] - 0.5 * bend * place * place
                inside = (second[j] < 0.0) & (place >= k - j) & (place <= k - j + 1)
                expected[k] = np.where(inside, np.maximum(expected[k], top), expected[k])
        part = expected.argmax(axis=0)
        most = np.take_along_axis(expected, part[None], axis=0)[0]
        joint, run = np.nonzero(most > self.expected[:, who])
        if joint.size:
            place = joint, who[run]
            self.expected[place], self.part[place] = most[joint, run], part[joint, run]
            self.held[(0, slice(None), *place)] = step.y[:, run].T
            self.held[(slice(1, None), slice(None), *place)] = step.dense[:, :, run]

    def largest(self) -> Array:
        """The largest torques (n, R), by golden sections of the parts."""
        joint, run = np.nonzero(self.part >= 0)
        if joint.size:
            whole = self.held[:, :, joint, run]
            at, p, own = curve(whole[0], whole[1:]), self._p[:, run], np.arange(joint.size)
            low = self.part[joint, run] / PARTS
            high = low + 1.0 / PARTS
            for _ in range(CUTS):
                x = [low + share * (high - low) for share in GOLDEN]
                left, right = (self._side.watched(at(each), p)[joint, own] for each in x)
                np.maximum.at(self.seen, (joint, run), np.maximum(left, right))
                low, high = np.where(left > right, low, x[0]), np.where(left > right, x[1], high)
        return self.seen


class Seen:
    """What was seen so far of R runs, as columns.

    Args:
        side: the arm.
        y: (d, R) at the start.
        parameters: (p, R), of which the first n are the goal.
        bands: (n, R) rad, of the settling times.
    """

    def __init__(self, side: RightSide, y: Array, parameters: Array, bands: Array) -> None:
        n = len(bands)
        self._side, self.bands, error = side, bands, parameters[:n] - y[:n]
        self.last = side.watched(y, parameters)
        self.sign = np.sign(error)
        self.outside: Flags = np.abs(error) > bands
        self.beyond, self.settled = np.zeros_like(error), np.zeros_like(error)
        self.least = self.last[n].copy()
        self.rise = np.full_like(self.least, -np.inf)
        self.peaks, self.who = Peaks(side, y, parameters, self.last[:n]), np.arange(y.shape[1])

    def columns(self, chosen: Flags) -> Array:
        """(2n + 1, R) of some runs that are over, without their torques.

        The largest −sign(e_i(0)) e_i, rad; when each |e_i| came into its band for good, s, NaN where it did
        not; the largest rise of V above what it had been, J.
        """
        settled = np.where(self.outside, np.nan, self.settled)
        return np.vstack([x[..., chosen] for x in (self.beyond, settled, self.rise)])

    def keep(self, on: Flags) -> None:
        """Let go of the runs that are done."""
        for name, value in vars(self).items():
            if isinstance(value, np.ndarray):
                setattr(self, name, value[..., on])

    def look(self, step: Step, good: Flags) -> None:
        """One step of the runs that are good."""
        at = step.curve()
        states = np.stack([step.y, *(at(k / PARTS) for k in range(1, PARTS)), step.new])
        columns = np.concatenate(list(states[1:]), axis=1)
        watched = self._side.watched(columns, np.tile(step.parameters, PARTS))
        values = np.stack([self.last[:, good], *np.split(watched, PARTS, axis=1)])
        self.last[:, good] = values[-1]
        self.peaks.look(self.who[good], step, values[:, :-1])
        self._errors(step, good, states)
        for value in values[1:, -1]:
            self.rise[good] = np.maximum(self.rise[good], value - self.least[good])
            self.least[good] = np.minimum(self.least[good], value)

    def _errors(self, step: Step, good: Flags, states: Array) -> None:
        """How far e_i comes beyond 0, and when it comes into its band: e_i turns where w_i is 0."""
        n = len(self.bands)
        goal, sign, band = step.parameters[:n], self.sign[:, good], self.bands[:, good]
        error, w = goal - states[:, :n], states[:, n : 2 * n]
        x = np.full((2 * PARTS + 1, *band.shape), np.nan)  # the ends of parts, and the turns between them
        x[::2] = (np.arange(PARTS + 1) / PARTS)[:, None, None]
        size = np.full_like(x, -np.inf)
        size[::2] = np.abs(error)
        beyond = np.maximum(self.beyond[:, good], np.max(-sign * error, axis=0))
        k, i, r = np.nonzero(w[:-1] * w[1:] < 0.0)
        if k.size:
            turn = _zero(step.curve(r, n + i), k / PARTS, (k + 1) / PARTS)
            turned = goal[i, r] - step.curve(r, i)(turn)
            np.maximum.at(beyond, (i, r), -sign[i, r] * turned)
            x[2 * k + 1, i, r], size[2 * k + 1, i, r] = turn, np.abs(turned)
        self.beyond[:, good] = beyond
        out = size > band
        now = out[-1]
        came = out.any(axis=0) & ~now
        if came.any():
            i, r = np.nonzero(came)
            last = 2 * PARTS - np.argmax(out[::-1, i, r], axis=0)
            after = np.where(np.isnan(x[last + 1, i, r]), last + 2, last + 1)
            q, away_from, wide = step.curve(r, i), goal[i, r], band[i, r]
            side = np.sign(away_from - q(x[last, i, r]))

            def away(x: Array | float) -> Array:
                return np.asarray(side * (away_from - q(x)) - wide)

            at = _zero(away, x[last, i, r], x[after, i, r])
            settled = self.settled[:, good]
            settled[i, r] = step.t[r] + step.h[r] * at
            self.settled[:, good] = settled
        self.outside[:, good] = now


def _zero(f: Curve, low: Array, high: Array) -> Array:
    """Where f changes its sign between two places, by false position with halved ends (Illinois)."""
    a, b = np.array(low, float), np.array(high, float)
    at_a, at_b = f(a), f(b)
    x, sharp = b, np.zeros(b.shape, dtype=bool)
    for _ in range(ROUNDS):
        gap = at_b - at_a
        moved = np.where(gap == 0.0, b, b - at_b * (b - a) / np.where(gap == 0.0, 1.0, gap))
        # what is sharp stays, so that no run depends on its company
        last, x = x, np.where(sharp, x, moved)
        sharp |= np.abs(x - last) < SHARP
        if sharp.all():
            break
        value = f(x)
        turned = (value > 0.0) != (at_b > 0.0)
        a, at_a = np.where(turned, b, a), np.where(turned, at_b, 0.5 * at_a)
        b, at_b = x, value
    return np.asarray(x)
