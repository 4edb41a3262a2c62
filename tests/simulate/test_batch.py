"""Many runs at once: the same motions as one at a time, by two engines, whatever their company."""

from dataclasses import fields, replace
from fractions import Fraction

import numpy as np
import pytest

from lyapcheck import robots
from lyapcheck.control.gains import GainSet, paper_gain_file, read_gain_file
from lyapcheck.lyapunov.compiler import OFF, compiler
from lyapcheck.robots.numeric import NumericModel
from lyapcheck.search.controlled_arm import ControlledArm
from lyapcheck.simulate import many as batch_module
from lyapcheck.simulate import results as indices
from lyapcheck.simulate.closed_loop import simulate
from lyapcheck.simulate.many import Runs, simulate_many
from lyapcheck.simulate.task import PAPER_TASK
from tests.helpers.shares import but

TABLE2 = (
    *read_gain_file(paper_gain_file("table2")).gains,
    *read_gain_file(paper_gain_file("table2_pd")).gains,
)
ENGINE = "numpy" if compiler() is None else "compiled"
SHOULDER_AND_ELBOW = GainSet("two", 2, TABLE2[1].kp[1:], TABLE2[1].kv[1:])


def gains(n, m=2, family="hyperbolic", kp=10, kv=2):
    return GainSet("set", m, (Fraction(kp),) * n, (Fraction(kv),) * n, family)


def starts(n, count, size=2.0):
    return np.random.default_rng(11).uniform(-size, size, (count, n))


@pytest.fixture
def no_compiler(monkeypatch):
    monkeypatch.setenv(OFF, "1")


def torques(gain_set, model, q, e, w):
    """τ of (6) at states (N, n)."""
    made = ControlledArm(gain_set, model)
    return made.family.h(e) * made.kp - made.family.h(w) * made.kv + NumericModel(model).gravity(q)


def assert_same(one, other):
    for entry in fields(Runs):
        a, b = getattr(one, entry.name), getattr(other, entry.name)
        if isinstance(a, np.ndarray):
            assert np.array_equal(a, b, equal_nan=a.dtype.kind == "f"), entry.name
        else:
            assert a == b, entry.name


FAMILIES = [(m, "hyperbolic") for m in (1, 3)] + [
    (None, h) for h in ("tanh", "arctan", "algebraic", "linear")
]


@pytest.mark.parametrize(("m", "family"), but([(None, "arctan")], FAMILIES))
def test_every_family_moves_as_it_does_alone(m, family):
    model, gain_set = robots.load("reyes-kelly2"), gains(2, m, family, kp=40, kv=12)
    single = simulate(gain_set, model, [0.5, -1.0], [1.0, 1.0], T=2.0, points=201, stop=False)
    many = simulate_many(gain_set, model, [0.5, -1.0], [1.0, 1.0], 2.0, points=201, motions=True)
    np.testing.assert_allclose(many.q[0], single.q, rtol=0, atol=1e-8)
    np.testing.assert_allclose(many.w[0], single.w, rtol=0, atol=1e-8)
    np.testing.assert_allclose(many.settling[0], single.settling, rtol=1e-2)


@pytest.mark.slow
def test_extremes_lie_between_samples_and_are_those_of_a_much_finer_sampling():
    """With two samples a run: peaks, overshoots and settling times of 20,001 samples, 0.1 ms apart."""
    model, gain_set, q_d = robots.load("reyes-kelly2"), gains(2, 1, kp=40, kv=4), np.array([0.5, -1.0])
    first = starts(2, 3)
    many = simulate_many(gain_set, model, q_d, first, 2.0, points=2)
    fine = simulate_many(gain_set, model, q_d, first[:1], 2.0, points=20_001, motions=True)
    e = q_d - fine.q[0]
    tau = torques(gain_set, model, fine.q[0], e, fine.w[0])
    np.testing.assert_allclose(many.peak_torque[0], np.max(np.abs(tau), axis=0), rtol=1e-6)
    np.testing.assert_allclose(many.overshoot[0], indices.overshoots(e), rtol=1e-5, atol=1e-9)
    np.testing.assert_allclose(many.settling[0], indices.settling_times(fine.t, e), rtol=1e-6)
    assert np.any(many.overshoot > 0)
    single = simulate(gain_set, model, q_d, first[2], T=2.0, points=2, stop=False)
    np.testing.assert_allclose(many.peak_torque[2], single.peak_torque, rtol=1e-8)
    np.testing.assert_allclose(many.overshoot[2], single.overshoot, rtol=1e-8, atol=1e-9)


