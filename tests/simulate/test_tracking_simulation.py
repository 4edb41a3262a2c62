"""The tracking scheme (21) in motion, against an arm that knows nothing of its error system; its promises."""

import math
from dataclasses import replace
from fractions import Fraction

import numpy as np
import pytest

from lyapcheck import robots
from lyapcheck.check.loop import certifies
from lyapcheck.control.gains import GainSet, paper_gain_file, read_gain_file
from lyapcheck.errors import InputError
from lyapcheck.family import named
from lyapcheck.robots.numeric import NumericModel
from lyapcheck.search.controlled_arm import ControlledArm
from lyapcheck.simulate.breach import first_breach
from lyapcheck.simulate.promised import torque_bounds, tracking_form
from lyapcheck.simulate.reference import MinimumJerk, Sine
from lyapcheck.simulate.results import energies
from lyapcheck.simulate.task import set_up
from lyapcheck.simulate.tracking import Tracking, bound_of, track
from tests.helpers.shares import one_in

TABLE2 = read_gain_file(paper_gain_file("table2")).gains
PD = read_gain_file(paper_gain_file("table2_pd")).gains[0]


def row(*values):
    return tuple(Fraction(str(value)) for value in values)


WAVE = Sine(row(20, 30, 40), row("0.5", "0.5", "0.25"), row(0, 90, 10), row(0, 0, 0))
JERK = MinimumJerk(row(0, 0, 0), row(45, 45, 90), Fraction(2))
TWO = Sine(row(30, 20), row(1, "0.5"), row(0, 0), row(10, -20))
STILL = Sine(row(0, 0, 0), row(1, 1, 1), row(0, 0, 0), row(45, 45, 90))
START = [0.3, -0.2, 0.4]


def gains(n, m=2, kp=10, kv=2, family="hyperbolic"):
    return GainSet("set", m, (Fraction(kp),) * n, (Fraction(kv),) * n, family)


def run_of(gain_set=TABLE2[0], reference=WAVE, q0=START, **options):
    options.setdefault("T", 2.0)
    options.setdefault("points", 401)
    return track(gain_set, robots.load("buap3"), reference, q0, **options)


def arm_under_21(gain_set, model, reference, q0, t):
    """q of (1) under the torque of (21), by another integrator, from M, C, g, B as they stand."""
    from scipy.integrate import solve_ivp

    n, arm, held = model.n, NumericModel(model), ControlledArm(gain_set, model)
    h = named(gain_set.family, gain_set.m).h

    def rate(time, y):
        q, velocity = y[:n], y[n:]
        goal, speed, acceleration = reference.at(np.array([time]))[0]
        C, M, friction = arm.coriolis(q, velocity), arm.mass(q), arm.viscous
        tau = np.array(held.kp) * h(goal - q) + np.array(held.kv) * h(speed - velocity)
        tau += M @ acceleration + C @ speed + arm.gravity(q) + friction * speed
        pull = tau - C @ velocity - arm.gravity(q) - friction * velocity
        return np.concatenate((velocity, np.linalg.solve(M, pull)))

    start = np.concatenate((q0, np.zeros(n)))
    return solve_ivp(rate, (0.0, t[-1]), start, "DOP853", t, rtol=1e-10, atol=1e-12).y[:n].T


@pytest.mark.slow
@pytest.mark.parametrize(
    ("gain_set", "reference"),
    one_in(3, [(TABLE2[0], WAVE), (TABLE2[2], JERK), (PD, WAVE)]),
    ids=["m1", "m3", "pd"],
)
def test_the_arm_moves_as_the_error_system_says(gain_set, reference):
    run = run_of(gain_set, reference, T=1.0, points=101, stop=False)
    truth = arm_under_21(gain_set, robots.load("buap3"), reference, START, run.t)
    np.testing.assert_allclose(run.q, truth, atol=1e-7)
    assert run.accuracy < 1e-7
    assert run.work_balance < 1e-6


def test_linear_gains_make_the_error_of_a_pendulum_a_damped_oscillator():
    """¼ ë + (k_v + b) ė + k_p e = 0 whatever the reference does; e(0) = 0.2, ė(0) = q̇_d(0)."""
    wave = Sine(row(40), row(1), row(30), row(10))
    first = wave.at(np.zeros(1))[0, :, 0]
    pendulum = robots.load("pendulum1")
    run = track(gains(1, None, 10, 1, "linear"), pendulum, wave, [first[0] - 0.2], T=3.0, points=301)
    roots = np.roots([0.25, 1.5, 10.0]).astype(complex)
    weights = np.linalg.solve(np.array([[1, 1], roots]), np.array([0.2, first[1]]))
    exact = np.real(np.exp(np.outer(run.t, roots)) @ weights)
    np.testing.assert_allclose(run.e[:, 0], exact, atol=1e-8)


