"""Performance indices on signals whose indices are known in closed form."""

import math

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from lyapcheck.simulate.integrate import turns
from lyapcheck.simulate.results import l2_index, overshoots, settling_times

T = np.linspace(0.0, 5.0, 2001)


def exponential(rates, starts):
    return np.asarray(starts) * np.exp(-np.outer(T, rates))


@given(rate=st.floats(0.5, 8.0), start=st.floats(0.1, 3.0))
def test_l2_of_an_exponential(rate, start):
    """(1/T)∫ a² e^(−2rt) dt = a² (1 − e^(−2rT)) / (2rT)."""
    exact = math.degrees(start * math.sqrt((1 - math.exp(-10 * rate)) / (10 * rate)))
    assert l2_index(T, exponential([rate], [start])) == pytest.approx(exact, rel=1e-3)


def test_l2_of_uneven_samples_is_an_integral_not_a_mean():
    t = np.array([0.0, 0.1, 0.2, 10.0])
    assert l2_index(t, np.radians(np.full((4, 1), 2.0))) == pytest.approx(2.0)


@given(rate=st.floats(1.5, 8.0), start=st.floats(-3.0, -0.1))
def test_settling_of_an_exponential(rate, start):
    """|e| falls to 2 % of its start at t = ln 50 / r."""
    assert settling_times(T, exponential([rate], [start]))[0] == pytest.approx(math.log(50) / rate, abs=1e-4)


def test_a_signal_that_leaves_the_band_at_the_end_is_not_settled():
    e = np.where(T < 4.9, 0.0, 1.0)
    e[0] = 1.0
    assert math.isnan(settling_times(T, e[:, None])[0])


def test_a_joint_without_a_step_is_measured_by_the_largest_step():
    e = np.column_stack((exponential([3.0], [1.0])[:, 0], 0.5 * np.exp(-3 * T) * (1 - np.exp(-5 * T))))
    bare = settling_times(T, e)
    assert 0.0 < bare[1] < bare[0]
    assert np.all(settling_times(T, np.zeros((T.size, 2))) == 0.0)


@pytest.mark.parametrize("damping", [0.2, 0.5, 0.7])
@pytest.mark.parametrize("sign", [1.0, -1.0])
def test_overshoot_of_the_second_order_system(damping, sign):
    """100 exp(−πζ/√(1 − ζ²)) per cent, the textbook formula."""
    omega = 4.0
    rate = omega * math.sqrt(1 - damping**2)
    e = np.exp(-damping * omega * T) * (np.cos(rate * T) + damping * omega / rate * np.sin(rate * T))
    exact = 100 * math.exp(-math.pi * damping / math.sqrt(1 - damping**2))
    assert overshoots(sign * e[:, None])[0] == pytest.approx(exact, rel=1e-3)


@pytest.mark.parametrize("sign", [1.0, -1.0])
def test_angles_turn_between_samples_where_their_cubic_does(sign):
    """q = s (t³ − t) turns at 1/√3, exactly; where no rate changes its sign, the later sample stands."""
    t = np.array([0.0, 0.3, 0.9, 1.3])
    q, w = sign * (t**3 - t)[:, None], sign * (3 * t**2 - 1)[:, None]
    assert turns(t, q, w)[:, 0] == pytest.approx([q[1, 0], -sign * 2 / math.sqrt(27), q[3, 0]])