@pytest.mark.slow
def test_both_engines_find_the_same_motions(request):
    model, first = robots.load("buap3"), starts(3, 9)

    def run():
        return simulate_many(TABLE2[:3] * 3, model, PAPER_TASK.q_d, first, 0.4, motions=True)

    runs = run()
    request.getfixturevalue("no_compiler")
    by_numpy = run()
    assert (runs.engine, by_numpy.engine) == (ENGINE, "numpy")
    for name in ("q", "w", "V", "L2", "peak_torque", "settling", "overshoot"):
        np.testing.assert_allclose(getattr(runs, name), getattr(by_numpy, name), rtol=1e-8, atol=1e-8)
    np.testing.assert_allclose(runs.steps, by_numpy.steps, atol=12)


def test_a_run_does_not_depend_on_its_company(monkeypatch):
    """Other controllers and goals beside it, another place in the batch, smaller batches: equal bits."""
    model, count = robots.load("reyes-kelly2"), 5
    random = np.random.default_rng(2)
    sets = [gains(2, int(m), kp=5 + k) for k, m in enumerate(random.integers(1, 4, count))]
    q_d, first, w0 = (random.uniform(-1, 1, (count, 2)) for _ in range(3))
    together = simulate_many(sets, model, q_d, first, 1.0, w0=w0, motions=True)
    for k in (0, count - 1):
        alone = simulate_many(sets[k], model, q_d[k], first[k], 1.0, w0=w0[k], motions=True)
        assert np.array_equal(alone.q[0], together.q[k])
        assert np.array_equal(alone.settling[0], together.settling[k], equal_nan=True)
    monkeypatch.setattr(batch_module, "_NUMBERS_AT_ONCE", 10_000)
    assert_same(simulate_many(sets, model, q_d, first, 1.0, w0=w0, motions=True), together)


@pytest.mark.slow
def test_arms_beside_each_other_move_as_each_alone():
    """One that differs in friction, which goes with the others, and one that differs in its links."""
    model, one = robots.load("reyes-kelly2"), gains(2)
    damped = replace(model, viscous=tuple(replace(b, value=3 * b.value) for b in model.viscous))
    arms, first = [model, damped, robots.load("pelican2"), model, damped], starts(2, 5)
    together = simulate_many([one] * 5, arms, [0.5, -1.0], first, 1.0, motions=True)
    assert not np.array_equal(together.w[0], together.w[1])
    for k, arm in enumerate(arms):
        alone = simulate_many(one, arm, [0.5, -1.0], first[k], 1.0, motions=True)
        row = {name: x[k : k + 1] for name, x in vars(together).items() if name not in ("t", "engine")}
        assert_same(replace(together, **row, engine=alone.engine), alone)


@pytest.mark.parametrize("engine", ["default", "numpy"])
def test_a_run_that_fails_is_marked_and_stops_no_other(engine, request):
    if engine == "numpy":
        request.getfixturevalue("no_compiler")
    model, q_d = robots.load("reyes-kelly2"), [0.5, 0.5]
    first = np.array([q_d, [30.0, -20.0], q_d])
    runs = simulate_many(SHOULDER_AND_ELBOW, model, q_d, first, 5.0, max_steps=60, motions=True)
    assert list(runs.complete) == [True, False, True]
    assert runs.failure == ("", "the steps allowed were not enough", "")
    assert runs.steps[1] == 60
    reached = np.isfinite(runs.q[1, :, 0])
    assert reached[0]
    assert not reached[-1]
    assert np.all(np.diff(reached.astype(int)) <= 0)
    assert np.isnan(runs.L2[1])
    assert np.isnan(runs.peak_torque[1]).all()
    assert np.isnan(runs.settling[1]).all()
    assert np.all(runs.L2[[0, 2]] < 1e-6)
