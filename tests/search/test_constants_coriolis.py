"""k_c from storage forms: the lifted states beside C, the bound beside boxes, and what must not pass."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from lyapcheck.constants import arm_constants
from lyapcheck.constants.storage import coriolis, first_joints, lift
from lyapcheck.constants.storage.exact import rounded
from lyapcheck.constants.storage.first_joints import RELATION, states
from lyapcheck.constants.storage.hinges import Hinge, hinges
from lyapcheck.robots.numeric import NumericModel
from tests.search.test_constants_storage import arm_of

BASIS = coriolis.Basis(lift.invariant_forms(), lift.relations(), lift.positive_products())


def products(twist: np.ndarray) -> np.ndarray:
    return rounded(lift.products(exactly(np.outer(twist, twist))))


def exactly(matrix: np.ndarray) -> np.ndarray:
    return np.vectorize(coriolis.fmpq_of, otypes=[object])(matrix)


def turned(angle: float) -> np.ndarray:
    c, s = np.cos(angle), np.sin(angle)
    return np.kron(np.eye(2), np.array([[c, s, 0], [-s, c, 0], [0, 0, 1]]))


def lifted_turn(angle: float) -> np.ndarray:
    return rounded(lift.carried(exactly(turned(angle))))


@pytest.mark.parametrize("name", ["leaning", "ur5"])
def test_the_power_of_the_links_is_that_of_coriolis_torques(name: str, tmp_path: Path) -> None:
    """zᵀC(q, x)x from the polynomials of M, beside the states handed from link to link."""
    arm = arm_of(name, tmp_path)
    step, rng = rounded(lift.step()), np.random.default_rng(1)
    q, x, z = rng.uniform(-3, 3, arm.n), rng.normal(size=arm.n), rng.normal(size=arm.n)
    state, twist, power = np.zeros(lift.STATE), np.zeros(6), 0.0
    for k, hinge in enumerate(hinges(arm.chain)[0]):
        state = lifted_turn(q[k]) @ rounded(lift.carried(hinge.carry)) @ state
        twist = turned(q[k]) @ rounded(hinge.carry) @ twist
        assert state[lift.W] == pytest.approx(products(twist), abs=1e-12)
        full = np.concatenate([state, [z[k]], twist * x[k], [x[k] ** 2]])
        assert max(abs(full @ form @ full) for form in BASIS.relations) < 1e-12 * max(1, full @ full)
        weighted = sum(form for (i, j), form in BASIS.positive.items() if i == j)
        assert full @ weighted @ full == pytest.approx(2 * state[lift.N] * (twist @ twist + x[k] ** 2))
        state = step @ full
        twist[2] += x[k]
        power += state @ rounded(lift.power(hinge.body)) @ state
    assert power / 2 == pytest.approx(z @ NumericModel(arm).coriolis(q, x) @ x, rel=1e-10)
    assert state[lift.N] == pytest.approx(x @ x)


def test_turning_forms_are_all_that_turns_leave_alone() -> None:
    turns = [lifted_turn(angle) for angle in (0.3, 1.1)]
    assert max(np.abs(turn.T @ form @ turn - form).max() for turn in turns for form in BASIS.own) < 1e-12
    assert np.linalg.matrix_rank([form.ravel() for form in BASIS.own]) == len(BASIS.own)
    # the dimension of the symmetric forms that a group leaves alone is the mean of its character on them
    angles = np.arange(16) * 2 * np.pi / 16
    traces = [(np.trace(lifted_turn(a)), np.trace(lifted_turn(2 * a))) for a in angles]
    assert len(BASIS.own) == pytest.approx(np.mean([(t * t + double) / 2 for t, double in traces]))


def test_the_first_two_joints_reach_what_the_states_say(tmp_path: Path) -> None:
    bodies = hinges(arm_of("leaning", tmp_path).chain)[0]
    step, angle = rounded(lift.step()), 0.7
    z0, z1, a, b = 0.3, -1.2, 0.8, 1.7
    first = step @ np.concatenate([np.zeros(lift.STATE), [z0], np.zeros(6), [a * a]])
    moved = lifted_turn(angle) @ rounded(lift.carried(bodies[1].carry)) @ first
    twist = turned(angle) @ rounded(bodies[1].carry) @ np.array([0, 0, a, 0, 0, 0])
    second = step @ np.concatenate([moved, [z1], twist * b, [b * b]])
    five = np.array([z0, z1, a * a, a * b, b * b])
    sine, cosine = coriolis.fmpq_of(np.sin(angle)), coriolis.fmpq_of(np.cos(angle))
    assert rounded(states(bodies, sine, cosine)) @ five == pytest.approx(second, abs=1e-12)
    assert five @ RELATION @ five == pytest.approx(0)


def holds(bodies: list[Hinge], basis: coriolis.Basis, x: np.ndarray, sector: tuple[float, float]) -> bool:
    """Whether forms prove their κ on a sector of q_2."""
    after = coriolis._stored(bodies, basis, x)
    return after is not None and first_joints.certain(bodies, coriolis.fmpq_of(float(x[0])), after, *sector)


@pytest.mark.slow
def test_the_bound_of_three_joints_beside_boxes(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(coriolis, "_SECTORS", 4)
    arm = arm_of("leaning", tmp_path)
    bound = coriolis.coriolis_bound(hinges(arm.chain)[0])
    (boxes,) = arm_constants(arm, 3000, names=("k_c",))
    assert boxes.enclosure.lower <= bound <= 1.3 * boxes.enclosure.upper


@pytest.mark.slow
def test_a_smaller_constant_does_not_hold(tmp_path: Path) -> None:
    bodies, sector = hinges(arm_of("leaning", tmp_path).chain)[0], (0.8, 0.4)
    x = coriolis.solve(coriolis._blocks(bodies, BASIS, sector), 1 + BASIS.each + 17, 1e-5)
    assert holds(bodies, BASIS, x, sector)
    for place, factor in ((0, 0.9), (3, 2.0), (slice(1, 1 + BASIS.each), 0.0)):
        changed = x.copy()
        changed[place] *= factor
        assert not holds(bodies, BASIS, changed, sector)


@pytest.mark.slow
def test_a_sector_says_nothing_of_the_others(tmp_path: Path) -> None:
    """The forms of a narrow sector fail elsewhere on the circle."""
    bodies = hinges(arm_of("leaning", tmp_path).chain)[0]
    x = coriolis.solve(coriolis._blocks(bodies, BASIS, (0.8, 0.1)), 1 + BASIS.each + 17, 1e-5)
    assert holds(bodies, BASIS, x, (0.8, 0.1))
    assert not holds(bodies, BASIS, x, (0.8, 3.2))


def test_too_few_joints(tmp_path: Path) -> None:
    assert coriolis.coriolis_bound(hinges(arm_of("pelican2", tmp_path).chain)[0]) is None


@pytest.mark.slow
def test_the_ur5_within_two_percent(tmp_path: Path) -> None:
    arm = replace(arm_of("ur5", tmp_path), name="ur5")
    (result,) = arm_constants(arm, 200_000 // 36, 0.02, names=("k_c",))
    assert result.gap <= 0.02
    # the best of half a minute of local searches
    assert result.enclosure.lower <= 2.5562663655 <= result.enclosure.upper