@pytest.mark.parametrize("family", one_in(3, ["hyperbolic", "tanh", "arctan", "algebraic", "linear"]))
@pytest.mark.parametrize("name", one_in(2, ["reyes-kelly2", "pelican2"]))
def test_every_family_keeps_its_promises_and_balances_its_energy(name, family):
    member = gains(2, 2 if family == "hyperbolic" else None, 5, 2, family)
    run = track(member, robots.load(name), TWO, [0.0, 0.0], T=1.0, points=101)
    assert run.breach is None
    assert run.work_balance < 1e-6
    assert (run.bound is None) == (family == "linear")


def test_an_arm_that_starts_on_the_reference_stays_on_it():
    first = WAVE.at(np.zeros(1))[0]
    run = run_of(q0=first[0], velocity_rad=first[1])
    assert np.max(np.abs(run.e)) < 1e-10
    assert run.indices.entered.tolist() == [0.0, 0.0, 0.0]
    assert run.V[-1] < 1e-15


@pytest.mark.slow
def test_a_reference_at_rest_is_the_regulator():
    from lyapcheck.simulate.closed_loop import simulate

    run = run_of(TABLE2[1], STILL, eps0=0.03)
    task = np.radians([45, 45, 90])
    known = simulate(TABLE2[1], robots.load("buap3"), task, START, T=2.0, eps0=0.03, points=401)
    np.testing.assert_allclose(run.q, known.q, atol=1e-8)
    np.testing.assert_allclose(run.tau, known.tau, atol=1e-6)
    np.testing.assert_allclose(run.dV, known.dV, atol=1e-6)
    assert pytest.approx(known.L2, rel=1e-8) == run.indices.L2


def test_dV_is_the_derivative_of_V_along_the_motion():
    """By central differences of V over the samples."""
    run = run_of(T=0.5, points=2001, eps0=0.02)
    h = run.t[1]
    slope = (run.V[:-4] - 8 * run.V[1:-3] + 8 * run.V[3:-1] - run.V[4:]) / (12 * h)
    np.testing.assert_allclose(run.dV[2:-2], slope, atol=1e-5 * np.max(np.abs(run.dV)))


def random_states(seed, speed, count=4000):
    """q, e, w and q̇_d: states of all sizes with ‖q̇_d‖ = speed."""
    rng = np.random.default_rng(seed)
    q, e, w, way = rng.standard_normal((4, count, 3))
    sizes = 10.0 ** rng.uniform(-2, 1.5, (2, count, 1))
    return 3 * q, sizes[0] * e, sizes[1] * w, speed * way / np.linalg.norm(way, axis=1, keepdims=True)


@pytest.mark.parametrize("gain_set", TABLE2, ids=lambda g: g.name)
def test_the_form_bounds_dV_at_states_of_all_sizes(gain_set):
    """For any ε₀, admissible or not; and with a v_d that is too small it is broken."""
    controlled = ControlledArm(gain_set, robots.load("buap3"))
    q, e, w, speed = random_states(1, 1000.0)
    for eps0 in (0.01, 0.5):
        _, dV = energies(controlled, eps0, q, e, w, speed)
        bound = bound_of(tracking_form(controlled, Fraction(1000)), controlled.family, eps0, e, w)
        assert np.all(dV <= bound + 1e-9 * np.abs(bound))
        low = bound_of(tracking_form(controlled, Fraction(0)), controlled.family, eps0, e, w)
        assert np.any(dV > low + 1e-6)


@pytest.mark.parametrize("speed", [0, 2, 50])
def test_the_largest_eps0_is_where_the_form_ceases_to_be_definite(speed):
    """By eigenvalues of Θ'(ε) on a grid of ε, without the argument that the end decides."""
    form = tracking_form(ControlledArm(TABLE2[0], robots.load("buap3")), Fraction(speed))
    largest = form.largest()
    k, beta, c, d = (
        float(x) for x in (form.still.stiffness, form.still.friction, form.still.drift, form.still.cross)
    )
    turn = float(form.turn)

    def least(eps0):
        eps = np.linspace(eps0 / 100, eps0, 200)
        corner, side = eps * (k - eps * turn), -eps / 2 * (d + turn + eps * c)
        matrices = np.stack((corner, side, side, beta - eps * c), axis=-1).reshape(-1, 2, 2)
        return float(np.linalg.eigvalsh(matrices).min())

    assert least(0.9999 * float(largest)) > 0
    assert least(1.0001 * float(largest)) < 0
    if speed == 0:
        assert certifies(form.still, largest)
        assert not certifies(form.still, largest * Fraction(10001, 10000))


