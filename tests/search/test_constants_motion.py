"""k_c along a chain with a certificate: the power beside C, the bound beside boxes, what must not pass."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import replace
from fractions import Fraction as F
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from lyapcheck.check.kinds.chain_coriolis import ChainCoriolisBelow, MotionForms
from lyapcheck.check.kinds.inertia import PostureWitness
from lyapcheck.check.loop.motion import HEAD, JOINT, LINEAR, coriolis_power, is_definite
from lyapcheck.check.loop.storage import hinges
from lyapcheck.check.numbers.vectors import Algebra
from lyapcheck.check.refusal import Refused
from lyapcheck.check.statement import Proof
from lyapcheck.check.verify import verify
from lyapcheck.claims.moving_arm import coriolis_bounded
from lyapcheck.claims.procedures import propose
from lyapcheck.constants import arm_constants
from lyapcheck.constants.storage import storage_proof
from lyapcheck.constants.storage.bounds import BoundWithProof
from lyapcheck.robots import load
from lyapcheck.robots.numeric import NumericModel
from lyapcheck.verdicts import Verdict
from tests.helpers.committed import ROOT
from tests.search.test_constants_storage import arm_of


def refused(statement: ChainCoriolisBelow, proof: Proof) -> bool:
    try:
        return verify(statement, proof).verdict != "proved"
    except Refused:
        return True


def shown_for(name: str, folder: Path) -> tuple[ChainCoriolisBelow, MotionForms]:
    shown = storage_proof(arm_of(name, folder).chain, "k_c")
    assert isinstance(shown, BoundWithProof)
    assert isinstance(shown.statement, ChainCoriolisBelow)
    assert isinstance(shown.proof, MotionForms)
    return shown.statement, shown.proof


@pytest.mark.parametrize("name", ["leaning", "ur5"])
def test_the_power_along_the_links_is_that_of_coriolis_torques(name: str, tmp_path: Path) -> None:
    arm = arm_of(name, tmp_path)
    q, x, z = np.random.default_rng(1).uniform(-3, 3, (3, arm.n))
    power = coriolis_power(Algebra(float), hinges(arm.chain.links), *(np.sin(q), np.cos(q)), z, x)
    assert power == pytest.approx(2 * z @ NumericModel(arm).coriolis(q, x) @ x, rel=1e-10)


def test_two_joints_lose_nothing_and_every_change_is_refused(tmp_path: Path) -> None:
    arm = arm_of("pelican2", tmp_path)
    statement, proof = shown_for("pelican2", tmp_path)
    exact = arm_constants(arm, 2000, names=["k_c"])[0].enclosure
    assert exact.lower <= statement.high <= exact.upper * F(101, 100)
    assert refused(replace(statement, high=statement.high * F(999, 1000)), proof)
    # the polynomials are those of one bound
    assert refused(replace(statement, high=statement.high * F(1001, 1000)), proof)
    assert refused(replace(statement, links=statement.links[:1]), proof)
    link = statement.links[1]
    for other in (replace(link, mass=link.mass * 2), replace(link, axis=tuple(-x for x in link.axis))):
        assert refused(replace(statement, links=(statement.links[0], other)), proof)
    for changed in changes(proof):
        assert refused(statement, changed)


def changes(proof: MotionForms) -> Iterator[MotionForms]:
    """One entry of one matrix a little larger; matrices too few, or of another size."""
    yield replace(proof, first=nudged(proof.first, 3, 2))
    yield replace(proof, first=proof.first[:-1])
    yield replace(proof, first=tuple((*row, F(0)) for row in proof.first))
    yield replace(proof, first=tuple(tuple(-x for x in row) for row in proof.first))
    yield replace(proof, joints=(*proof.joints, (proof.first, proof.first)))
    for k, (squares, counted) in enumerate(proof.joints):
        rest = proof.joints[k + 1 :]
        yield replace(proof, joints=(*proof.joints[:k], *rest))
        # of Z_z², A_z², z², N² and N V_z²: what turns leave alone is not enough
        for i in (2, 8, 12, 41):
            yield replace(proof, joints=(*proof.joints[:k], (nudged(squares, i, i), counted), *rest))
        yield replace(proof, joints=(*proof.joints[:k], (squares, nudged(counted, 2, 2)), *rest))
        # ω_x² against ω_y², a form that turns change
        uneven = nudged(nudged(squares, 13, 13), 20, 20, -1)
        yield replace(proof, joints=(*proof.joints[:k], (uneven, counted), *rest))


def nudged(matrix: Any, i: int, j: int, sign: int = 1) -> Any:
    rows = [list(row) for row in matrix]
    rows[i][j] += sign * rows[i][i] / 10**12
    return tuple(map(tuple, rows))


@pytest.mark.slow
def test_three_joints_with_skew_axes(tmp_path: Path) -> None:
    arm = arm_of("leaning", tmp_path)
    statement, proof = shown_for("leaning", tmp_path)
    exact = arm_constants(arm, 4000, names=["k_c"])[0].enclosure
    assert exact.lower <= statement.high <= exact.upper * F(6, 5)
    assert refused(replace(statement, high=statement.high * F(999, 1000)), proof)
    for changed in changes(proof):
        assert refused(statement, changed)
    # what is moved between pairs with the same product changes no polynomial
    squares, counted = proof.joints[0]
    assert JOINT[13] * JOINT[20] == JOINT[14] * JOINT[14]
    moved = nudged(squares, 20, 13)
    rows = [list(row) for row in moved]
    rows[14][14] -= 2 * (moved[20][13] - squares[20][13])
    bent = replace(proof, joints=((tuple(map(tuple, rows)), counted),))
    assert verify(statement, bent).verdict == "proved"


def test_sizes_of_matrices() -> None:
    assert (len(JOINT), len(LINEAR), len(HEAD)) == (42, 7, 25)
    assert not is_definite((), LINEAR)
    assert is_definite(((F(1),),), LINEAR[:1])
    assert not is_definite(((F(0),),), LINEAR[:1])


def test_one_joint_has_no_such_proof_and_zero_is_refuted_of_two(tmp_path: Path) -> None:
    links = arm_of("pelican2", tmp_path).chain.links
    with pytest.raises(Refused, match="two or more"):
        verify(ChainCoriolisBelow(links[:1], F(1)), MotionForms((), ()))
    at = PostureWitness((F(0), F(1)), (), (F(1), F(1)))
    assert verify(ChainCoriolisBelow(links, F(0)), at).verdict == "refuted"
    assert refused(ChainCoriolisBelow(links, F(1)), at)
    with pytest.raises(Refused, match="y none"):
        verify(ChainCoriolisBelow(links, F(0)), replace(at, y=(F(1), F(1))))
    with pytest.raises(Refused):
        verify(ChainCoriolisBelow(links, F(-1)), at)


@pytest.mark.parametrize("times", [F(1), F(101, 100), F(2), F(100)])
def test_any_larger_bound_is_proved(times: F, tmp_path: Path) -> None:
    statement, _ = shown_for("pelican2", tmp_path)
    larger = replace(statement, high=statement.high * times)
    result = propose(larger)
    assert result.proof is not None
    assert verify(larger, result.proof).verdict == "proved"


def test_a_bound_that_is_too_small_is_refuted_by_a_posture(tmp_path: Path) -> None:
    statement, _ = shown_for("pelican2", tmp_path)
    smaller = replace(statement, high=statement.high * F(9, 10))
    result = propose(smaller)
    assert result.verdict is Verdict.REFUTED
    assert result.proof is not None
    assert verify(smaller, result.proof).verdict == "refuted"


@pytest.mark.slow
def test_property_26_of_many_joints_has_the_bound_of_the_constant() -> None:
    arm = load(str(ROOT / "examples" / "px100.toml"))
    statement = coriolis_bounded(arm)
    (constant,) = arm_constants(arm, names=["k_c"])
    assert constant.shown is not None
    assert type(statement) is type(constant.shown.statement)
    assert constant.shown.bound < statement.high < F(1003, 1000) * constant.shown.bound
    assert propose(statement).verdict is Verdict.PROVED
