"""dV/dt < 0 within limits: accepted, held against random states and motions, refused where more is said."""

from __future__ import annotations

import json
from dataclasses import replace
from fractions import Fraction
from typing import Any

import numpy as np
import pytest
from scipy.integrate import solve_ivp

from lyapcheck.answers.epsilon import StateLimits, epsilon
from lyapcheck.answers.epsilon.certificates import certificates
from lyapcheck.check.certificate import judge, parse, read
from lyapcheck.check.codec import from_json
from lyapcheck.check.kinds.decreasing import BoxTree, StateWitness
from lyapcheck.check.kinds.inertia import Bisection
from lyapcheck.check.kinds.nearby import DecreasingNearby, SlowerAndNearer
from lyapcheck.check.refusal import Refused
from lyapcheck.check.statement import Proof, Statement
from lyapcheck.check.verify import verify
from lyapcheck.control.gains import GainSet, read_gain_file
from lyapcheck.control.paper import paper_gain_file
from lyapcheck.robots import load
from lyapcheck.search.certified import certified_epsilon
from lyapcheck.search.controlled_arm import ControlledArm
from lyapcheck.search.nearby import NearbyArm, NearbyProof, falsify_nearby, with_motions
from tests.arena.run import ARENA
from tests.helpers.command import invoke

F = Fraction
SPEEDS, ERRORS = (F(3), F(4)), (F(1), F(3, 2))


def arena(name: str) -> tuple[Any, Any]:
    """A statement of the arena and its proof."""
    data = json.loads((ARENA / "good" / f"{name}.json").read_text(encoding="utf-8"))
    return from_json(Statement, data["statement"], "statement"), from_json(Proof, data["proof"], "proof")


def verdict(statement: Statement, proof: Proof) -> str:
    try:
        return verify(statement, proof).verdict
    except Refused:
        return "refused"


def test_more_than_is_proved_is_refused():
    statement, proof = arena("ext.nearby")
    assert verdict(statement, proof) == "proved"
    more = [
        {"speeds": (F(11, 10),)},  # the floor does not hold there
        {"speeds": ()},
        {"energy": F(9, 20) + F(1, 1000)},  # ½ ν W² is 9/20
        {"energy": F(434, 1000), "errors": (F(99, 100),)},  # U(0.99) < 0.434
        {"everywhere": replace(statement.everywhere, eps0=F(9, 5))},
        {"everywhere": replace(statement.everywhere, viscous=((F(1, 2), F(1)),))},
    ]
    for change in more:
        assert verdict(replace(statement, **change), proof) == "refused", change
    less = [{"speeds": (F(9, 10),), "energy": F(3, 10)}, {"errors": (F(19, 20),), "energy": None}]
    for change in less:
        assert verdict(replace(statement, **change), proof) == "proved", change


@pytest.mark.parametrize("value", [F(0), F(-1), F(10**12)])
def test_limits_that_are_none_are_refused(value: Fraction):
    statement, proof = arena("ext.nearby")
    for name in ("speeds", "errors"):
        assert verdict(replace(statement, **{name: (value,)}), proof) == "refused"
        assert verdict(replace(statement, **{name: (F(1), F(1))}), proof) == "refused"
    assert verdict(replace(statement, energy=value), proof) == "refused"
    assert verdict(replace(statement, speeds=(), errors=()), proof) == "refused"
    weighted = replace(statement.everywhere, coupling=(F(1),))
    assert verdict(replace(statement, everywhere=weighted), proof) == "refused"


def test_a_state_refutes_only_limits_that_it_is_within():
    statement, proof = arena("ext.not-nearby")
    assert verdict(statement, proof) == "refuted"
    assert verdict(replace(statement, speeds=(F(99, 100),)), proof) == "refused"
    assert verdict(replace(statement, speeds=()), proof) == "refuted"
    assert verdict(statement, replace(proof, e=(F(101, 100),))) == "refused"


@pytest.fixture(scope="module")
def near() -> NearbyArm:
    gains = GainSet(name="damped", family="hyperbolic", m=1, kp=(F(60), F(6)), kv=(F(20), F(2)))
    return NearbyArm.of(ControlledArm(gains, load("reyes-kelly2")), SPEEDS, ERRORS)


@pytest.fixture(scope="module")
def made(near: NearbyArm) -> NearbyProof:
    result = certified_epsilon(near, F(4), 20_000, shares=(F(3, 10), F(2, 5))).proof
    assert isinstance(result, NearbyProof)
    return with_motions(near, result)


def states(near: NearbyArm, count: int, faster: float = 1.0) -> tuple[Any, Any, Any]:
    """q, e and w at random, within the limits, or that much faster; many at their ends."""
    random = np.random.default_rng(5)
    ends = [float(x) for limits in (ERRORS, SPEEDS) for x in limits]
    parts = np.clip(random.uniform(-1.4, 1.4, (count, 4)), -1, 1) * np.array(ends)
    return random.uniform(-np.pi, np.pi, (count, 2)), parts[:, :2], parts[:, 2:] * faster


