"""Runs on the bench by NumPy, all at once: the fallback where nothing can be compiled."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from lyapcheck.compiled.plain_arrays import PlainArrays
from lyapcheck.family import Family
from lyapcheck.robots import RobotModel
from lyapcheck.sensitivity.bench_step import BenchStep
from lyapcheck.simulate.batch_numpy import array_forms

Array = NDArray[np.float64]


class NumpyBench:
    """The bench for one arm, one family and one period, in the steps of `bench.c`."""

    def __init__(self, model: RobotModel, family: Family, period: float, substeps: int, sweeps: int) -> None:
        self._model, self._family = model, family
        self._period, self._substeps, self._sweeps = period, substeps, sweeps

    def __call__(self, starts: Array, parameters: Array, periods: int) -> Array:
        """(R, periods + 1, 3n) q, w, τ from starts (R, 2n) and parameters (R, p)."""
        runs, n, T = len(starts), self._model.n, self._period
        step = BenchStep(
            self._model, PlainArrays(), array_forms(self._family), list(parameters.T), T, self._sweeps
        )
        q, w = list(starts.T[:n]), list(starts.T[n:])
        last = [x - T * v for x, v in zip(q, w, strict=True)]
        out = np.empty((runs, periods + 1, 3 * n))
        with np.errstate(all="ignore"):
            for k in range(periods):
                torque, last = step.controller(q, last)
                out[:, k] = np.stack([*q, *w, *torque], axis=1)
                for _ in range(self._substeps):
                    q, w = step.move(q, w, torque, T / self._substeps)
        out[:, periods] = np.stack([*q, *w, *torque], axis=1)
        return out
