"""Many initial value problems of (11) at once, by the method of Dormand and Prince of order 8(5, 3).

All runs under way take a step together, each of its own size; one that has ended leaves. Sums over stages are
taken term by term, so that the bits of a run do not depend on its company.

References: ``hairer1993solving``, Section II.5; the coefficients are those of SciPy's DOP853.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray
from scipy.integrate import DOP853 as TABLE

from lyapcheck._types import Array
from lyapcheck.simulate.seen import RightSide, Seen, Step

Counts = NDArray[np.int32]
TOO_MANY_STEPS, STEP_TOO_SMALL, OUT_OF_RANGE = 1, 2, 3
FAILURES = (
    "",
    "the steps allowed were not enough",
    "the step became too small",
    "the state left every sensible range",
)
"""What a status means; 0 is a run that reached its end."""
LARGEST = 1e15
"""Of a state: beyond it squares come near the ends of the doubles."""


class March:
    """Many runs of (11) on one arm with one family, those under way as columns.

    Args:
        side: arm and family.
        y0: (R, 2n + 2) q, w, dissipated energy, ∫‖e‖².
        parameters: (R, p) as `RightSide` has them.
        bands: (R, n) rad, of the settling times.
        T: s.
        points: samples at even times from 0 to T, at least 2.
        tolerance: relative error allowed per step; the absolute one is a hundredth of it.
        max_steps: a budget for each run.

    Attributes:
        path: (R, points, 2n + 2) the samples, NaN from where a run failed.
        found: (R, 3n + 1) the largest |τ_i|, N·m, and what `Seen.columns` has; NaN where a run failed.
        status: (R,) an index of `FAILURES`.
        steps: (R,) steps tried.
    """

    def __init__(
        self,
        side: RightSide,
        y0: Array,
        parameters: Array,
        bands: Array,
        T: float,
        points: int,
        tolerance: float,
        max_steps: int,
    ) -> None:
        runs, size = y0.shape
        self.side, self.T, self.tolerance, self.max_steps = side, T, tolerance, max_steps
        self.times = T * np.arange(points) / (points - 1)
        self.path, self.found = np.full((runs, points, size), np.nan), np.full((runs, 3 * side.n + 1), np.nan)
        self.path[:, 0] = y0
        self.status: Counts = np.zeros(runs, np.int32)
        self.steps: Counts = np.zeros(runs, np.int32)
        self.who = np.arange(runs)
        self.p, self.y = np.ascontiguousarray(parameters.T), np.array(y0.T, order="C")
        self.t, self.sample, self.stopped_short = np.zeros(runs), np.ones(runs, int), np.zeros(runs, bool)
        self.k = np.empty((16, size, runs))
        with np.errstate(all="ignore"):
            side.rate(self.y, self.p, out=self.k[0])
            scale = tolerance * (0.01 + np.abs(self.y))
            far, fast = (np.sqrt(np.mean((x / scale) ** 2, axis=0)) for x in (self.y, self.k[0]))
            tiny = (far < 1e-5) | (fast < 1e-5)
            self.h = np.minimum(np.where(tiny, 1e-6, 0.01 * far / fast), T)
            self.seen = Seen(side, self.y, self.p, np.ascontiguousarray(bands.T))
            while self.who.size:
                self._step()
            reached = self.status == 0
            self.found[reached, : side.n] = self.seen.peaks.largest()[:, reached].T

    def _step(self) -> None:
        """One step of every run, with the size each of them wants."""
        for stage in range(1, 12):
            self._stage(stage, TABLE.A[stage, :stage])
        new = self.y + self.h * self._sum(TABLE.B)
        self.side.rate(new, self.p, out=self.k[12])
        scale = self.tolerance * (0.01 + np.maximum(np.abs(self.y), np.abs(new)))
        fifth, third = (np.sum((self._sum(row) / scale) ** 2, axis=0) for row in (TABLE.E5, TABLE.E3))
        both = np.sqrt((fifth + 0.01 * third) * len(new))
        error = np.where(both == 0.0, 0.0, self.h * fifth / both)  # at most 1 within the tolerance
        good = error < 1.0
        if good.any():
            step = Step(self.t, self.h, self.y, new, self._dense(new), self.p)
            step = step if good.all() else step.of(good)
            self._write(step, np.flatnonzero(good))
            self.seen.look(step, good)
        self.t = np.where(good, self.t + self.h, self.t)
        np.copyto(self.y, new, where=good)
        np.copyto(self.k[0], self.k[12], where=good)
        most = np.where(good & ~self.stopped_short, 10.0, 1.0)
        wanted = np.where(error < np.inf, 0.9 / np.maximum(error, 1e-300) ** 0.125, 0.2)
        following = self.h * np.maximum(0.2, np.minimum(wanted, most))
        left = self.T - self.t
        self.h = np.where(left - following < 1e-12 * self.T, left, np.minimum(following, left))
        self.stopped_short = ~good
        self.steps[self.who] += 1
        self._settle(following)

    def _sum(self, weights: Array) -> Array:
        """Σ weight_j k_j."""
        total: Array = np.einsum("s,sdr->dr", weights, self.k[: len(weights)])
        return total

    def _stage(self, number: int, weights: Array) -> None:
        self.side.rate(self.y + self.h * self._sum(weights), self.p, out=self.k[number])

    def _dense(self, new: Array) -> Array:
        """The coefficients of the polynomial of degree 7 between the two ends of the step, (7, d, R)."""
        for extra, weights in enumerate(TABLE.A_EXTRA):
            self._stage(13 + extra, weights[: 13 + extra])
        rise = new - self.y
        low = [rise, self.h * self.k[0] - rise, 2.0 * rise - self.h * (self.k[12] + self.k[0])]
        return np.stack([*low, *(self.h * self._sum(row) for row in TABLE.D)])

    def _write(self, step: Step, chosen: NDArray[np.intp]) -> None:
        """The samples within the step, for the runs whose step is good."""
        first = self.sample[chosen]
        end = step.t + step.h + 1e-14 * self.T
        due = np.searchsorted(self.times, end, "right") - first
        if not (due > 0).any():
            return
        at = np.repeat(np.arange(chosen.size), due)
        count = np.arange(at.size) - np.repeat(np.cumsum(due) - due, due)
        sample = first[at] + count
        x = (self.times[sample] - step.t[at]) / step.h[at]
        self.path[self.who[chosen[at]], sample] = step.curve(at)(x).T
        self.sample[chosen] += due

    def _settle(self, following: Array) -> None:
        """Let go of the runs that are done, and of those that cannot go on."""
        bad = ~np.all(np.abs(self.y) <= LARGEST, axis=0)
        status = np.select(
            [bad, self.steps[self.who] >= self.max_steps, ~(following > 1e-15 * self.T)],
            [OUT_OF_RANGE, TOO_MANY_STEPS, STEP_TOO_SMALL],
        )
        done = self.sample == self.times.size
        over = done | (status != 0)
        if not over.any():
            return
        self.status[self.who[over]] = np.where(done & ~bad, 0, status)[over]
        reached = done & ~bad
        self.found[self.who[reached], self.side.n :] = self.seen.columns(reached).T
        on = ~over
        self.seen.keep(on)
        for name in ("who", "t", "h", "sample", "stopped_short"):
            setattr(self, name, getattr(self, name)[on])
        self.p, self.y, rate = (np.compress(on, x, axis=1) for x in (self.p, self.y, self.k[0]))
        self.k = np.empty((16, *rate.shape))
        self.k[0] = rate
