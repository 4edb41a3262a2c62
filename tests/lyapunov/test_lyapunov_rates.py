"""dV/dt five ways: AD along (11), the terms of (15), −zᵀQz, NumPy, and balls at exact states."""

from __future__ import annotations

from fractions import Fraction
from functools import cache

import casadi as ca
import numpy as np
import pytest

from lyapcheck import family, robots
from lyapcheck.check.loop import states
from lyapcheck.lyapunov import quadratic
from lyapcheck.lyapunov.graph import LyapunovGraph, lyapunov_graph
from lyapcheck.lyapunov.numeric import LyapunovNumeric

ARMS = ["pendulum1", "reyes-kelly2", "buap3"]
MEMBERS = [1, 2, 3, 7]
CASES = [(arm, m) for arm in ARMS for m in MEMBERS]
KP, KV, EPS0 = (25.0, 50.0, 5.0), (0.25, 0.5, 0.125), 0.375


@cache
def graph_of(arm: str, m: int) -> LyapunovGraph:
    return lyapunov_graph(robots.load(arm), family.hyperbolic(m))


def numeric_of(arm: str, m: int) -> LyapunovNumeric:
    model = robots.load(arm)
    return LyapunovNumeric(model, family.hyperbolic(m), KP[: model.n], KV[: model.n], EPS0)


def random_states(n: int, count: int, seed: int = 3) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    random = np.random.default_rng(seed)
    return random.uniform(-4, 4, (count, n)), random.normal(0, 2, (count, n)), random.normal(0, 4, (count, n))


def evaluated(function: ca.Function, q: np.ndarray, e: np.ndarray, w: np.ndarray) -> np.ndarray:
    n = q.shape[1]
    gains = [np.tile(np.array(k[:n])[:, None], len(q)) for k in (KP, KV)]
    return np.array(function(q.T, e.T, w.T, *gains, np.full((1, len(q)), EPS0))).ravel()


def scale_of(w: np.ndarray) -> np.ndarray:
    """Terms of this size are summed, so this is what rounding is relative to."""
    return 100 * (1 + np.sum(w * w, axis=1))


@pytest.mark.parametrize(("arm", "m"), CASES)
def test_terms_of_15_sum_to_the_derivative_of_v(arm: str, m: int) -> None:
    graph = graph_of(arm, m)
    q, e, w = random_states(robots.load(arm).n, 60)
    by_ad, by_terms = (evaluated(f, q, e, w) for f in (graph.rate, graph.rate_15))
    assert np.all(abs(by_ad - by_terms) <= 1e-12 * scale_of(w))


@pytest.mark.parametrize(("arm", "m"), CASES)
def test_quadratic_form_is_the_derivative_of_v(arm: str, m: int) -> None:
    graph, n = graph_of(arm, m), robots.load(arm).n
    q, e, w = random_states(n, 30)
    by_ad = evaluated(graph.rate, q, e, w)
    for k in range(len(q)):
        Q = np.array(graph.Q(q[k], e[k], w[k], KP[:n], KV[:n], EPS0))
        eps = EPS0 / (1 + np.linalg.norm(e[k]))
        z = np.concatenate([np.sqrt(eps) * family.hyperbolic(m).h(e[k]), w[k]])
        assert np.array_equal(Q, Q.T)
        assert abs(by_ad[k] + z @ Q @ z) <= 1e-12 * scale_of(w)[k]


@pytest.mark.parametrize(("arm", "m"), CASES)
def test_numpy_agrees_with_casadi(arm: str, m: int) -> None:
    numeric, graph = numeric_of(arm, m), graph_of(arm, m)
    q, e, w = random_states(robots.load(arm).n, 60)
    assert np.all(abs(numeric.rate(q, e, w) - evaluated(graph.rate, q, e, w)) <= 1e-12 * scale_of(w))
    assert np.allclose(numeric.V(q, e, w), evaluated(graph.V, q, e, w), rtol=1e-12, atol=0)