def test_a_reference_faster_than_it_was_said_to_be_is_caught():
    """The promise of v_d = 0 is planted on states at 1000 rad/s: the form is seen to break."""
    setup = set_up(TABLE2[0], robots.load("buap3"), [0.0] * 3, None, None, T=1.0, eps0=0.01)
    q, e, w, speed = random_states(3, 1000.0, 500)
    _, dV = energies(setup.controlled, 0.01, q, e, w, speed)
    low, high = (
        bound_of(tracking_form(setup.controlled, Fraction(v)), setup.controlled.family, 0.01, e, w)
        for v in (0, 1000)
    )
    run = run_of(T=0.1, points=11)
    none = np.zeros_like(q)
    states = {"q": q, "e": e, "w": w, "tau": none, "speed": speed, "acceleration": none}
    falling = {"t": np.arange(500.0), "V": -np.arange(500.0), "dV": np.minimum(dV, -1e-12)}
    still = replace(run.promise, torque=None)
    slow, fast = (replace(run, **states, **falling, promise=still, eps0=0.01, bound=x) for x in (low, high))
    assert "Θ'" in first_breach(Tracking.breaches(setup, slow)).promise
    assert first_breach(Tracking.breaches(setup, fast)) is None


def test_the_bound_of_the_torque_at_rest_is_the_rule_joint_by_joint():
    """γ (k_pi + k_vi) + k_gi with γ = 1: 28.233, 60.233 + 40.28 and 5.233 + 1.81."""
    controlled = ControlledArm(TABLE2[0], robots.load("buap3"))
    result = torque_bounds(controlled, STILL.suprema(), [0] * 3, [0.0] * 3, [0.0] * 3)
    assert [float(x) for x in result.total] == pytest.approx([28.233, 100.513, 7.043])
    assert result.error_rate == 0


BAD = [
    ({"q0": [1.0]}, ["start_rad"]),
    ({"velocity_rad": [math.nan, 0, 0]}, ["velocity_rad"]),
    ({"T": 0.0, "eps0": -1.0, "band_rad": 0.0}, ["T", "band_rad", "eps0"]),
    ({"reference": TWO}, ["reference"]),
    ({"reference": Sine(row(30, 30, 30), row(900, 900, 900), row(0, 0, 0), row(0, 0, 0))}, ["reference"]),
]


@pytest.mark.parametrize(("change", "keys"), BAD, ids=range(len(BAD)))
def test_impossible_requests_are_refused_by_name(change, keys):
    with pytest.raises(InputError) as refused:
        run_of(**change)
    assert [problem.key for problem in refused.value.problems] == keys


def test_balls_and_doubles_agree_on_dV_and_the_torque_of_a_moving_goal():
    """The proof that a promise broke is about the same dV/dt and τ as the samples show."""
    from lyapcheck.check.loop.states import State, rate
    from lyapcheck.check.numbers.balls import precision, to_arb
    from lyapcheck.simulate.breach import at_balls, exceeds, rises
    from lyapcheck.simulate.run import Sample

    run, controlled = run_of(eps0=0.3, points=21, stop=False), ControlledArm(TABLE2[0], robots.load("buap3"))
    m = run
    for i in (0, 3, 11, 20):
        at = Sample(*(tuple(x[i].tolist()) for x in (m.q, m.e, m.w, m.speed, m.acceleration)))
        state = State(*(tuple(map(Fraction, part)) for part in (at.q, at.e, at.w)))
        with precision(128):
            balls, eps0 = at_balls(controlled, at), Fraction(0.3)
            result = rate(controlled.arm, controlled.controller, eps0, state)
            result += balls.rate_of_moving_goal(to_arb(eps0))
            np.testing.assert_allclose([float(x) for x in balls.torque()], m.tau[i], rtol=1e-10)
        assert float(result) == pytest.approx(run.dV[i], rel=1e-9)
        assert rises(controlled, 0.3, at) == (run.dV[i] > 0)
        size = Fraction(abs(m.tau[i, 1]))
        assert exceeds(controlled, 1, size * Fraction(999, 1000), at)
        assert not exceeds(controlled, 1, size * Fraction(1001, 1000), at)
