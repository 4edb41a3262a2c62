"""Promises along a run: kept ones are silent, broken ones stop it with a state that proves them broken."""

from dataclasses import replace
from fractions import Fraction

import numpy as np
import pytest

from lyapcheck import robots
from lyapcheck.check.numbers.balls import precision
from lyapcheck.control.gains import paper_gain_file, read_gain_file
from lyapcheck.robots import Number
from lyapcheck.search.controlled_arm import ControlledArm
from lyapcheck.search.falsify import falsify
from lyapcheck.simulate.breach import at_balls, beyond_norm, first_breach, rise_of_V
from lyapcheck.simulate.closed_loop import simulate
from lyapcheck.simulate.run import PromiseBroken, Sample
from lyapcheck.simulate.task import PAPER_TASK

TABLE2 = read_gain_file(paper_gain_file("table2")).gains
TWO_JOINTS = read_gain_file(paper_gain_file("table2_shoulder_elbow")).gains


def broken(gain_set, model, *task, **options):
    with pytest.raises(PromiseBroken) as stopped:
        simulate(gain_set, model, *task, **options)
    return stopped.value


@pytest.mark.slow
def test_an_eps0_above_the_falsified_one_is_stopped_at_its_witness():
    """The state that refutes ε₀ is a start; the promise breaks there and nowhere else is looked at."""
    model, gain_set = robots.load("reyes-kelly2"), TWO_JOINTS[0]
    witness = falsify(ControlledArm(gain_set, model), starts=6, samples=2000)
    at = [[float(x) for x in part] for part in (witness.state.q, witness.state.e, witness.state.w)]
    speed = max(map(abs, at[2]))
    at[2] = [900 * rate / speed for rate in at[2]]  # fast enough for K_v h(w) to be small beside B w
    goal = [q + e for q, e in zip(at[0], at[1], strict=True)]
    eps0 = float(witness.eps0) * 1.02
    failure = broken(gain_set, model, goal, at[0], at[2], 0.02, eps0=eps0)
    assert failure.breach.index == 0
    assert failure.breach.confirmed
    assert failure.breach.at.q == tuple(at[0])
    assert failure.breach.at.w == tuple(at[2])
    kept = simulate(gain_set, model, goal, at[0], at[2], 0.02, eps0=eps0 / 2)
    assert kept.complete
    assert kept.breach is None


@pytest.mark.slow
def test_a_limit_that_breaks_between_samples_is_found():
    """The elbow's peak lies inside the run; a motor a little weaker is found too weak, in balls."""
    model = robots.load("buap3")
    run = simulate(TABLE2[0], model, PAPER_TASK.q_d, points=2)
    peaks = [Number(Fraction(float(x)) * Fraction("0.9999")) for x in run.peak_torque]
    assert np.all(np.abs(run.tau[:, 1:]).max(axis=0) < 0.99 * run.peak_torque[1:])
    for joint in (1, 2):
        limits = (*model.torque_limit[:joint], peaks[joint], *model.torque_limit[joint + 1 :])
        failure = broken(TABLE2[0], replace(model, torque_limit=limits), PAPER_TASK.q_d, points=2)
        assert failure.breach.confirmed
        assert model.joints[joint] in failure.breach.promise
        assert failure.partial.promises.inside_limits[joint] is False
        assert failure.partial.t[-1] == failure.breach.t


@pytest.mark.slow
def test_a_torque_exactly_at_its_limit_is_no_breach():
    """Balls decide: the limit is the torque of the start, rounded up."""
    at = Sample((0.0,) * 3, PAPER_TASK.q_d, (0.0,) * 3)
    with precision(64):
        start = at_balls(ControlledArm(TABLE2[0], robots.load("buap3")), at).torque()[0]
    limit = Fraction(float(start)) + Fraction(1, 10**15)
    tight = replace(robots.load("buap3"), torque_limit=(Number(limit), None, None))
    assert simulate(TABLE2[0], tight, PAPER_TASK.q_d).breach is None


def breach_of(V, tau, most=None):
    """The first breach of a run with other samples of V and τ."""
    run = simulate(TABLE2[0], robots.load("buap3"), PAPER_TASK.q_d, T=0.1, points=len(V))
    run = replace(run, V=np.array(V), tau=np.array(tau))
    return first_breach((rise_of_V(run), beyond_norm(run, "a bound", most)))


def test_the_earliest_breach_is_the_one_that_is_told():
    quiet, loud = [0.0, 0.0, 0.0], [0.0, 3.0, 4.0]
    assert breach_of([3.0, 2.0, 2.5], [quiet, quiet, quiet], 4.9).index == 2
    both = breach_of([3.0, 2.0, 2.5], [quiet, loud, quiet], 4.9)
    assert (both.index, both.value, both.confirmed) == (1, 5.0, False)
    assert breach_of([3.0, 2.0, 2.0], [quiet, quiet, quiet], 4.9) is None
