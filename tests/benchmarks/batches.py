"""Many runs at once: lyapcheck beside CVODES through CasADi, and beside diffrax where it is installed."""

from importlib.util import find_spec

import numpy as np

from lyapcheck import load_robot, paper_gain_file, read_gain_file
from lyapcheck.simulate.many import simulate_many

from .by_hand import batch
from .measure import Disagreement, states_per_second

HEAD = ["way", "runs", "runs/s", "ratio", "difference"]
MEMBER, SEED = 2, 20190301
TOLERANCE = 1e-5
"""Of the final states: the ways control the error of a step, not of a path."""


def rows(runs=400, threads=2):
    """Runs of five seconds under the gains of Table 2 from random positions; all must end alike."""
    item = next(item for item in read_gain_file(paper_gain_file("table2")).gains if item.m == MEMBER)
    kp, kv = (np.array([float(k) for k in row]) for row in (item.kp, item.kv))
    starts = np.random.default_rng(SEED).uniform(-1, 1, (runs, item.n))
    model = load_robot("buap3")

    def ours(tolerance):
        moved = simulate_many(
            item, model, batch.GOAL, starts, batch.SECONDS, tolerance=tolerance, motions=True
        )
        return np.hstack([moved.q[:, -1], moved.w[:, -1]])

    exact = ours(1e-13)
    first = None
    ways = {"lyapcheck": lambda: ours(batch.RELATIVE), **dict(_cvodes(kp, kv, starts, threads))}
    for name, call in {**ways, **dict(_diffrax(kp, kv, starts))}.items():
        difference = float(np.max(np.abs(call() - exact)))
        if not difference < TOLERANCE:
            raise Disagreement(f"{name}: final states differ by {difference:.1e}")
        rate = states_per_second(call, runs, 3)
        first = first or rate
        yield [name, runs, f"{rate:.0f}", f"{rate / first:.3f}", f"{difference:.0e}"]


def _cvodes(kp, kv, starts, threads):
    for count in dict.fromkeys((1, threads)):
        call = batch.cvodes(MEMBER, kp, kv, len(starts), count)
        name = "CVODES, CasADi's `integrator` and `map`"
        yield name + (f", {count} threads" if count > 1 else ""), lambda call=call: call(starts)


def _diffrax(kp, kv, starts):
    if find_spec("diffrax") is not None:
        call = batch.diffrax(MEMBER, kp, kv)
        yield "diffrax, Dopri8, `jit` of `vmap`", lambda: call(starts)
