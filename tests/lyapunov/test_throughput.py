"""Compiled V and dV/dt: as accurate as the arrays, on every state, and far faster than CasADi."""

from __future__ import annotations

from pathlib import Path
from types import SimpleNamespace

import casadi as ca
import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from lyapcheck import family, robots
from lyapcheck.compiled import straight_line, threads
from lyapcheck.compiled.compiler import OFF, compiler
from lyapcheck.compiled.state_map import state_map
from lyapcheck.compiled.straight_line import StraightLine
from lyapcheck.lyapunov import numeric as numeric_module
from lyapcheck.lyapunov.along import LyapunovFunction
from lyapcheck.lyapunov.graph import lyapunov_graph
from lyapcheck.lyapunov.numeric import LARGE, LyapunovNumeric
from lyapcheck.robots.numeric import NumericModel
from tests.helpers.shares import one_in

KP, KV, EPS0 = (25.0, 50.0, 5.0), (0.25, 0.5, 0.125), 0.375
EXPECTED = "numpy" if compiler() is None else "compiled"
ARMS = ("pendulum1", "reyes-kelly2", "buap3")
FAMILIES = [family.hyperbolic(m) for m in (1, 2, 3, 7, 64)] + [
    family.tanh(),
    family.arctan(),
    family.algebraic(),
    family.linear(),
]


def lyapunov(arm: str, shape: family.Family) -> LyapunovNumeric:
    model = robots.load(arm)
    return LyapunovNumeric(model, shape, KP[: model.n], KV[: model.n], EPS0)


def states(n: int, count: int, size: float = 1.0, seed: int = 5) -> list[np.ndarray]:
    random = np.random.default_rng(seed)
    return [scale * size * random.standard_normal((count, n)) for scale in (3, 2, 4)]


def extreme_states(n: int, count: int) -> list[np.ndarray]:
    """Sizes from the smallest doubles to 1e3, zeros among them."""
    random = np.random.default_rng(6)
    sizes = [
        0.0,
        5e-324,
        1e-300,
        1e-160,
        1e-20,
        1e-8,
        1e-3,
        0.5,
        0.88,
        0.8813735870195430,
        0.8814,
        3,
        40,
        710,
    ]
    pool = np.array([*sizes, 1e3])
    columns = [random.choice(pool, (count, n)) * random.choice([-1, 1], (count, n)) for _ in range(3)]
    return [columns[0] * 90, *columns[1:]]


def by_arrays(kept: LyapunovNumeric, name: str, *columns: np.ndarray) -> np.ndarray:
    """The NumPy form, whatever the size of the batch."""
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(numeric_module, "LARGE", 10**9)
        return getattr(kept, name)(*columns)


def term_sizes(kept: LyapunovNumeric, q: np.ndarray, e: np.ndarray, w: np.ndarray) -> tuple:
    """The sums of the absolute terms of V and of dV/dt."""
    model, shape = NumericModel(kept.model), kept.family
    r = np.linalg.norm(e, axis=1, keepdims=True)
    eps, h, hw = EPS0 / (1 + r), abs(shape.h(e)), abs(shape.h(w))
    M, C = abs(model.mass(q)), abs(model.coriolis(q, shape.h(e)))
    y = abs(w) + eps * h
    e_hat = abs(e) / np.where(r > 0, r, 1)
    Mh = np.einsum("sij,sj->si", M, h)
    S = C + Mh[:, :, None] * e_hat[:, None] / (1 + r)[:, :, None] + M * abs(shape.dh(e))[:, None]
    damped = np.array(kept.viscous) * abs(w) + np.array(kept.kv) * hw
    push = damped + eps * np.einsum("sij,sj->si", S, abs(w))
    V = 0.5 * np.einsum("si,sij,sj->s", y, M, y) + shape.potential(e) @ kept.kp
    return V, (eps[:, 0] * (h * h @ kept.kp) + np.sum(y * push, axis=1))


@pytest.fixture
def few(monkeypatch):
    """A batch counts as large from here on."""
    monkeypatch.setattr(numeric_module, "LARGE", 1000)
    return 1000


