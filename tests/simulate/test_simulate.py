"""The reference simulation against closed forms, an independent integrator, and its own promises."""

import math
from fractions import Fraction

import numpy as np
import pytest

from lyapcheck import robots
from lyapcheck.answers.simulate import runs_csv
from lyapcheck.control.gains import GainSet, paper_gain_file, read_gain_file
from lyapcheck.errors import InputError
from lyapcheck.search.controlled_arm import ControlledArm
from lyapcheck.simulate.closed_loop import SetPoint, simulate
from lyapcheck.simulate.integrate import integrate
from lyapcheck.simulate.run import SimulationFailed
from lyapcheck.simulate.task import PAPER_TASK, Setup
from lyapcheck.tasks import simulate_motion
from tests.helpers.shares import one_in

TABLE2 = (
    *read_gain_file(paper_gain_file("table2")).gains,
    *read_gain_file(paper_gain_file("table2_pd")).gains,
)
ARMS = ("buap3", "pelican2", "pendulum1", "reyes-kelly2")


def gains(n, m=2, kp=10, kv=2, family="hyperbolic"):
    member = m if family == "hyperbolic" else None
    return GainSet("set", member, (Fraction(kp),) * n, (Fraction(kv),) * n, family)


def paper_run(gain_set, eps0=None, stop=True):
    task = PAPER_TASK
    arm = robots.load("buap3")
    return simulate(gain_set, arm, task.q_d, task.q0, task.w0, task.T, eps0=eps0, stop=stop)


@pytest.mark.parametrize("kv", [1, 5])
def test_linear_pd_on_the_pendulum_is_the_damped_oscillator(kv):
    """M ë + (k_v + b) ė + k_p e = 0 with M = 1/4, b = 1/2: under- and overdamped, solved by hand."""
    run = simulate(gains(1, kp=10, kv=kv, family="linear"), robots.load("pendulum1"), [1.0], T=3.0)
    roots = np.roots([0.25, kv + 0.5, 10.0]).astype(complex)
    weights = np.linalg.solve(np.array([[1, 1], roots]), np.array([1.0, 0.0]))
    exact = np.real(np.exp(np.outer(run.t, roots)) @ weights)
    np.testing.assert_allclose(run.e[:, 0], exact, atol=1e-8)


@pytest.mark.slow
@pytest.mark.parametrize("gain_set", one_in(4, TABLE2), ids=lambda g: g.name)
def test_another_integrator_finds_the_same_motion(gain_set):
    """CVODES, with its own step control and its own source, on the same equations."""
    import casadi as ca

    model = robots.load("buap3")
    run = paper_run(gain_set)
    loop = SetPoint(Setup(ControlledArm(gain_set, model), PAPER_TASK, 0.0), 2)
    options = {"abstol": 1e-13, "reltol": 1e-11, "max_num_steps": 100_000}
    problem = {"x": loop.state, "p": loop.target, "ode": loop.rate}
    cvodes = ca.integrator("cvodes", "cvodes", problem, 0.0, run.t, options)
    states = np.array(cvodes(x0=np.zeros(8), p=np.array(PAPER_TASK.q_d))["xf"]).T
    np.testing.assert_allclose(states[:, :3], run.q, atol=1e-6)
    np.testing.assert_allclose(states[:, 3:6], run.w, atol=1e-6)


@pytest.mark.parametrize("name", ARMS)
@pytest.mark.parametrize("family", one_in(5, ["hyperbolic", "tanh", "arctan", "algebraic", "linear"]))
def test_every_arm_and_family_balances_its_energy(name, family):
    model = robots.load(name)
    run = simulate(
        gains(model.n, family=family), model, [1.0] * model.n, velocity_rad=[2.0] * model.n, T=1.0, points=201
    )
    assert run.energy_balance < 1e-9
    assert run.accuracy < 1e-7


