"""Many runs at once: lyapcheck beside CVODES through CasADi, and beside diffrax where it is installed."""

from __future__ import annotations

from collections.abc import Iterator
from importlib.util import find_spec
from typing import Any

import numpy as np

from lyapcheck import load_robot, paper_gain_file, read_gain_file
from lyapcheck.simulate.batch import simulate_many

from .by_hand import batch
from .measure import Disagreement, states_per_second
from .results import RunsResult
from .throughput import Way

MEMBER, SEED = 2, 20190301
TOLERANCE = 1e-5
"""Of the final states: the ways control the error of a step, not of a path."""


def benchmark(runs: int = 400, threads: int = 2) -> Iterator[RunsResult]:
    """Runs of five seconds under the gains of Table 2 from random positions; all must end alike."""
    item = next(item for item in read_gain_file(paper_gain_file("table2")).gains if item.m == MEMBER)
    kp, kv = (np.array([float(k) for k in row]) for row in (item.kp, item.kv))
    starts = np.random.default_rng(SEED).uniform(-1, 1, (runs, item.n))
    model = load_robot("buap3")

    def ours(tolerance: float) -> Any:
        moved = simulate_many(
            item, model, batch.GOAL, starts, batch.SECONDS, tolerance=tolerance, motions=True
        )
        return np.hstack([moved.q[:, -1], moved.w[:, -1]])

    exact = ours(1e-13)
    for way in [
        Way("lyapcheck", runs, lambda: ours(batch.RELATIVE)),
        *_cvodes(kp, kv, starts, threads),
        *_diffrax(kp, kv, starts),
    ]:
        difference = float(np.max(np.abs(way.call() - exact)))
        if not difference < TOLERANCE:
            raise Disagreement(f"{way.name}: final states differ by {difference:.1e}")
        yield RunsResult(way.name, runs, states_per_second(way.call, runs, 3), difference)


def _cvodes(kp: np.ndarray, kv: np.ndarray, starts: np.ndarray, threads: int) -> Iterator[Way]:
    for count in dict.fromkeys((1, threads)):
        call = batch.cvodes(MEMBER, kp, kv, len(starts), count)
        name = "CVODES, CasADi's `integrator` and `map`"
        yield Way(
            name + (f", {count} threads" if count > 1 else ""), len(starts), lambda call=call: call(starts)
        )


def _diffrax(kp: np.ndarray, kv: np.ndarray, starts: np.ndarray) -> Iterator[Way]:
    if find_spec("diffrax") is not None:
        call = batch.diffrax(MEMBER, kp, kv)
        yield Way("diffrax, Dopri8, `jit` of `vmap`", len(starts), lambda: call(starts))
