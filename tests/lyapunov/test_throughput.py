"""Compiled V and dV/dt: as accurate as the arrays, on every state, and far faster than CasADi."""

import re
import subprocess

import numpy as np
import pytest

from lyapcheck import family, robots
from lyapcheck.lyapunov import loop as loop_module
from lyapcheck.lyapunov import loop as writer
from lyapcheck.lyapunov import numeric as numeric_module
from lyapcheck.lyapunov.compiler import VECTORS, compiler
from lyapcheck.lyapunov.numeric import LyapunovNumeric
from lyapcheck.robots.numeric import NumericModel
from tests.helpers.shares import one_in

KP, KV, EPS0 = (25.0, 50.0, 5.0), (0.25, 0.5, 0.125), 0.375
EXPECTED = "numpy" if compiler() is None else "compiled"
ARMS = ("pendulum1", "reyes-kelly2", "buap3")
FAMILIES = [family.hyperbolic(m) for m in (1, 2, 3, 7, 64)] + [
    family.named("tanh"),
    family.named("arctan"),
    family.named("algebraic"),
    family.named("linear"),
]


def lyapunov(arm, shape):
    model = robots.load(arm)
    return LyapunovNumeric(model, shape, KP[: model.n], KV[: model.n], EPS0)


def states(n, count, size=1.0, seed=5):
    random = np.random.default_rng(seed)
    return [scale * size * random.standard_normal((count, n)) for scale in (3, 2, 4)]


def extreme_states(n, count):
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


def by_arrays(kept, name, *columns):
    """The NumPy form, whatever the size of the batch."""
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(numeric_module, "LARGE", 10**9)
        return getattr(kept, name)(*columns)


def term_sizes(kept, q, e, w):
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
def empty_cache(tmp_path, monkeypatch):
    """A cache with nothing in it, where loops are kept."""
    monkeypatch.setenv("XDG_CACHE_HOME", str(tmp_path))
    loop_module._made.cache_clear()
    return tmp_path / "lyapcheck" / "kernels"


@pytest.fixture
def few(monkeypatch):
    """A batch counts as large from here on."""
    monkeypatch.setattr(numeric_module, "LARGE", 1000)
    return 1000


@pytest.mark.parametrize("shape", one_in(3, FAMILIES), ids=lambda f: f"{f.name}{f.m or ''}")
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


@pytest.mark.parametrize("value", [np.nan, np.inf, -np.inf, 0.0, -0.0, 1e16, 1e300, 1.7e308])
@pytest.mark.parametrize("which", one_in(3, [2, 0, 1]))
def test_states_beyond_all_sense_get_the_arrays_answer(value, which, few):
    """NaN stays NaN, infinities are not forgotten, and no other state notices."""
    kept = lyapunov("reyes-kelly2", family.hyperbolic(2))
    columns = states(2, few)
    before = [kept.V(*columns), kept.rate(*columns)]
    columns[which][345, 1] = value
    others = np.arange(few) != 345
    for name, old in zip(("V", "rate"), before, strict=True):
        compiled, by_numpy = getattr(kept, name)(*columns), by_arrays(kept, name, *columns)
        assert np.isnan(compiled[345]) or not np.isnan(value)
        assert np.array_equal(compiled[others], old[others])
        assert np.isfinite(compiled[345]) == np.isfinite(by_numpy[345])
        if np.isfinite(by_numpy[345]):
            assert compiled[345] == pytest.approx(by_numpy[345], rel=1e-9)


def test_too_long_a_formula_is_left_to_arrays(monkeypatch, few, empty_cache):
    kept = lyapunov("reyes-kelly2", family.hyperbolic(2))
    assert kept.engine(few) == EXPECTED
    monkeypatch.setattr(writer, "MOST_STATEMENTS", 20)
    assert lyapunov("reyes-kelly2", family.hyperbolic(3)).engine(few) == "numpy"


def imported(folder):
    """What the libraries of a folder ask of others."""
    names = set()
    for path in folder.glob("*.so"):
        whole = path.with_suffix(".plain")
        whole.write_bytes(path.read_bytes()[:-32])  # without the digest behind it
        text = subprocess.run(["nm", "-D", whole], capture_output=True, text=True, check=True).stdout
        names |= set(re.findall(r" U (\w+)", text))
    return names


@pytest.mark.parametrize("m", one_in(3, [2, 1, 3]))
def test_loops_call_functions_of_vectors_and_no_power(m, few, empty_cache):
    """One scalar call in a loop, and it is several times slower; nothing else would tell."""
    lyapunov("buap3", family.hyperbolic(m)).engine(few)
    names = imported(empty_cache)
    assert not names & {"pow", "exp"}
    vectors = {name.rpartition("_")[2] for name in names if name.startswith("_ZGV")}
    scalars = names & {"sin", "cos", "expm1", "log", "log1p"}
    assert bool(names) == (EXPECTED == "compiled")
    if VECTORS:
        assert vectors == {"sin", "cos", "expm1", "log", "log1p"}
        assert not scalars
