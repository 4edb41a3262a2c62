"""V and dV/dt at many states: lyapcheck, numba, and CasADi as C and by itself."""

from importlib.util import find_spec

import numpy as np

from lyapcheck import (
    LyapunovNumeric,
    load_robot,
    lyapunov_graph,
    named_family,
    paper_gain_file,
    read_gain_file,
)

from . import generated_c
from .measure import Disagreement, states_per_second

CASES = (("reyes-kelly2", "table2_shoulder_elbow"), ("buap3", "table2"))
MEMBER, EPS0, SEED = 2, 0.05, 20190301
TOLERANCE = 1e-9


HEAD = ["function", "arm", "way", "states/s", "ratio", "largest difference"]
STATES = 400_000


def rows(count=STATES, threads=2):
    """V and dV/dt on the arms of two and of three joints; all ways must give the same values."""
    for robot, gains in CASES:
        item = next(item for item in read_gain_file(paper_gain_file(gains)).gains if item.m == MEMBER)
        for function in ("V", "dV/dt"):
            yield from compared(function, robot, dict(_ways(function, item, robot, count, threads)), count)


def compared(function, robot, ways, count):
    """The rates of some ways, the first of which is lyapcheck's, and how far their values differ."""
    ours, *others = (np.asarray(call()).ravel() for call in ways.values())
    difference = max(float(np.max(np.abs(other - ours))) for other in others) / float(np.max(np.abs(ours)))
    if not difference < TOLERANCE:
        raise Disagreement(f"{function} on {robot}: the ways differ by {difference:.1e}")
    rates = {name: states_per_second(call, count) for name, call in ways.items()}
    best = next(iter(rates.values()))
    for name, rate in rates.items():
        yield [function, robot, name, f"{rate:.2e}", f"{rate / best:.4f}", f"{difference:.0e}"]


def _ways(function, item, robot, count, threads):
    q, e, w = _states(count, item.n)
    numeric, name = _numeric(item, robot, count)
    ours = numeric.V if function == "V" else numeric.rate
    yield f"lyapcheck, {name}", lambda: ours(q, e, w)
    if find_spec("numba") is not None:  # `make bench` installs it
        from .by_hand import rates_numba

        kp, kv = (np.array([float(k) for k in row]) for row in (item.kp, item.kv))
        loops = dict(zip(("V", "dV/dt"), rates_numba.loops(robot, MEMBER, kp, kv, EPS0), strict=True))
        yield "numba, parallel, fastmath", lambda: loops[function](q, e, w)
    if generated_c.COMPILER is not None:
        call = generated_c.loop(_point(function, item, robot), item.n, threads)
        yield f"CasADi's C, `-Ofast`, {threads} threads", lambda: call(q, e, w)
    mapped = _point(function, item, robot).map(count, "thread", threads)
    yield f"CasADi `map`, {threads} threads", lambda: mapped(*(np.ascontiguousarray(x.T) for x in (q, e, w)))


def _states(count, n):
    random = np.random.default_rng(SEED)
    q, e = random.uniform(-np.pi, np.pi, (count, n)), random.uniform(-2.5, 2.5, (count, n))
    return q, e, random.uniform(-3, 3, (count, n))


def _numeric(item, robot, count):
    """The batched evaluation, and what serves so many states on this machine."""
    kp, kv = [float(k) for k in item.kp], [float(k) for k in item.kv]
    numeric = LyapunovNumeric(load_robot(robot), _family(), kp, kv, EPS0)
    return numeric, {"compiled": "compiled loops", "numpy": "NumPy in blocks"}[numeric.engine(count)]


def _point(function, item, robot):
    """V or the printed (15) of one state as a CasADi function, gains built in."""
    import casadi as ca

    graph, n = lyapunov_graph(load_robot(robot), _family()), item.n
    symbols = [ca.SX.sym(name, n) for name in "qew"]
    gains = [ca.DM([float(k) for k in item.kp]), ca.DM([float(k) for k in item.kv]), EPS0]
    whole = graph.V if function == "V" else graph.rate_15
    return ca.Function("point", symbols, [whole(*symbols, *gains)])


def _family():
    return named_family("hyperbolic", MEMBER)