@pytest.mark.parametrize("arm", ARMS)
def test_all_ways_agree_at_zero_error_and_at_rest(arm: str) -> None:
    numeric, graph, n = numeric_of(arm, 2), graph_of(arm, 2), robots.load(arm).n
    q, e, w = random_states(n, 3)
    e[0], w[1], e[2], w[2] = 0, 0, 0, 0
    ways = [numeric.rate(q, e, w), evaluated(graph.rate, q, e, w), evaluated(graph.rate_15, q, e, w)]
    assert np.all(np.isfinite(ways))
    assert np.allclose(ways[0], ways[1], rtol=1e-12)
    assert np.allclose(ways[0], ways[2], rtol=1e-12)
    assert ways[0][2] == 0


def test_one_state_or_many_give_the_same() -> None:
    numeric = numeric_of("reyes-kelly2", 3)
    q, e, w = random_states(2, 20_000)
    together = numeric.rate(q, e, w)
    assert together.shape == (20_000,)
    # a batch may take another order of summation, so equal up to rounding
    assert numeric.rate(q[12_345], e[12_345], w[12_345]) == pytest.approx(together[12_345], rel=1e-12)


@pytest.mark.parametrize("arm", ["reyes-kelly2", "buap3"])
def test_agrees_with_the_trusted_evaluation_in_balls(arm: str) -> None:
    from lyapcheck.control.gains import GainSet
    from lyapcheck.search.controlled_arm import ControlledArm

    model = robots.load(arm)
    kp, kv = (tuple(map(Fraction, k[: model.n])) for k in (KP, KV))
    controlled = ControlledArm(GainSet("test", 3, kp, kv), model)
    q, e, w = random_states(model.n, 4, seed=8)
    by_numpy = numeric_of(arm, 3).rate(q, e, w)
    for k in range(len(q)):
        state = states.State(*(tuple(Fraction(float(x)) for x in row) for row in (q[k], e[k], w[k])))
        ball = states.rate(controlled.arm, controlled.controller, Fraction(EPS0), state)
        assert float(ball.mid()) == pytest.approx(by_numpy[k], rel=1e-10)


def test_fast_matrix_decides_the_sign_for_fast_states() -> None:
    graph = graph_of("reyes-kelly2", 2)
    q, e, _ = random_states(2, 20)
    for k in range(len(q)):
        values, vectors = np.linalg.eigh(np.array(graph.fast(q[k], e[k], [0, 0], KP[:2], KV[:2], 2.0)))
        w = vectors[:, 0] * 1e7
        rate = float(graph.rate(q[k], e[k], w, KP[:2], KV[:2], 2.0))
        assert np.sign(rate) == -np.sign(values[0])


def test_form_and_rate_are_equal_in_exact_arithmetic() -> None:
    half = Fraction(1, 2)
    M = [[Fraction(3), Fraction(1)], [Fraction(1), Fraction(2)]]
    Ch = [[Fraction(1), Fraction(-2)], [Fraction(5), Fraction(1, 3)]]
    h, dh, w = [Fraction(1, 3), Fraction(-2)], [Fraction(1, 7), Fraction(-1)], [Fraction(4), Fraction(-3, 2)]
    kp, eps, root = [Fraction(2), Fraction(9)], Fraction(1, 16), Fraction(1, 4)
    damped = quadratic.damping([Fraction(1), Fraction(2)], [Fraction(3), Fraction(1)], [half, Fraction(1, 5)])
    S = quadratic.coupling(M, Ch, h, dh, [Fraction(3, 5), Fraction(4, 5)], half)
    X, Y = quadratic.x_matrix(damped, S, eps), quadratic.y_matrix(damped, S, eps, half)
    Q = quadratic.quadratic_form(kp, X, Y, root, half, Fraction(0))
    z = [root * x for x in h] + w
    assert -quadratic.dot(z, [quadratic.dot(row, z) for row in Q]) == quadratic.rate(kp, X, h, w, eps)
