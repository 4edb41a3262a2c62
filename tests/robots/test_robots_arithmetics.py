"""CasADi and NumPy forms of a model: all from the same polynomials, and all the same numbers."""

import casadi as ca
import numpy as np
import pytest

from lyapcheck import robots
from lyapcheck.lyapunov import graph
from lyapcheck.robots.numeric import NumericModel
from tests.helpers.robot_cases import BUILT_IN


@pytest.fixture(params=BUILT_IN)
def arm(request):
    return robots.load(request.param)


def states(n, count):
    random = np.random.default_rng(20190301)
    return random.uniform(-np.pi, np.pi, (count, n)), random.normal(0, 3, (count, n))


def test_numpy_agrees_with_the_polynomials(arm):
    q, x = states(arm.n, 20)
    fast = NumericModel(arm)
    for state, rate, mass, coriolis, gravity in zip(
        q, x, fast.mass(q), fast.coriolis(q, x), fast.gravity(q), strict=True
    ):
        sin, cos = list(np.sin(state)), list(np.cos(state))
        np.testing.assert_allclose(mass, arm.at(sin, cos, float).mass(), rtol=1e-13, atol=1e-14)
        np.testing.assert_allclose(
            coriolis, arm.at(sin, cos, float).coriolis(list(rate)), rtol=1e-12, atol=1e-13
        )
        np.testing.assert_allclose(gravity, arm.at(sin, cos, float).gravity(), rtol=1e-13, atol=1e-13)


def test_casadi_agrees_with_numpy(arm):
    q, x = ca.SX.sym("q", arm.n), ca.SX.sym("x", arm.n)
    at = graph.at_angles(arm, q)
    matrices = graph.matrix(at.mass()), graph.matrix(at.coriolis(ca.vertsplit(x)))
    outputs = [*matrices, ca.vertcat(*at.gravity()), at.potential()]
    function, fast = ca.Function("model", [q, x], outputs), NumericModel(arm)
    for state, rate in zip(*states(arm.n, 10), strict=True):
        mass, coriolis, gravity, potential = (np.array(value) for value in function(state, rate))
        np.testing.assert_allclose(mass, fast.mass(state), rtol=1e-12, atol=1e-14)
        np.testing.assert_allclose(coriolis, fast.coriolis(state, rate), rtol=1e-12, atol=1e-13)
        np.testing.assert_allclose(gravity[:, 0], fast.gravity(state), rtol=1e-12, atol=1e-13)
        assert float(potential.item()) == pytest.approx(float(fast.potential(state)), abs=1e-12)
