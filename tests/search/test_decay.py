"""Certified decay of V, times and disturbances: what they must contain, and what they must refuse."""

from __future__ import annotations

import itertools
import json
import math
import sys
from dataclasses import replace
from fractions import Fraction
from functools import cache

import numpy as np
import pytest

from lyapcheck.check.kinds.decreasing import BoxTree, PositiveAndDecreasing, statement_of
from lyapcheck.check.kinds.inertia import Bisection, Dominance, MassAbove
from lyapcheck.check.kinds.phases import FallingPhases, StaysWithin
from lyapcheck.check.kinds.settling import require_signs
from lyapcheck.check.loop.closed_loop import RateProof
from lyapcheck.check.loop.decay.estimate import Disturbance, Estimate
from lyapcheck.check.loop.decay.least import Well
from lyapcheck.check.loop.decay.margin import Margin
from lyapcheck.check.numbers.members import member
from lyapcheck.check.refusal import Refused
from lyapcheck.check.statement import Proof
from lyapcheck.check.verify import verify
from lyapcheck.cli.main import main
from lyapcheck.control.gains import GainSet, read_gain_file
from lyapcheck.control.paper import paper_gain_file
from lyapcheck.errors import InputError
from lyapcheck.lyapunov.numeric import LyapunovNumeric
from lyapcheck.robots import load
from lyapcheck.search.controlled_arm import ControlledArm
from lyapcheck.search.decay.bounds import disturbance_bound, settling_bound
from lyapcheck.search.decay.descent import level_within
from lyapcheck.search.decay.heaviest import heaviest
from lyapcheck.search.decay.margins import Attempt, attempts, margin_at
from lyapcheck.simulate.disturbed import DisturbedRun, disturbed
from tests.arena.extra import DOMINANT
from tests.helpers.shares import but, one_in

F = Fraction
TABLE = {"buap3": "table2", "reyes-kelly2": "table2_shoulder_elbow"}
CASES = [(robot, index) for robot in TABLE for index in range(3)]
GOAL = {1: (0.5,), 2: (math.pi / 4, math.pi / 2), 3: (math.pi / 4, math.pi / 4, math.pi / 2)}
DELTA = math.radians(10.0)


@cache
def controlled(robot: str, index: int) -> ControlledArm:
    return ControlledArm(read_gain_file(paper_gain_file(TABLE[robot])).gains[index], load(robot))


def single(robot: str, m: int = 1) -> ControlledArm:
    """Gains of some size for any arm."""
    model = load(robot)
    kp, kv = (F(10),) * model.n, (F(1, 4),) * model.n
    gains = GainSet(name="made", family="hyperbolic", m=m, kp=kp, kv=kv)
    return ControlledArm(gains, model)


LIMIT = {"buap3": (F("0.134"), F("0.166"), F("0.104")), "reyes-kelly2": (F("0.81"), F("0.92"), F("0.63"))}
"""Just below an ε₀ that an explicit state refutes."""


def shown(margin: Margin, positive: Proof, by: RateProof) -> bool:
    """Whether the checker takes the margin."""
    try:
        require_signs(margin)
        above = verify(statement_of(margin.loop).mass_below(margin.heaviest), Bisection())
        below = verify(statement_of(margin.reduced), PositiveAndDecreasing(positive, by))
        return above.verdict == below.verdict == "proved"
    except Refused:
        return False


@cache
def accepted(robot: str, index: int) -> Attempt:
    """A margin with η = 1/4 at less than half of what is refuted."""
    at = controlled(robot, index)
    heavy = heaviest(at)
    assert heavy is not None
    tried = attempts(at, margin_at(at, LIMIT[robot][index] / 2, F(1, 4), F(0), heavy.diagonal))
    return next(one for one in tried if shown(one.margin, at.inertia_proof, one.by))


def goal(at: ControlledArm) -> tuple[float, ...]:
    return GOAL[at.n]


@cache
def run(robot: str, index: int, T: float = 20.0, torque: float = 0.0, dry: bool = False) -> DisturbedRun:
    at = controlled(robot, index)
    friction = [float(c.value) for c in at.model.coulomb if c is not None] if dry else ()
    push = [torque] * at.n
    return disturbed(at.gains, at.model, goal(at), T=T, torque=push, dry=friction, points=401)


