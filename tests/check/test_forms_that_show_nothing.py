"""Proofs of k_c of which one condition alone does not hold."""

from __future__ import annotations

from dataclasses import replace
from fractions import Fraction as F
from typing import Any

import numpy as np
import pytest
from flint import arb, arb_mat

from lyapcheck.check.kinds.chain_coriolis import ChainCoriolisBelow, MotionForms
from lyapcheck.check.kinds.inertia import PostureWitness
from lyapcheck.check.loop.chain import RigidLink
from lyapcheck.check.loop.control_points import children, definite_at_all_angles, nodes
from lyapcheck.check.loop.head import PARTS, Head, stored_form
from lyapcheck.check.loop.motion import COUNT, JOINT, LINEAR, RATE, SPEED, STATE
from lyapcheck.check.loop.storage import hinges
from lyapcheck.check.refusal import Refused
from lyapcheck.check.verify import verify
from lyapcheck.constants.extreme import extreme
from lyapcheck.constants.storage import motion as storage_motion
from lyapcheck.constants.storage import storage_proof
from lyapcheck.constants.storage.postures import Postures, exact_rows
from lyapcheck.robots.dynamics import Chain
from lyapcheck.robots.number import Number
from lyapcheck.robots.plant import Plant
from tests.helpers.forgotten import forget_bounds

UNIT = ((F(1), F(0), F(0)), (F(0), F(1), F(0)), (F(0), F(0), F(1)))
AHEAD, AXIS = (F(1), F(0), F(0)), (F(0), F(0), F(1))
CROSSED = ((F(1), F(0), F(0)), (F(0), F(0), F(-1)), (F(0), F(1), F(0)))


def chain(n: int) -> tuple[RigidLink, ...]:
    return tuple(
        RigidLink(AXIS, AHEAD if k else (F(0),) * 3, F(1), AHEAD, UNIT, CROSSED if k % 2 else UNIT)
        for k in range(n)
    )


@pytest.fixture(scope="module")
def shown() -> Any:
    """Of four joints, two of them taken together."""
    with pytest.MonkeyPatch.context() as patch:
        patch.setitem(storage_motion.FIRST, 4, 2)
        forget_bounds()
        result = storage_proof(Chain(chain(4), (F(0),) * 3), "k_c")
        forget_bounds()
    assert result is not None
    return result.statement, result.proof


def refused(statement: ChainCoriolisBelow, proof: Any) -> bool:
    try:
        return verify(statement, proof).verdict != "proved"
    except Refused:
        return True


def plus(matrix: Any, i: int, j: int, by: F) -> Any:
    return tuple(
        tuple(x + by if (a, b) == (i, j) else x for b, x in enumerate(row)) for a, row in enumerate(matrix)
    )


@pytest.mark.parametrize("term", [RATE, SPEED**2], ids=["z", "x"])
def test_what_is_handed_on_is_of_the_state_alone(shown: Any, term: Any) -> None:
    """z², or x⁴, of the last joint, as if it were that of the joint before."""
    statement, proof = shown
    i = JOINT.index(term)
    (p, q), (r, s) = proof.joints
    by = min(p[i][i], r[i][i]) / 10**9
    assert not refused(statement, proof)
    changed = replace(proof, joints=((plus(p, i, i, -by), q), (plus(r, i, i, by), s)))
    assert refused(statement, changed)


def test_both_matrices_of_a_joint_must_be_definite(shown: Any) -> None:
    """N x² taken from one matrix and given to the other: the forms are the same polynomials."""
    statement, proof = shown
    count, square, last = JOINT.index(COUNT), JOINT.index(SPEED**2), len(LINEAR) - 1

    def shifted(by: F) -> MotionForms:
        (p, q), *others = proof.joints
        return replace(proof, joints=((plus(p, count, square, -by / 2), plus(q, last, last, by)), *others))

    assert not refused(statement, shifted(F(1, 10**12)))
    q = proof.joints[0][1]
    full = np.array([[float(q[max(i, j)][min(i, j)]) for j in range(7)] for i in range(7)])
    spare = F(1 / np.linalg.inv(full)[last, last])
    assert refused(statement, shifted(-spare * F(101, 100)))  # Q is not
    assert refused(statement, shifted(F(10**6)))  # P is not


def test_what_balls_leave_open_is_not_shown() -> None:
    for ball in (arb(0), arb(0, 1), arb(1, 2), arb("nan")):
        assert not definite_at_all_angles([[ball]] * 9, 4, (9,), ())
    assert definite_at_all_angles([[arb(1, 1e-9)]] * 9, 4, (9,), ())


def test_children_by_hand() -> None:
    assert children([(1, 5)], 1, 1, 20) == [(1, 9), (1, 10), (1, 11), (1, 12)]
    assert children([(0, 3)], 0, 1, 8) == [(0, 3), (1, 3), (2, 3), (7, 3)]