def rates(near: NearbyArm, eps0: float, q: Any, e: Any, w: Any) -> Any:
    """dV/dt from V at two neighbouring states on the motion itself, without (15)."""

    def energy(q: Any, e: Any, w: Any) -> Any:
        eps = eps0 / (1 + np.linalg.norm(e, axis=1, keepdims=True))
        y = w - eps * np.tanh(e)
        kinetic = np.einsum("ki,kij,kj->k", y, near.numeric.mass(q), y) / 2
        return kinetic + np.log(np.cosh(e)) @ near.kp

    torque = near.kp * np.tanh(e) - near.kv * np.tanh(w) - near.viscous * w
    torque -= np.einsum("kij,kj->ki", near.numeric.coriolis(q, w), w)
    a, step = np.linalg.solve(near.numeric.mass(q), torque[..., None])[..., 0], 1e-6
    after, before = (energy(q + s * w, e - s * w, w + s * a) for s in (step, -step))
    return (after - before) / (2 * step)


def test_v_falls_at_random_states_within_the_limits_and_not_at_all_states(near: NearbyArm, made: NearbyProof):
    eps0 = float(made.loop.eps0)
    assert made.accepted()
    assert np.max(rates(near, eps0, *states(near, 20_000))) < 0
    assert np.max(rates(near, eps0, *states(near, 20_000, 100.0))) > 0


@pytest.mark.slow
def test_motions_with_less_energy_keep_within_the_limits(near: NearbyArm, made: NearbyProof):
    most = made.stated.energy
    assert most is not None

    def slope(t: float, x: Any) -> Any:
        q, e, w = x[None, :2], x[None, 2:4], x[None, 4:]
        torque = near.kp * np.tanh(e) - near.kv * np.tanh(w) - near.viscous * w
        torque -= np.einsum("kij,kj->ki", near.numeric.coriolis(q, w), w)
        return np.concatenate([w[0], -w[0], np.linalg.solve(near.numeric.mass(q)[0], torque[0])])

    q, e, w = states(near, 12)
    limits = np.array([float(x) for x in (*ERRORS, *SPEEDS)])[:, None]
    for row in range(12):
        start = np.concatenate([q[row], e[row], w[row]])
        while True:
            kinetic = start[4:] @ near.numeric.mass(start[None, :2])[0] @ start[4:] / 2
            if kinetic + near.kp @ np.log(np.cosh(start[2:4])) <= float(most):
                break
            start[2:] *= 0.95
        run = solve_ivp(slope, (0, 6), start, rtol=1e-8, atol=1e-10).y[2:]
        assert np.all(np.abs(run) <= limits)
        assert np.max(np.abs(run[:, -1])) < 0.5 * np.max(np.abs(run[:, 0]))


@pytest.mark.slow
def test_the_falsified_one_is_within_the_limits_and_above_the_certified_one(
    near: NearbyArm, made: NearbyProof
):
    witness = falsify_nearby(near, starts=3)
    assert witness is not None
    assert witness.eps0 > made.loop.eps0
    state = witness.state
    assert all(abs(x) <= y for x, y in zip((*state.e, *state.w), (*ERRORS, *SPEEDS), strict=True))
    against = StateWitness(near.arm.viscous, (), state.q, state.e, state.w)
    assert verdict(near.statement(witness.eps0), against) == "refuted"


def test_the_statement_says_that_it_is_local(near: NearbyArm):
    text = near.statement(F(1)).text()
    assert "|w_i| ≤ (3, 4) rad/s and |e_i| ≤ (1, 1.5) rad" in text
    assert "nothing is said of other states" in text
    assert "globally" not in text
    assert "tends to the origin" not in text
    assert "tends to the origin" in replace(near.statement(F(1)), energy=F(1)).text()


def test_a_proof_without_floors_still_counts_where_only_errors_are_limited():
    statement, proof = arena("ext.nearby")
    everywhere = replace(statement.everywhere, eps0=F(1, 10))
    whole = DecreasingNearby(everywhere, (), (F(1),), F(2, 5))
    plain = SlowerAndNearer(Bisection(), (F(0),), BoxTree("."), (), ())
    assert verdict(whole, plain) == "proved"
    assert verdict(whole, replace(plain, floors=proof.floors)) == "refused"


@pytest.mark.parametrize("limit", ["0", "-5", "nan", "inf", "1e9", "10,20,30", ","])
def test_limits_that_no_motion_has_are_refused_in_words(limit: str):
    for option in ("--max-speed", "--max-error"):
        done = invoke("epsilon", str(paper_gain_file("table2_shoulder_elbow")), f"{option}={limit}")
        assert done.exit_code == 2
        assert f"{option} = " in str(done.exception)


@pytest.mark.slow
def test_the_command_says_what_holds_within_limits_and_writes_it():
    file = read_gain_file(paper_gain_file("table2_shoulder_elbow"))
    limits = StateLimits(SPEEDS, ERRORS)
    result = epsilon(file.gains[0], "reyes-kelly2", max_boxes=20_000, limits=limits)
    near = result.nearby
    assert near is not None
    assert near.certified is not None
    assert near.falsified is not None
    assert result.certified < near.certified < near.falsified
    data = result.data()["results"][0]["nearby"]
    assert data["max_speed"] == ["3", "4"]
    assert "nothing is said of other states" in data["statement"]
    made = certificates(result)
    for name, expected in (("certified", "proved"), ("falsified", "refuted")):
        certificate = read(parse(made[f"tau_m1.nearby.{name}.json"].text()))
        assert judge(certificate).verdict == expected
    assert "no global stability" in result.written("text").replace("\n  ", " ")