@pytest.mark.slow
@pytest.mark.parametrize("eps0", [0.0, 0.3])
def test_dV_is_the_derivative_of_V_along_the_motion(eps0):
    """By automatic differentiation of V of (12) along the graph of (11), not by the formula that is used."""
    import casadi as ca

    from lyapcheck.lyapunov import graph

    model, gain_set = robots.load("buap3"), TABLE2[2]
    run = paper_run(gain_set, eps0)
    held = ControlledArm(gain_set, model)
    loop = SetPoint(Setup(held, PAPER_TASK, 0.0), 2)
    q, w, e = loop.state[:3], loop.state[3:6], loop.target - loop.state[:3]
    mass, h, eps = (
        graph.matrix(graph.at_angles(model, q).mass()),
        held.family.casadi(e).h,
        eps0 / (1 + ca.norm_2(e)),
    )
    V = loop.energy - eps * ca.dot(h, mass @ w) + eps**2 * ca.dot(h, mass @ h) / 2
    both = ca.Function("V", [loop.state, loop.target], [V, ca.jtimes(V, loop.state, loop.rate)])
    states = np.hstack((run.q, run.w, np.zeros((run.t.size, 2)))).T
    known_V, known_dV = (np.array(x)[0] for x in both.map(run.t.size)(states, np.array(PAPER_TASK.q_d)))
    np.testing.assert_allclose(run.V, known_V, atol=1e-12)
    np.testing.assert_allclose(run.dV, known_dV, atol=1e-11)


def test_at_the_goal_nothing_moves():
    model = robots.load("buap3")
    run = simulate(TABLE2[0], model, [0.3, -0.2, 1.0], start_rad=[0.3, -0.2, 1.0], T=2.0, eps0=0.1)
    assert np.all(run.e == 0.0)
    assert np.all(run.V == 0.0)
    assert np.all(run.dV == 0.0)
    assert run.L2 == 0.0
    assert run.promises.V_decreases


def test_a_spent_budget_keeps_what_was_reached_and_marks_it():
    with pytest.raises(SimulationFailed, match="steps were not enough") as failure:
        simulate(gains(2), robots.load("reyes-kelly2"), [1.0, 1.0], T=5.0, max_steps=40)
    partial = failure.value.partial
    assert not partial.complete
    assert 1 < partial.t.size < 2001
    assert partial.t[-1] < 5.0
    assert math.isnan(partial.accuracy)
    assert ",no," in runs_csv([partial])


def test_a_solution_that_ends_in_finite_time_is_cut_short():
    """ẏ = y² from 1 is 1/(1 − t): it does not reach t = 2."""
    t = np.linspace(0.0, 2.0, 201)
    path = integrate(
        lambda _, y: y * y, lambda _, y: np.diag(2 * y), np.array([1.0]), t, 1e-9, max_steps=2000
    )
    assert path.failure is not None
    assert path.t[-1] <= 1.0
    np.testing.assert_allclose(path.y[:90, 0], 1 / (1 - path.t[:90]), rtol=1e-6)


BAD = [
    ({"target_rad": [1.0]}, "target_rad"),
    ({"target_rad": [math.nan, 0.0]}, "target_rad"),
    ({"target_rad": [1e9, 0.0]}, "target_rad"),
    ({"start_rad": [0.0, 0.0, 0.0]}, "start_rad"),
    ({"start_rad": [0.0, math.inf]}, "start_rad"),
    ({"velocity_rad": [math.nan, 0.0]}, "velocity_rad"),
    ({"velocity_rad": [1e4, 0.0]}, "velocity_rad"),
    ({"T": 0.0}, "T"),
    ({"T": -1.0}, "T"),
    ({"T": math.nan}, "T"),
    ({"T": math.inf}, "T"),
    ({"eps0": -0.1}, "eps0"),
    ({"eps0": math.nan}, "eps0"),
    ({"points": 1}, "points"),
    ({"points": 10**9}, "points"),
]


@pytest.mark.parametrize(("change", "key"), BAD, ids=[f"{key}-{i}" for i, (_, key) in enumerate(BAD)])
def test_impossible_requests_are_refused_by_name(change, key):
    request = {"target_rad": [1.0, 1.0], **change}
    with pytest.raises(InputError) as refused:
        simulate(gains(2), robots.load("reyes-kelly2"), **request)
    assert [problem.key for problem in refused.value.problems] == [key]


def test_an_arm_is_a_model_a_name_or_a_path(tmp_path):
    path = tmp_path / "arm.toml"
    path.write_text(robots.arm_text("pendulum1", tmp_path))
    gains = GainSet("g", 1, (Fraction(1),), (Fraction(1),))
    runs = [simulate_motion(gains, arm, seconds=0.1) for arm in ("pendulum1", path, robots.load("pendulum1"))]
    assert len({run.q.tobytes() for run in runs}) == 1
    file = tmp_path / "g.toml"
    file.write_text('[bounds]\ntorque = [9]\n[[gains]]\nname = "g"\nm = 1\nkp = [1]\nkv = [1]\n')
    assert simulate_motion(file, path, seconds=0.1).torque_limit == (9.0,)
