"""dV/dt < 0 for an arm given by its links; what is accepted and refused is in the arena."""

from __future__ import annotations

import numpy as np
from flint import arb

from lyapcheck.check.loop.chain import Posture
from lyapcheck.check.numbers.balls import to_arb
from lyapcheck.check.numbers.vectors import Algebra
from tests.helpers.committed import read

STATED, _ = read("good/decreasing-links.ranges")


def planar(q):
    """M(q) of two unit points on links of length 1, by hand."""
    c = np.cos(q[1])
    return np.array([[3 + 2 * c, 1 + c], [1 + c, 1.0]])


def test_dv_dt_by_finite_differences_is_negative_where_it_is_proved_to_be():
    """V of (13) along one short step of (11), integrated without anything of the checker."""
    h = np.tanh
    kp, kv, b, eps0 = np.array([3.0, 1.0]), np.array([1.0, 0.25]), np.array([1.0, 0.5]), 0.01
    potential = lambda e: np.log(np.cosh(e))  # noqa: E731

    def coriolis(q, w):
        s = np.sin(q[1])
        return np.array([-s * (2 * w[0] * w[1] + w[1] ** 2), s * w[0] ** 2])

    def rate(state):
        q, e, w = state[:2], state[2:4], state[4:]
        forces = kp * h(e) - kv * h(w) - b * w - coriolis(q, w)
        return np.concatenate([w, -w, np.linalg.solve(planar(q), forces)])

    def value(state):
        q, e, w = state[:2], state[2:4], state[4:]
        y = w - eps0 / (1 + np.linalg.norm(e)) * h(e)
        return y @ planar(q) @ y / 2 + kp @ potential(e)

    random, step = np.random.default_rng(1), 1e-5
    for _ in range(2000):
        state = random.normal(size=6) * np.array([3, 3, 2, 2, 3, 3])
        slope = rate(state)
        change = (value(state + step * slope) - value(state - step * slope)) / (2 * step)
        assert change < 1e-7
    assert [[*map(float, row)] for row in (STATED.kp, STATED.kv)] == [[*kp], [*kv]]
    assert float(STATED.eps0) == eps0


def test_the_arm_of_the_arena_is_the_one_worked_out_by_hand():
    for q in ([0.3, 0.0], [0.1, 1.2], [2.0, -2.5]):
        turns = [arb(float(x)) for x in np.sin(q)], [arb(float(x)) for x in np.cos(q)]
        rows = Posture(STATED.links, *turns, Algebra(to_arb)).mass()
        assert np.allclose([[float(x.mid()) for x in row] for row in rows], planar(q), atol=1e-12)