def level_along(at: ControlledArm, eps0: Fraction, motion: DisturbedRun) -> np.ndarray:
    numeric = LyapunovNumeric(at.model, at.family, list(at.kp), list(at.kv), float(eps0))
    return numeric.V(motion.q, motion.e, motion.w)


@pytest.mark.parametrize(("robot", "index"), one_in(5, CASES))
def test_dV_dt_is_below_the_margin_at_random_states(robot: str, index: int) -> None:
    at, margin = controlled(robot, index), accepted(robot, index).margin
    random = np.random.default_rng(7)
    q, w = random.uniform(-np.pi, np.pi, (2000, at.n)), random.normal(size=(2000, at.n)) * 3
    e = random.normal(size=(2000, at.n)) * 10.0 ** random.uniform(-2, 1, (2000, 1))
    eps0, eta, kappa = (float(x) for x in (margin.loop.eps0, margin.friction, margin.stiffness))
    rate = LyapunovNumeric(at.model, at.family, list(at.kp), list(at.kv), eps0).rate(q, e, w)
    eps = eps0 / (1 + np.linalg.norm(e, axis=1, keepdims=True))
    h = at.family.h(e)
    y = w - eps * h
    bound = np.sum(eta * at.viscous * y * w + kappa * eps * at.kp * h * h, axis=1)
    assert np.all(-rate >= bound * (1 - 1e-9))
    smaller = LyapunovNumeric(at.model, at.family, list((1 - kappa) * at.kp), list(at.kv), eps0)
    smaller.viscous = [(1 - eta) * b for b in at.viscous]
    assert np.allclose(rate, smaller.rate(q, e, w) - bound, rtol=1e-9, atol=1e-9)


@pytest.mark.parametrize(("robot", "index"), one_in(5, CASES))
def test_V_of_a_run_stays_under_the_envelope(robot: str, index: int) -> None:
    at, result = controlled(robot, index), accepted(robot, index)
    estimate = Estimate(result.margin, Disturbance.none(at.n))
    start = tuple(map(F, goal(at))), (F(0),) * at.n
    motion = run(robot, index)
    V = level_along(at, result.margin.loop.eps0, motion)
    first = estimate.start_level(*start)
    assert V[0] <= first
    assert np.all(float(first) * (1 + 1e-9) >= V)
    reach = np.array(estimate.reach(first))
    assert np.all(np.abs(motion.e) <= reach)


def local_level_along(at: ControlledArm, eps0: float, motion: DisturbedRun) -> np.ndarray:
    """V with ε = ε₀ at every state."""
    y = motion.w - eps0 * at.family.h(motion.e)
    kinetic = 0.5 * np.einsum("ki,kij,kj->k", y, at.numeric.mass(motion.q), y)
    return np.asarray(kinetic + at.family.potential(motion.e) @ at.kp)


@pytest.mark.slow
def test_errors_die_out_as_the_statement_says() -> None:
    """Exponentially for m = 1, and like a power of time where h is flat."""
    for m in (1, 2):
        at = single("pendulum1", m)
        result = settling_bound(at, (0.3,), delta=0.1)
        assert result.shown is not None
        statement = result.shown.statement
        assert isinstance(statement, StaysWithin)
        assert statement.after is not None
        motion = disturbed(at.gains, at.model, (0.3,), T=float(result.time or 0) + 40.0, points=801)
        late = motion.t >= float(statement.within[-1][0])
        elapsed = (motion.t[late] - float(statement.within[-1][0])) / float(statement.after.scale)
        falling = np.exp(-elapsed) if m == 1 else (1 + elapsed) ** -0.5
        allowed = np.outer(falling, np.array(statement.after.sizes, dtype=float))
        assert late.any()
        assert np.all(np.abs(motion.e[late]) <= allowed + 1e-9)


