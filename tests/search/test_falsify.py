"""Sampled and optimised worst states: they agree with the balls, and they reach what is known by hand."""

from dataclasses import replace
from fractions import Fraction

import numpy as np
import pytest

from lyapcheck.check.loop.states import State, confirms_positive, rate
from lyapcheck.control.gains import GainSet
from lyapcheck.robots import load
from lyapcheck.search.controlled_arm import ControlledArm
from lyapcheck.search.falsify import falsify
from lyapcheck.search.worst_states import (
    States,
    fast_states,
    fastest_directions,
    finite_states,
    quadratic,
    sample,
    spread,
)
from tests.helpers.shares import one_in

F = Fraction
FEW = {"starts": 6, "samples": 2000}


def gains(m, kp, kv, **other):
    return GainSet("set", m, tuple(map(F, kp.split())), tuple(map(F, kv.split())), **other)


def two_joints(m):
    return ControlledArm(gains(m, "60 5", "0.233 0.233"), load("reyes-kelly2"))


SETTINGS = [
    two_joints(1),
    two_joints(3),
    ControlledArm(gains(2, "27 50 5", "0.223 0.223 0.223"), load("buap3")),
    ControlledArm(gains(1, "4", "0.5"), load("pendulum1")),
    ControlledArm(gains(None, "60 5", "2 1", family="linear"), load("reyes-kelly2")),
    ControlledArm(gains(None, "1 0.1", "0.2 0.1", family="linear", angle_unit="deg"), load("pelican2")),
    ControlledArm(gains(None, "60 5", "2 1", family="arctan"), load("pelican2")),
]


def exact_state(states, k):
    return State(*(tuple(F(float(x)) for x in part[k]) for part in (states.q, states.e, states.w)))


@pytest.mark.parametrize("controlled", SETTINGS)
def test_quadratic_in_eps0_agrees_with_the_balls(controlled):
    states = sample(controlled, 40, 1)
    for eps0 in (0.0, 0.3, 2.0):
        result = quadratic(controlled, states).at(eps0)
        h, near = controlled.family.h(states.e), 1 / (1 + np.linalg.norm(states.e, axis=1))
        scale = near * np.sum(h * h, axis=1) + np.sum(states.w * states.w, axis=1)
        for k in range(40):
            proved = rate(controlled.arm, controlled.controller, F(eps0), exact_state(states, k))
            assert abs(float(proved.mid()) - result[k]) <= 1e-11 * (abs(result[k]) + scale[k])


@pytest.mark.slow
def test_two_joints_at_zero_error_by_hand():
    """m = 1: 1/ε₀ = λmax(B^(−½)M(0)B^(−½)), because M is largest with the arm stretched."""
    scale = np.diag(1 / np.sqrt([2.288, 0.175]))
    largest = np.linalg.eigvalsh(scale @ np.array([[2.519, 0.186], [0.186, 0.102]]) @ scale)[-1]
    witness = falsify(two_joints(1), **FEW)
    assert witness is not None
    assert 1 / largest < float(witness.eps0) < (1 + 1e-5) / largest


@pytest.mark.slow
@pytest.mark.parametrize("controlled", one_in(4, SETTINGS))
def test_witness_replays_and_a_tampered_one_does_not(controlled):
    witness = falsify(controlled, **FEW)
    assert witness is not None
    replay = controlled.arm, controlled.controller, witness.eps0
    assert confirms_positive(*replay, witness.state)
    assert witness.rate.lower > 0
    assert not confirms_positive(*replay, replace(witness.state, w=(F(0),) * controlled.n))
    assert not confirms_positive(*replay, replace(witness.state, e=(F(20),) * controlled.n))
    assert not confirms_positive(
        controlled.arm, controlled.controller, witness.eps0 * F(9, 10), witness.state
    )


@pytest.mark.parametrize("m", [1, 2, 3])
def test_optimised_states_are_at_least_as_bad_as_sampled_ones(m):
    controlled = two_joints(m)
    states = sample(controlled, 2000, 5)
    speed, directions = fastest_directions(controlled, states.q, states.e)
    chosen = spread(states, speed, 6)
    starts = States(states.q[chosen], states.e[chosen], directions[chosen])
    fast = fast_states(controlled, starts)
    level = fast_states(controlled, starts, level=True)
    reached = max(fastest_directions(controlled, s.q, s.e)[0].max() for s in (fast, level))
    assert reached >= speed.max() * (1 - 1e-9)
    near = quadratic(controlled, states).reciprocal()
    picked = states.take(spread(states, near, 6))
    assert quadratic(controlled, finite_states(controlled, picked)).reciprocal().max() >= (
        0.999 * quadratic(controlled, picked).reciprocal().max() if m > 1 else 0.0
    )