@pytest.mark.parametrize("shape", FAMILIES, ids=lambda f: f"{f.name}{f.m or ''}")
@pytest.mark.parametrize("arm", one_in(3, ARMS))
@pytest.mark.parametrize("make", [states, extreme_states])
def test_compiled_and_arrays_agree(arm, shape, make, few):
    kept = lyapunov(arm, shape)
    columns = make(kept.model.n, few)
    assert kept.engine(few) == EXPECTED
    for name, size in zip(("V", "rate"), term_sizes(kept, *columns), strict=True):
        compiled, arrays = getattr(kept, name)(*columns), by_arrays(kept, name, *columns)
        assert np.all(np.isfinite(compiled))
        assert np.all(abs(compiled - arrays) <= 1e-12 * size + 1e-290)


@pytest.mark.parametrize("m", one_in(3, [2, 1, 3]))
@pytest.mark.parametrize("arm", ["reyes-kelly2", "buap3"])
def test_compiled_agrees_with_the_casadi_graph(arm, m):
    kept = lyapunov(arm, family.hyperbolic(m))
    n, graph = kept.model.n, lyapunov_graph(kept.model, kept.family)
    columns = states(n, LARGE + 1)
    sizes = term_sizes(kept, *columns)
    gains = [*(np.array(k[:n]) for k in (KP, KV)), EPS0]
    for name, function, size in zip(("V", "rate"), (graph.V, graph.rate), sizes, strict=True):
        values = getattr(kept, name)(*columns)
        for k in (0, 1, 63, 64, 20_000, LARGE):
            exact = float(function(*[x[k] for x in columns], *gains))
            assert abs(values[k] - exact) <= 1e-12 * size[k]


@pytest.mark.parametrize("bad", [np.nan, np.inf, -np.inf, 1e16, 1e300])
@pytest.mark.parametrize("which", [0, 1, 2])
def test_states_beyond_the_compiled_range_get_the_arrays_answer(bad, which, few):
    kept = lyapunov("reyes-kelly2", family.hyperbolic(2))
    columns = states(2, few)
    columns[which][345, 1] = bad
    with np.errstate(all="ignore"):
        for name in ("V", "rate"):
            assert np.array_equal(
                getattr(kept, name)(*columns), by_arrays(kept, name, *columns), equal_nan=True
            )


def test_small_batches_do_not_depend_on_a_compiler():
    """What reports print comes from small batches: the same bytes with and without a compiler."""
    kept = lyapunov("buap3", family.hyperbolic(3))
    columns = states(3, 2001)
    assert kept.engine(2001) == "numpy"
    assert np.array_equal(kept.rate(*columns), by_arrays(kept, "rate", *columns))


def test_shapes_are_broadcast():
    kept = lyapunov("reyes-kelly2", family.hyperbolic(2))
    q, e, _ = (x.reshape(2, -1, 2) for x in states(2, 2 * LARGE))
    values = kept.V(q, e, np.zeros(2))
    assert values.shape == q.shape[:-1]
    assert values[1, 7] == pytest.approx(float(kept.V(q[1, 7], e[1, 7], np.zeros(2))), rel=1e-13)


def test_without_a_compiler_numpy_serves_everything(monkeypatch):
    monkeypatch.setenv(OFF, "1")
    numeric_module._compiled.cache_clear()
    kept = lyapunov("reyes-kelly2", family.hyperbolic(1))
    columns = states(2, LARGE)
    assert kept.engine() == "numpy"
    assert np.array_equal(kept.V(*columns), by_arrays(kept, "V", *columns))
    numeric_module._compiled.cache_clear()


ELEMENTARY = {
    "sine": (np.sin, -1e5, 1e5),
    "cosine": (np.cos, -1e5, 1e5),
    "exp_of_negative": (lambda a: np.exp(-a), 0, 699),
    "one_minus_exp": (lambda a: -np.expm1(-a), 0, 50),
    "log_one_plus": (np.log1p, -0.2, 1),
}