@pytest.mark.slow
@pytest.mark.parametrize(("robot", "index"), one_in(2, [("reyes-kelly2", 1), ("buap3", 0)]))
def test_the_time_bound_is_kept_by_the_run(robot: str, index: int) -> None:
    at = controlled(robot, index)
    result = settling_bound(at, goal(at), delta=DELTA)
    assert result.time is not None
    assert result.rests_on is not None
    motion = run(robot, index)
    outside = np.abs(motion.e).max(axis=1) > DELTA
    late = motion.t[outside]
    assert late.size == 0 or late[-1] <= result.time
    assert result.shown is not None
    statement, proof = result.shown.statement, result.shown.proof
    assert isinstance(statement, StaysWithin)
    assert isinstance(proof, FallingPhases)
    for time, errors in statement.within:
        assert np.all(np.abs(motion.e[motion.t >= time]) <= np.array(errors, dtype=float))
    for phase in proof.phases:
        V = local_level_along(at, float(phase.eps0), motion)
        times, levels = (np.array([float(x[k]) for x in phase.envelope]) for k in (0, 1))
        assert np.all(np.diff(times) > 0)
        assert np.all(np.diff(levels) < 0)
        late = motion.t >= times[0]
        allowed = levels[np.searchsorted(times, motion.t[late], side="right") - 1]
        assert np.all(allowed * (1 + 1e-9) >= V[late])
        speeds = np.abs(motion.w[late]) + 1e-12
        assert np.all(at.family.h(speeds) >= np.array(phase.floors, dtype=float) * speeds)
    assert result.exponential == (at.gains.m == 1)


@pytest.mark.parametrize("robot", one_in(2, ["pendulum1", "pelican2"]))
def test_other_arms_have_bounds(robot: str) -> None:
    at = single(robot)
    result = settling_bound(at, goal(at), delta=DELTA)
    motion = disturbed(at.gains, at.model, goal(at), T=20.0, points=401)
    late = motion.t[np.abs(motion.e).max(axis=1) > DELTA]
    assert result.time is not None
    assert float(result.time) >= late[-1]


@pytest.mark.slow
def test_gains_that_are_too_small_have_no_bound_and_a_reason() -> None:
    tiny = (F(1, 10**9),)
    arm = ControlledArm(GainSet("tiny", 1, tiny, tiny), load("pendulum1"))
    result = settling_bound(arm, [0.5], delta=0.01, max_boxes=20)
    assert result.time is None
    assert result.reason


@pytest.mark.slow
def test_an_arm_of_one_joint_is_bounded_sharply_enough_to_be_of_use() -> None:
    at = single("pendulum1")
    result = settling_bound(at, goal(at), delta=math.radians(1.0))
    assert result.time is not None
    assert result.time < 60


@pytest.mark.slow
def test_a_smaller_angle_or_a_farther_start_takes_longer() -> None:
    at, result = controlled("reyes-kelly2", 0), accepted("reyes-kelly2", 0)
    times = [settling_bound(at, goal(at), delta=x).time for x in (0.4, 0.1)]
    assert all(a is not None and b is not None and a < b for a, b in itertools.pairwise(times))
    estimate = Estimate(result.margin, Disturbance.none(2))
    near, far = ((F(1, 2), F(1, 2)), (F(0),) * 2), ((F(1), F(1)), (F(1),) * 2)
    assert estimate.start_level(*near) < estimate.start_level(*far)
    assert level_within(estimate, F(1, 10)) < level_within(estimate, F(1, 5))


@pytest.mark.slow
@pytest.mark.parametrize(("robot", "index"), one_in(2, [("reyes-kelly2", 2), ("buap3", 0)]))
def test_runs_with_dry_friction_come_inside(robot: str, index: int) -> None:
    at = controlled(robot, index)
    friction = [c.value for c in at.model.coulomb if c is not None]
    result = disturbance_bound(at, goal(at), dry=friction)
    assert result.level is not None
    assert result.rests_on is not None
    assert result.start_level is not None
    motion = run(robot, index, dry=True)
    V = level_along(at, result.rests_on.eps0, motion)
    assert V[-1] <= result.level < result.start_level
    assert np.all(np.abs(motion.e[-1]) <= np.array(result.errors))
    # the regularised friction lets joints creep, so what is at rest is only reached slowly
    assert all(x is not None and x <= y for x, y in zip(result.rest, result.errors, strict=True))