@pytest.mark.parametrize(
    "term", [STATE[12] ** 3 * STATE[0], STATE[12] ** 5, STATE[12] * STATE[0] * STATE[18]]
)
def test_odd_powers_of_speeds_are_no_form(term: Any) -> None:
    with pytest.raises(Refused, match="a form of the motion"):
        stored_form({powers[: len(STATE)]: c for powers, c in term.to_dict().items()})


@pytest.mark.parametrize(
    "change",
    [
        {"mass": F(-1)},
        {"axis": (F(0), F(0), F(2))},
        {"turn": ((F(1), F(1), F(0)), (F(0), F(1), F(0)), (F(0), F(0), F(1)))},
        {"turn": ((F(1), F(0), F(0)), (F(0), F(1), F(0)), (F(0), F(0), F(-1)))},
        {"inertia": ((F(-1), F(0), F(0)), (F(0), F(1), F(0)), (F(0), F(0), F(1)))},
    ],
)
def test_links_that_are_none(change: dict[str, Any]) -> None:
    first, second = chain(2)
    at = PostureWitness((F(0), F(1)), (), (F(1), F(1)))
    with pytest.raises(Refused, match="must have a unit axis, a rotation"):
        verify(ChainCoriolisBelow((first, replace(second, **change)), F(0)), at)


@pytest.mark.parametrize("size", [F(1, 10), F(1), F(10)])
def test_the_bound_that_a_posture_refutes(size: F) -> None:
    """Two bodies at distance 1: C(q, x)x = sin q₂ (−2x₁x₂ − x₂², x₁²) has length √2 at x = (−1, 1)."""
    links = tuple(replace(link, turn=UNIT) for link in chain(2))
    nothing = tuple((F(0),) * 3 for _ in range(3))
    links = tuple(replace(link, inertia=nothing) for link in links)
    at = PostureWitness((F(0), F(11, 7)), (), (-size, size))
    reached = F(707, 1000)
    assert verify(ChainCoriolisBelow(links, reached * F(99, 100)), at).verdict == "refuted"
    assert refused_by(ChainCoriolisBelow(links, reached * F(101, 100)), at)


def refused_by(statement: ChainCoriolisBelow, at: PostureWitness) -> bool:
    try:
        verify(statement, at)
    except Refused:
        return True
    return False


def test_start_has_a_number_for_each_angle(shown: Any) -> None:
    statement, proof = shown
    for start in ((), (24, 24)):
        with pytest.raises(Refused, match="must be 1 numbers"):
            verify(statement, replace(proof, start=start))
    with pytest.raises(Refused, match="must leave 2 to 5 joints"):
        verify(ChainCoriolisBelow(chain(6), F(1)), replace(proof, kappa=F(1), joints=()))
    with pytest.raises(Refused, match="must leave 2 to 4 joints"):
        verify(ChainCoriolisBelow(chain(7), F(1)), replace(proof, kappa=F(1)))


def test_what_is_handed_on_is_left_as_it_is_by_turns(shown: Any) -> None:
    """ω_x² against ω_y²: a polynomial of the state alone, and the matrix is still definite."""
    statement, proof = shown
    (p, q), *others = proof.joints
    first, second = (JOINT.index(STATE[i] ** 2) for i in (12, 13))
    by = min(p[first][first], p[second][second]) / 10**12
    uneven = plus(plus(p, first, first, by), second, second, -by)
    assert refused(statement, replace(proof, joints=((uneven, q), *others)))


def test_degree_two_is_enough_where_nothing_is_handed_on_and_there_alone(shown: Any) -> None:
    links = chain(2)
    reached = extreme(
        Plant(name="two", joints=("a", "b"), dynamics=Chain(links, (F(0),) * 3), viscous=(Number(F(0)),) * 2),
        "k_c",
    ).value
    head = Head(hinges(links), 2, F(0), arb_mat(PARTS, PARTS))
    count = np.zeros((PARTS, PARTS))
    count[-1, -1] = 1.0
    for degree in (2, 3, 4):
        postures = Postures([head.posture(angles) for angles in nodes(degree, 1)], degree, 1)
        bound = reached * F(101, 100)
        result = postures.shown(float(bound), -float(bound) * count)
        assert result is not None
        proof = MotionForms(bound, (), exact_rows(result[0]), *result[1:])
        assert not refused(ChainCoriolisBelow(links, bound), proof)
        assert refused(
            ChainCoriolisBelow(links, reached * F(999, 1000)), replace(proof, kappa=reached * F(999, 1000))
        )
    statement, behind = shown
    for rows in (5, 7):
        with pytest.raises(Refused, match="must be 9 rows"):
            verify(statement, replace(behind, relations=behind.relations[:rows]))