@pytest.mark.parametrize("name", ELEMENTARY)
@given(data=st.data())
def test_elementary_functions_are_right_to_the_last_places(name, data):
    truth, low, high = ELEMENTARY[name]
    x = np.array(data.draw(st.lists(st.floats(low, high), min_size=1, max_size=70)))
    kernel = state_map(lambda code, q, e, w, p: [code.call(name, q[0])], 1, 1, 1)
    assert (kernel is None) == (compiler() is None)
    if kernel is not None:
        states = x.reshape(1, -1, 1)
        values = kernel(states, states, states, np.zeros((1, 1)))[0, :, 0]
        # sines near the zeros of a large argument carry the rounding of the reduction, some 1e-17
        near_zero = 4e-17 if name in ("sine", "cosine") else 0
        assert np.all(abs(values - truth(x)) <= 4 * np.spacing(abs(truth(x))) + near_zero)


def test_too_long_a_formula_is_left_to_arrays(monkeypatch, few):
    monkeypatch.setattr(straight_line, "MOST_STATEMENTS", 20)
    numeric_module._compiled.cache_clear()
    kept = lyapunov("reyes-kelly2", family.hyperbolic(2))
    assert kept.engine(few) == "numpy"
    numeric_module._compiled.cache_clear()


@pytest.mark.slow
def test_six_joints_agree_too():
    model = robots.load(str(Path(__file__).parents[2] / "examples" / "ur5.urdf"))
    kept = LyapunovNumeric(model, family.hyperbolic(2), KP + KP, KV + KV, EPS0)
    columns = states(6, LARGE)
    assert kept.engine() == EXPECTED
    for name, size in zip(("V", "rate"), term_sizes(kept, *columns), strict=True):
        assert np.all(abs(getattr(kept, name)(*columns) - by_arrays(kept, name, *columns)) <= 1e-12 * size)


def test_recorded_code_shares_and_folds():
    code = StraightLine()
    x, y = code.name("x"), code.name("y")
    assert (x * y).text == (x * y).text
    assert (0 * x + 1 * y).text == "y"
    assert (x - 0).text == "x"
    assert (0 - code.term(2)).value == -2
    assert code.term(0.1).text == (0.1).hex()
    assert len(code.lines) == 1


def leanest_casadi(kept: LyapunovNumeric, name: str, count: int) -> ca.Function:
    """The shortest graph CasADi can be given: plain doubles, gains folded in, the formula of the kernel."""
    shape, n = kept.family, kept.model.n
    forms = SimpleNamespace(
        sin=ca.sin,
        cos=ca.cos,
        sqrt=ca.sqrt,
        ratio=lambda a, b: a / ca.if_else(b > 0, b, 1),
        h=lambda x: shape.casadi(x).h,
        dh=lambda x: shape.casadi(x).dh,
        potential=lambda x: shape.casadi(x).potential,
    )
    symbols = [ca.SX.sym(x, n) for x in "qew"]
    certificate = LyapunovFunction(kept.model, forms, kept.kp, kept.kv, kept.viscous, kept.eps0)
    value = getattr(certificate, name)(*[ca.vertsplit(x) for x in symbols])
    return ca.Function(name, symbols, [value]).map(count)


@pytest.mark.parametrize("m", one_in(3, [2, 1, 3]))
@pytest.mark.parametrize("arm", ["reyes-kelly2", "buap3"])
def test_casadi_finds_the_same_values(arm, m):
    kept = lyapunov(arm, family.hyperbolic(m))
    columns = states(kept.model.n, LARGE)
    inputs = [ca.DM(x.T) for x in columns]
    for name, formula in (("V", "value"), ("rate", "rate")):
        casadi, ours = leanest_casadi(kept, formula, LARGE), getattr(kept, name)
        np.testing.assert_allclose(np.array(casadi(*inputs)).ravel(), ours(*columns), rtol=1e-9, atol=1e-9)


@pytest.mark.parametrize(("count", "unit"), [(0, 1), (1, 64), (63, 64), (1000, 64), (1001, 1), (7, 8)])
@pytest.mark.parametrize("workers", [1, 2, 5])
def test_shares_cover_everything_once(count, unit, workers, monkeypatch):
    monkeypatch.setattr(threads, "processors", lambda: workers)
    seen: list[int] = []

    def work(start: int, stop: int) -> int:
        assert start % unit == 0
        seen.extend(range(start, stop))
        return stop - start

    assert threads.over_shares(work, count, unit) == count
    assert sorted(seen) == list(range(count))