@pytest.mark.slow
def test_a_run_with_a_constant_torque_comes_inside() -> None:
    at = controlled("reyes-kelly2", 0)
    result = disturbance_bound(at, goal(at), torque=[0.05, 0.05])
    motion = run("reyes-kelly2", 0, T=100.0, torque=0.05)
    assert result.level is not None
    assert np.all(np.abs(motion.e[-1]) <= np.array(result.errors))
    resting = np.array([x for x in result.rest if x is not None])
    assert np.all(np.abs(motion.e[-1]) <= resting * (1 + 1e-6) + 1e-6)


@pytest.mark.slow
def test_more_disturbance_leaves_more() -> None:
    at = controlled("reyes-kelly2", 0)
    levels = [disturbance_bound(at, goal(at), torque=[x, x]).level for x in (0.02, 0.05)]
    assert levels[0] is not None
    assert levels[1] is not None
    assert levels[0] < levels[1]


@pytest.mark.slow
def test_a_torque_that_moves_the_arm_away_from_its_goal_is_bounded() -> None:
    at = controlled("reyes-kelly2", 0)
    result = disturbance_bound(at, [0.0, 0.0], torque=[0.05, 0.05])
    motion = disturbed(at.gains, at.model, goal(at), goal(at), T=20.0, torque=[0.05, 0.05], points=101)
    assert len(result.largest_errors) == 2
    assert np.abs(motion.e).max() > 0
    assert np.all(np.abs(motion.e) <= np.array([float(x) for x in result.largest_errors]))


@pytest.mark.slow
def test_a_disturbance_beyond_k_pi_has_no_bound() -> None:
    at = controlled("reyes-kelly2", 0)
    result = disturbance_bound(at, goal(at), dry=[61, 6])
    assert result.level is None
    assert result.errors == ()
    assert "too large" in result.reason
    assert result.resting is None
    assert result.rest == (None, None)


def test_the_least_value_of_a_well_is_below_all_samples() -> None:
    from lyapcheck.check.numbers.balls import to_arb

    x = np.linspace(0.0, 6.0, 3001)
    for m, c, f, a in ((1, 1.0, 0.3, 0.4), (2, 2.0, 0.0, 0.5), (3, 1.5, 0.6, 0.05), (8, 3.0, 0.0, 1.0)):
        family = ControlledArm(replace(controlled("reyes-kelly2", 0).gains, m=m), load("reyes-kelly2")).family
        well = Well(member("hyperbolic", m), to_arb(F(c)), to_arb(F(f)), to_arb(F(a)))
        sampled = float(np.min(c * family.h(x) ** 2 - f * family.h(x) - a * family.potential(x)))
        least = float(well.least(6.0))
        assert sampled - 1e-3 <= least <= sampled + 1e-9


def test_a_margin_that_is_too_large_is_refused() -> None:
    at, result = controlled("reyes-kelly2", 0), accepted("reyes-kelly2", 0)
    margin = result.margin
    assert shown(margin, at.inertia_proof, result.by)
    assert not shown(replace(margin, friction=F(19, 20)), at.inertia_proof, result.by)
    assert not shown(replace(margin, stiffness=F(1)), at.inertia_proof, result.by)
    assert not shown(replace(margin, split=F(3, 5), slack=F(2, 5)), at.inertia_proof, result.by)
    assert not shown(
        margin_at(at, F(1), margin.friction, F(0), margin.heaviest), at.inertia_proof, BoxTree(".")
    )


@pytest.mark.parametrize("robot", but(["pendulum1"], ["pendulum1", "reyes-kelly2"]))
def test_a_diagonal_below_m_is_refused(robot: str) -> None:
    at = single(robot)
    heavy = heaviest(at)
    assert heavy is not None
    statement = statement_of(at.loop(F(1, 100)))
    assert verify(statement.mass_below(heavy.diagonal), Bisection()).verdict == "proved"
    with pytest.raises(Refused):
        verify(statement.mass_below(tuple(u / 2 for u in heavy.diagonal)), Bisection())


