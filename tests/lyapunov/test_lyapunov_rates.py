"""dV/dt four ways: AD along (11), the terms of (15), NumPy, and balls at exact states; and its parts."""

from functools import cache

import numpy as np
import pytest

from lyapcheck import family, robots
from lyapcheck.lyapunov.graph import lyapunov_graph
from lyapcheck.lyapunov.numeric import LyapunovNumeric
from lyapcheck.robots.numeric import NumericModel

ARMS = ["pendulum1", "reyes-kelly2", "buap3"]
KP, KV, EPS0 = (25.0, 50.0, 5.0), (0.25, 0.5, 0.125), 0.375


@cache
def graph_of(arm, m):
    return lyapunov_graph(robots.load(arm), family.hyperbolic(m))


def numeric_of(arm, m):
    model = robots.load(arm)
    return LyapunovNumeric(model, family.hyperbolic(m), KP[: model.n], KV[: model.n], EPS0)


def random_states(n, count, seed=3):
    random = np.random.default_rng(seed)
    return random.uniform(-4, 4, (count, n)), random.normal(0, 2, (count, n)), random.normal(0, 4, (count, n))


def evaluated(function, q, e, w):
    n = q.shape[1]
    gains = [np.tile(np.array(k[:n])[:, None], len(q)) for k in (KP, KV)]
    return np.array(function(q.T, e.T, w.T, *gains, np.full((1, len(q)), EPS0))).ravel()


def scale_of(w):
    """Terms of this size are summed, so this is what rounding is relative to."""
    return 100 * (1 + np.sum(w * w, axis=1))


@pytest.mark.parametrize("arm", ARMS)
def test_all_ways_agree_at_zero_error_and_at_rest(arm):
    numeric, graph, n = numeric_of(arm, 2), graph_of(arm, 2), robots.load(arm).n
    q, e, w = random_states(n, 3)
    e[0], w[1], e[2], w[2] = 0, 0, 0, 0
    ways = [numeric.rate(q, e, w), evaluated(graph.rate, q, e, w), evaluated(graph.rate_15, q, e, w)]
    assert np.all(np.isfinite(ways))
    assert np.allclose(ways[0], ways[1], rtol=1e-12)
    assert np.allclose(ways[0], ways[2], rtol=1e-12)
    assert ways[0][2] == 0


@pytest.mark.parametrize("arm", ARMS)
def test_parts_are_those_of_the_quadratic_form_without_velocities(arm):
    """−a₀ + a₁ε₀ + a₂ε₀² by S = C(q,h) + (Mh)êᵀ/(1+r) − MH', worked out by hand at each state."""
    numeric, model = numeric_of(arm, 2), robots.load(arm)
    plain, shape = NumericModel(model), numeric.family
    q, e, w = random_states(model.n, 20)
    at = numeric.at_columns(q, e, w)
    a0, a1, a2 = numeric.coefficients(q, e, w)
    fast = np.moveaxis(np.array([[np.broadcast_to(x, 20) for x in row] for row in at.fast()]), -1, 0)
    slope = np.array([np.broadcast_to(x, 20) for x in at.slope()]).T
    for k in range(20):
        h, M, near = shape.h(e[k]), plain.mass(q[k]), 1 / (1 + np.linalg.norm(e[k]))
        S = plain.coriolis(q[k], h) + near * np.outer(M @ h, e[k]) / np.linalg.norm(e[k])
        S = S - M * shape.dh(e[k])
        damped = np.array(numeric.viscous) * w[k] + np.array(numeric.kv) * shape.h(w[k])
        size = 1e-12 * scale_of(w)[k]
        assert abs(a0[k] - w[k] @ damped) <= size
        assert abs(a1[k] - near * (h @ damped - h @ (np.array(numeric.kp) * h) - w[k] @ S @ w[k])) <= size
        assert abs(a2[k] - near**2 * h @ S @ w[k]) <= size
        assert np.allclose(fast[k] + fast[k].T, -near * (S + S.T), rtol=1e-12, atol=1e-13)
        assert np.allclose(slope[k], near**2 * S.T @ h, rtol=1e-12, atol=1e-13)
        assert numeric.rate(q[k], e[k], w[k]) == pytest.approx(
            -a0[k] + a1[k] * EPS0 + a2[k] * EPS0**2, rel=1e-9, abs=size
        )
