"""The bench: encoders, hold, limits and dry friction, each against what it must do."""

from __future__ import annotations

import math
from dataclasses import replace
from fractions import Fraction

import numpy as np
import pytest

from lyapcheck import robots
from lyapcheck.control.gains import GainSet, paper_gain_file, read_gain_file
from lyapcheck.errors import InputError
from lyapcheck.robots import Number
from lyapcheck.simulate.bench import Bench, enough_substeps, stiff_periods
from lyapcheck.simulate.closed_loop import simulate
from lyapcheck.simulate.run import SimulationFailed
from lyapcheck.simulate.task import PAPER_TASK, set_up
from lyapcheck.simulate.trial import experiment
from tests.helpers.arm_texts import arm_of
from tests.helpers.shares import but

TABLE2 = (
    *read_gain_file(paper_gain_file("table2")).gains,
    *read_gain_file(paper_gain_file("table2_pd")).gains,
)


def number(value: str) -> Number:
    return Number(Fraction(value))


def frictionless(name: str, **changes):
    """The arm without dry friction and with perfect encoders."""
    model = robots.load(name)
    return replace(model, coulomb=(None,) * model.n, encoder=(None,) * model.n, **changes)


def table_run(gain_set: GainSet, **options):
    task = PAPER_TASK
    return experiment(gain_set, robots.load("buap3"), task.q_d, task.q0, task.w0, task.T, **options)


@pytest.mark.parametrize("gain_set", but([TABLE2[3]], [TABLE2[0], TABLE2[3]]), ids=lambda g: g.name)
def test_a_fast_perfect_bench_is_the_reference(gain_set):
    """Without friction and quantisation, the motion goes to that of (11) in proportion to the period."""
    model = frictionless("buap3")
    reference = simulate(gain_set, model, PAPER_TASK.q_d, T=1.0, points=101)
    gaps = []
    for period in (2e-3, 1e-3, 5e-4):
        run = experiment(gain_set, model, PAPER_TASK.q_d, T=1.0, bench=Bench(period=period))
        gaps.append(np.max(np.abs(run.q[:: round(0.01 / period)] - reference.q)))
    assert gaps[-1] < 5e-3
    assert gaps[0] / gaps[1] == pytest.approx(2.0, rel=0.2)
    assert gaps[1] / gaps[2] == pytest.approx(2.0, rel=0.2)


def test_torques_are_cut_at_the_limits_and_said_to_be():
    model = frictionless("buap3", torque_limit=(number("10"), number("150"), None))
    run = experiment(TABLE2[0], model, PAPER_TASK.q_d, T=1.0)
    assert run.peak_torque[0] == 10.0
    assert run.promises.inside_limits == (False, True, None)


def test_dry_friction_holds_a_joint_that_is_pushed_too_little():
    """Coulomb 7 N·m against a spring of 2 N·m at most: the joint stays, but for creep."""
    model = replace(robots.load("pendulum1"), coulomb=(number("7"),))
    gain_set = GainSet("weak", 1, (Fraction(2),), (Fraction(1),))
    run = experiment(gain_set, model, [1.0], T=2.0)
    assert np.max(np.abs(run.q)) < 2.0 * 1e-3 * math.atanh(2 / 7)
    free = experiment(gain_set, replace(model, coulomb=(None,)), [1.0], T=2.0)
    assert np.max(np.abs(free.q)) > 0.5


STIFF = arm_of(
    ("arm", (0, 1, 0), (0, 0, 0), 1, (0, 0, -0.1), 0.01, 1, {"coulomb": 1}),
    ("wrist", (0, 1, 0), (0, 0, -0.3), 0.1, (0, 0, -0.001), 1e-5, 0.02, {"coulomb": 0.1}),
)
"""A wrist of 1e-5 kg·m² on an arm of 0.02 kg·m²."""


@pytest.mark.slow
def test_a_stiff_arm_is_resolved(tmp_path):
    """Rates of 1e8 /s where dry friction is steep: 25,000 explicit steps in a period of 2.5 ms."""
    (tmp_path / "stiff.toml").write_text(STIFF)
    model = robots.load(str(tmp_path / "stiff.toml"))
    assert enough_substeps(model, Bench()) > 10_000
    gain_set = GainSet("fast", 1, (Fraction(10), Fraction(1)), (Fraction(1), Fraction("0.1")))
    run = experiment(gain_set, model, [0.8, 0.8], T=1.0)
    assert run.complete
    assert run.accuracy < 1e-3


@pytest.mark.slow
def test_both_ways_of_moving_the_arm_agree():
    setup = set_up(TABLE2[0], robots.load("buap3"), PAPER_TASK.q_d, None, None, T=1.0, eps0=None)
    states, torques = stiff_periods(setup, Bench(), 400, 1e-9)
    explicit = table_run(TABLE2[0])
    np.testing.assert_allclose(states[:, :3], explicit.q[:401], rtol=0, atol=1e-5)
    np.testing.assert_allclose(torques, explicit.tau[:400], rtol=0, atol=0.05)


def test_an_unstable_hold_is_cut_short_and_marked():
    """A damping gain far too large for the hold shakes the arm faster and faster."""
    wild = GainSet("wild", None, (Fraction(1),), (Fraction(10**6),), "linear")
    model = frictionless("pendulum1", torque_limit=(None,))
    with pytest.raises(SimulationFailed, match="runs away") as failure:
        experiment(wild, model, [1.0], T=5.0)
    partial = failure.value.partial
    assert not partial.complete
    assert np.all(np.isfinite(partial.q))
    assert 1 <= partial.t.size < 2001


def test_a_time_shorter_than_a_period_is_refused():
    with pytest.raises(InputError, match="shorter than one period"):
        experiment(TABLE2[0], robots.load("buap3"), PAPER_TASK.q_d, T=1e-3)