@pytest.mark.parametrize("robot", ["buap3", "reyes-kelly2", "pelican2"])
def test_the_diagonal_above_m_is_in_proportion_to_the_friction(robot: str) -> None:
    at = single(robot)
    heavy = heaviest(at)
    assert heavy is not None
    M = at.numeric.mass(np.random.default_rng(1).uniform(-math.pi, math.pi, (2_000, at.n)))
    above = np.diag([float(u) for u in heavy.diagonal])
    assert np.linalg.eigvalsh(above - M).min() > 0
    ratios = [float(u) / b for u, b in zip(heavy.diagonal, at.viscous, strict=True)]
    assert max(ratios) <= 1.0001 * min(ratios)


def test_weights_show_a_dominant_diagonal() -> None:
    assert verify(MassAbove(DOMINANT, (), F(0)), Dominance((F(4), F(5)))).verdict == "proved"
    for weights in ((F(1), F(1)), (F(1), F(2)), (F(-4), F(-5)), (F(4),)):
        with pytest.raises(Refused):
            verify(MassAbove(DOMINANT, (), F(0)), Dominance(weights))
    with pytest.raises(Refused):
        verify(MassAbove(DOMINANT, (), F(1)), Dominance((F(4), F(5))))


def test_a_slope_beyond_its_end_and_levels_out_of_order_are_refused() -> None:
    margin: Margin = accepted("reyes-kelly2", 0).margin
    estimate = Estimate(margin, Disturbance.none(2))
    with pytest.raises(ValueError, match="λ"):
        estimate.fall(F(1), F(2), 2 * estimate.steepest)
    with pytest.raises(ValueError, match="order"):
        estimate.fall(F(2), F(1), F(0))
    with pytest.raises(ValueError, match="share"):
        Estimate(margin, Disturbance((F(1), F(1)), (F(0), F(0))))
    assert estimate.fall(F(1), F(2), F(0)) <= 0


def test_unusable_requests_are_all_named() -> None:
    at = controlled("reyes-kelly2", 0)
    with pytest.raises(InputError) as caught:
        settling_bound(at, [math.nan, 0.0], [0.0], delta=-1.0)
    assert {problem.key for problem in caught.value.problems} == {"e0", "w0", "delta"}
    with pytest.raises(InputError):
        disturbance_bound(at, [0.1, 0.1], torque=[-1.0, 0.0])
    pd = ControlledArm(read_gain_file(paper_gain_file("table2_pd")).gains[0], load("buap3"))
    with pytest.raises(InputError, match="unbounded"):
        settling_bound(pd, [0.1, 0.1, 0.1])


@pytest.mark.slow
def test_the_command_prints_bounds_beside_the_run(monkeypatch, capsys, tmp_path) -> None:
    gains = tmp_path / "gains.toml"
    gains.write_text(
        'robot = "reyes-kelly2"\n[[gains]]\nname = "one"\nm = 1\nkp = [60, 5]\nkv = [0.2, 0.2]\n'
    )
    asked = ["bounds", str(gains), "--target", "45,90", "--delta", "10", "--disturbance", "0.01,0.01"]
    code, out, _ = command([*asked, "--format", "json", "--friction", "0,0"], monkeypatch, capsys)
    data = json.loads(out)
    assert code == 0
    assert data["schema"] == "lyapcheck/bounds/1"
    for result in data["results"]:
        assert result["settling"]["time"] >= (result["simulated"]["time"] or 0.0)
        assert result["disturbance"]["level"] > 0


def test_the_command_refuses_what_it_cannot_use(monkeypatch, capsys) -> None:
    gains = str(paper_gain_file("table2_shoulder_elbow"))
    code, _, err = command(["bounds", gains, "--delta", "0"], monkeypatch, capsys)
    assert code == 2
    assert "--target" in err
    assert "--delta" in err
    code, _, err = command(["bounds", gains, "--target", "1,1", "--disturbance", "a,b"], monkeypatch, capsys)
    assert code == 2
    assert "--disturbance" in err


def command(arguments: list[str], monkeypatch, capsys) -> tuple[int, str, str]:
    monkeypatch.setattr(sys, "argv", ["lyapcheck", *arguments])
    with pytest.raises(SystemExit) as left:
        main()
    return int(left.value.code or 0), *capsys.readouterr()
