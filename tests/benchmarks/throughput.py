"""V and dV/dt at many states: lyapcheck, numba, CasADi as C and by itself, and a NumPy loop over states."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from dataclasses import dataclass
from importlib.util import find_spec
from typing import Any

import numpy as np

from lyapcheck import (
    GainSet,
    LyapunovNumeric,
    load_robot,
    lyapunov_graph,
    named_family,
    paper_gain_file,
    read_gain_file,
)

from . import generated_c, same_statements
from .by_hand import rates_loop
from .measure import Disagreement, states_per_second
from .results import RateResult

CASES = (("reyes-kelly2", "table2_shoulder_elbow"), ("buap3", "table2"))
MEMBER, EPS0, SEED = 2, 0.05, 20190301
TOLERANCE = 1e-9


@dataclass(frozen=True)
class Sizes:
    """How many states each way is given at a time: enough to reach its best rate."""

    lyapcheck: int = 400_000
    casadi: int = 20_000
    loop: int = 2_000


@dataclass(frozen=True)
class Way:
    """One way to the values: a name, how many of the states it treats, and the call."""

    name: str
    states: int
    call: Callable[[], Any]


def benchmark(sizes: Sizes | None = None, threads: int = 2) -> Iterator[RateResult]:
    """V and dV/dt on the arms of two and of three joints; all ways must give the same values."""
    chosen = sizes or Sizes()
    for robot, gains in CASES:
        sets = read_gain_file(paper_gain_file(gains)).gains
        item = next(item for item in sets if item.m == MEMBER)
        for function in ("V", "dV/dt"):
            yield _compared(function, item, robot, _ways(function, item, robot, chosen, threads))


def _compared(function: str, item: GainSet, robot: str, ways: list[Way]) -> RateResult:
    least = min(way.states for way in ways)
    values = [np.asarray(way.call()).ravel()[:least] for way in ways]
    scale = float(np.max(np.abs(values[0])))
    difference = max(float(np.max(np.abs(other - values[0]))) for other in values[1:]) / scale
    if not difference < TOLERANCE:
        raise Disagreement(f"{function} on {robot}: the ways differ by {difference:.1e}")
    rates = {way.name: states_per_second(way.call, way.states) for way in ways}
    return RateResult(function, robot, item.n, rates, difference)


def _ways(function: str, item: GainSet, robot: str, sizes: Sizes, threads: int) -> list[Way]:
    q, e, w = _states(sizes.lyapcheck, item.n)
    numeric, name = _numeric(item, robot, len(q))
    ours = numeric.V if function == "V" else numeric.rate
    few = sizes.loop
    loop = _loop(function, item, robot)
    return [
        Way(f"lyapcheck, {name}", len(q), lambda: ours(q, e, w)),
        *_numba(function, item, robot, (q, e, w)),
        *_casadi_c(function, item, robot, (q, e, w), threads),
        *_casadi(function, item, robot, tuple(x[: sizes.casadi] for x in (q, e, w)), threads),
        Way("NumPy, one state at a time", few, lambda: loop(q[:few], e[:few], w[:few])),
    ]


def _states(count: int, n: int) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    random = np.random.default_rng(SEED)
    q, e = random.uniform(-np.pi, np.pi, (count, n)), random.uniform(-2.5, 2.5, (count, n))
    return q, e, random.uniform(-3, 3, (count, n))


def _numeric(item: GainSet, robot: str, count: int) -> tuple[LyapunovNumeric, str]:
    """The batched evaluation, and what serves so many states on this machine."""
    kp, kv = [float(k) for k in item.kp], [float(k) for k in item.kv]
    numeric = LyapunovNumeric(load_robot(robot), _family(), kp, kv, EPS0)
    return numeric, {"compiled": "compiled loops", "numpy": "NumPy in blocks"}[numeric.engine(count)]


def _point(function: str, item: GainSet, robot: str) -> Any:
    """V or the printed (15) of one state as a CasADi function, gains built in."""
    import casadi as ca

    graph, n = lyapunov_graph(load_robot(robot), _family()), item.n
    symbols = [ca.SX.sym(name, n) for name in "qew"]
    gains = [ca.DM([float(k) for k in item.kp]), ca.DM([float(k) for k in item.kv]), EPS0]
    whole = graph.V if function == "V" else graph.rate_15
    return ca.Function("point", symbols, [whole(*symbols, *gains)])


def _casadi(function: str, item: GainSet, robot: str, states: tuple[Any, ...], threads: int) -> Iterator[Way]:
    """`Function.map` on one thread and on several.

    The states are already CasADi matrices when the clock starts, and the result stays one.
    """
    import casadi as ca

    point = _point(function, item, robot)
    count, columns = len(states[0]), [ca.DM(np.ascontiguousarray(x.T)) for x in states]
    for name, mapped in (
        ("CasADi `map`", point.map(count)),
        (f"CasADi `map`, {threads} threads", point.map(count, "thread", threads)),
    ):
        yield Way(name, count, lambda mapped=mapped: mapped(*columns))


def _casadi_c(
    function: str, item: GainSet, robot: str, states: tuple[Any, ...], threads: int
) -> Iterator[Way]:
    """CasADi's generated C, where there is a compiler."""
    if generated_c.COMPILER is not None:
        call = generated_c.loop(_point(function, item, robot), item.n, threads)
        name = f"CasADi's C, `-Ofast`, {threads} threads"
        yield Way(name, len(states[0]), lambda: call(*states))


def _numba(function: str, item: GainSet, robot: str, states: tuple[Any, ...]) -> Iterator[Way]:
    """Loops over states in numba, where it is installed (`make bench` does)."""
    if find_spec("numba") is not None:
        from .by_hand import rates_numba

        kp, kv = np.array([float(k) for k in item.kp]), np.array([float(k) for k in item.kv])
        values, rates = rates_numba.loops(robot, MEMBER, kp, kv, EPS0)
        call = values if function == "V" else rates
        yield Way("numba, parallel, fastmath", len(states[0]), lambda: call(*states))
        kept, _ = _numeric(item, robot, len(states[0]))
        same = same_statements.numba_loop(kept, "value" if function == "V" else "rate")
        yield Way("numba, the same statements", len(states[0]), lambda: same(*states))


def _loop(function: str, item: GainSet, robot: str) -> Callable[..., Any]:
    kp, kv = np.array([float(k) for k in item.kp]), np.array([float(k) for k in item.kv])
    if function == "V":
        return lambda q, e, w: rates_loop.values(robot, MEMBER, kp, EPS0, q, e, w)
    return lambda q, e, w: rates_loop.rates(robot, MEMBER, kp, kv, EPS0, q, e, w)


def _family() -> Any:
    return named_family("hyperbolic", MEMBER)
