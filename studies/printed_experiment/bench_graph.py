"""Runs on the bench by CasADi, one after the other: the fallback where nothing can be compiled."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace
from functools import lru_cache
from typing import Any

import casadi as ca
import numpy as np

from lyapcheck._types import Array
from lyapcheck.family import Family
from lyapcheck.family.arithmetic import graphs
from lyapcheck.robots import RobotModel
from studies.printed_experiment.bench_step import BenchStep, parameter_count


class GraphBench:
    """The bench for one arm, family and period, in the steps of `bench.c`; `graph_bench` makes one."""

    def __init__(self, whole: Callable[[int], Any], n: int, period: float) -> None:
        self._whole, self._n, self._period = whole, n, period

    def __call__(self, starts: Array, parameters: Array, periods: int) -> Array:
        """(R, periods + 1, 3n) q, w, τ from starts (R, 2n) and parameters (R, p)."""
        n, whole = self._n, self._whole(periods)
        out = np.empty((len(starts), periods + 1, 3 * n))
        for run, (start, numbers) in enumerate(zip(starts, parameters, strict=True)):
            before = start[:n] - self._period * start[n:]
            states, torques = whole(np.concatenate([start, before]), numbers)
            out[run, 0, : 2 * n] = start
            out[run, 1:, : 2 * n] = np.asarray(states).T[:, : 2 * n]
            out[run, :-1, 2 * n :] = np.asarray(torques).T
            out[run, -1, 2 * n :] = out[run, -2, 2 * n :]
        return out


@lru_cache(maxsize=32)
def graph_bench(model: RobotModel, family: Family, period: float, substeps: int, sweeps: int) -> GraphBench:
    """The bench as a graph."""
    n, of = model.n, replace(graphs(), lift=lambda x: ca.SX(float(x)))
    state, numbers = ca.SX.sym("state", 3 * n), ca.SX.sym("numbers", parameter_count(model))
    step = BenchStep(model, of, lambda x: family.casadi(x).h, ca.vertsplit(numbers), period, sweeps)
    q, w, last = (ca.vertsplit(state[i * n : (i + 1) * n]) for i in range(3))
    torque, readings = step.controller(q, last)
    for _ in range(substeps):
        q, w = step.move(q, w, torque, period / substeps)
    moved = ca.Function("period", [state, numbers], [ca.vertcat(*q, *w, *readings), ca.vertcat(*torque)])

    @lru_cache(maxsize=4)
    def whole(periods: int) -> Any:
        start, same = ca.MX.sym("start", 3 * n), ca.MX.sym("same", numbers.shape[0])
        states, torques = moved.mapaccum(periods)(start, ca.repmat(same, 1, periods))
        return ca.Function("bench", [start, same], [states, torques])

    return GraphBench(whole, n, period)
