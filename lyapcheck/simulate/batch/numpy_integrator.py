"""The batch of runs integrated by NumPy, all runs at once, each with its own steps."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from lyapcheck._types import Array
from lyapcheck.compiled.columns import ColumnForms
from lyapcheck.compiled.forms import PlainForms, has_plain_forms
from lyapcheck.compiled.plain_arrays import PlainArrays
from lyapcheck.family import Family
from lyapcheck.lyapunov.along import Forms
from lyapcheck.robots import RobotModel
from lyapcheck.simulate.batch import dop853
from lyapcheck.simulate.batch.dop853 import Weights
from lyapcheck.simulate.batch.extremes import Seen, StepPart
from lyapcheck.simulate.batch.integrator import (
    OUT_OF_RANGE,
    STEP_TOO_SMALL,
    TOO_MANY_STEPS,
    InitialValueProblems,
    Paths,
    empty_paths,
)
from lyapcheck.simulate.batch.loop import LoopColumns

Whole = NDArray[np.int64]

_LARGEST = 1e15


def array_forms(family: Family) -> Forms:
    """The formulas of the compiled integrator on arrays, or the accurate ones where it has none."""
    return PlainForms(PlainArrays(), family) if has_plain_forms(family) else ColumnForms(family)


class NumpyRuns:
    """The integrator for one arm and one family, in the steps of `batch.c`."""

    name = "numpy"

    def __init__(self, model: RobotModel, family: Family) -> None:
        self._model, self._forms = model, array_forms(family)

    def __call__(self, problems: InitialValueProblems) -> Paths:
        """Integrate every run to T."""
        paths = empty_paths(problems)
        paths.y.fill(np.nan)
        paths.y[:, 0] = problems.y0
        paths.steps.fill(0)
        with np.errstate(all="ignore"):
            march = _March(self, problems, paths)
            while march.who.size:
                march.step()
        return paths

    def rate(self, y: Array, parameters: Array) -> Array:
        """ẏ of columns y (d, R) with parameters (p, R)."""
        return np.stack(self._loop(parameters).rate(list(y)))

    def watched(self, y: Array, parameters: Array) -> Array:
        """(n + 1, R) |τ_i| and V."""
        values = self._loop(parameters).watched(list(y))
        return np.stack([np.broadcast_to(x, y.shape[1:]) for x in values])

    def _loop(self, parameters: Array) -> LoopColumns:
        return LoopColumns(self._model, self._forms, list(parameters))


class _March:
    """The runs that are still under way, as columns."""

    def __init__(self, engine: NumpyRuns, problems: InitialValueProblems, paths: Paths) -> None:
        self.engine, self.paths = engine, paths
        self.T, self.tolerance, self.max_steps = problems.T, problems.tolerance, problems.max_steps
        runs, points = len(problems.y0), problems.points
        self.times = self.T * np.arange(points) / (points - 1)
        self.who: Whole = np.arange(runs)
        self.p, self.y = problems.parameters.T.copy(), problems.y0.T.copy()
        self.rate = engine.rate(self.y, self.p)
        self.t, self.sample, self.rejected = np.zeros(runs), np.ones(runs, int), np.zeros(runs, bool)
        self.h = self._first_step()
        self.seen = Seen(engine.watched, self.y, self.p, problems.bands.T)

    def step(self) -> None:
        """One step of every run, with the size each of them wants."""
        k, new = self._stages()
        error = self._error(k, new)
        good = error < 1.0
        if good.any():
            part = StepPart(self.t, self.h, self.y, new, self._between(k, new), self.p).of(good)
            self._write(part, good)
            self.seen.look(part, good)
        self.t = np.where(good, self.t + self.h, self.t)
        self.y, self.rate = np.where(good, new, self.y), np.where(good, k[12], self.rate)
        most = np.where(good & ~self.rejected, 10.0, 1.0)
        wanted = np.where(error < np.inf, 0.9 / np.maximum(error, 1e-300) ** 0.125, 0.2)
        following = self.h * np.maximum(0.2, np.minimum(wanted, most))
        left = self.T - self.t
        self.h = np.where(left - following < 1e-12 * self.T, left, np.minimum(following, left))
        self.rejected = ~good
        self.paths.steps[self.who] += 1
        self._settle(following)

    def _stages(self) -> tuple[list[Array], Array]:
        k = [self.rate]
        for weights in dop853.STAGES:
            k.append(self._rate(k, weights))
        new = self.y + self.h * _sum(weights=dop853.STEP, k=k)
        return [*k, self.engine.rate(new, self.p)], new

    def _rate(self, k: list[Array], weights: Weights) -> Array:
        return self.engine.rate(self.y + self.h * _sum(weights, k), self.p)

    def _error(self, k: list[Array], new: Array) -> Array:
        """The error of the step, at most 1 if it is within the tolerance."""
        scale = self.tolerance * (0.01 + np.maximum(np.abs(self.y), np.abs(new)))
        fifth, third = (
            np.sum((_sum(row, k) / scale) ** 2, axis=0) for row in (dop853.ERROR_5, dop853.ERROR_3)
        )
        both = np.sqrt((fifth + 0.01 * third) * len(new))
        return np.asarray(np.where(both == 0.0, 0.0, self.h * fifth / both))

    def _write(self, part: StepPart, good: NDArray[np.bool_]) -> None:
        """The samples within the step, for the runs whose step is good."""
        chosen, end = np.flatnonzero(good), self.t + self.h + 1e-14 * self.T
        while (due := self._before(end)[chosen]).any():
            runs, at = chosen[due], np.flatnonzero(due)
            x = (self.times[self.sample[runs]] - self.t[runs]) / self.h[runs]
            self.paths.y[self.who[runs], self.sample[runs]] = part.at(x, at).T
            self.sample[runs] += 1

    def _before(self, end: Array) -> NDArray[np.bool_]:
        last = self.times.size - 1
        return np.asarray((self.sample <= last) & (self.times[np.minimum(self.sample, last)] <= end))

    def _between(self, k: list[Array], new: Array) -> Array:
        """The coefficients of the polynomial between the two ends of the step, (7, d, R)."""
        for weights in dop853.EXTRA:
            k.append(self._rate(k, weights))
        rise = new - self.y
        low = [rise, self.h * k[0] - rise, 2.0 * rise - self.h * (k[12] + k[0])]
        return np.stack([*low, *(self.h * _sum(row, k) for row in dop853.DENSE)])

    def _settle(self, following: Array) -> None:
        """Let go of the runs that are done, and of those that cannot go on."""
        bad = ~np.all(np.abs(self.y) <= _LARGEST, axis=0)
        status = np.select(
            [bad, self.paths.steps[self.who] >= self.max_steps, ~(following > 1e-15 * self.T)],
            [OUT_OF_RANGE, TOO_MANY_STEPS, STEP_TOO_SMALL],
        )
        done = self.sample == self.times.size
        self.paths.status[self.who] = np.where(done & ~bad, 0, status)
        self.paths.seen[self.who] = np.where(done & ~bad, self.seen.columns(), np.nan).T
        on = ~done & (status == 0)
        self.seen.keep(on)
        for name in ("who", "t", "h", "sample", "rejected"):
            setattr(self, name, getattr(self, name)[on])
        for name in ("p", "y", "rate"):
            setattr(self, name, getattr(self, name)[:, on])

    def _first_step(self) -> Array:
        scale = self.tolerance * (0.01 + np.abs(self.y))
        size, speed = (np.sqrt(np.mean((x / scale) ** 2, axis=0)) for x in (self.y, self.rate))
        tiny = (size < 1e-5) | (speed < 1e-5)
        return np.minimum(np.where(tiny, 1e-6, 0.01 * size / speed), self.T)


def _sum(weights: Weights, k: list[Array]) -> Array:
    """Σ weight_j k_j."""
    (first, weight), *rest = weights.items()
    total = weight * k[first]
    for j, weight in rest:
        total += weight * k[j]
    return total
