"""Weights Λ in y = w − εΛh: what is proved with them, and what is refused."""

from dataclasses import replace
from fractions import Fraction
from functools import cache

import numpy as np
import pytest

from lyapcheck.answers.epsilon.compute import epsilon
from lyapcheck.check.kinds.decreasing import BoxTree, statement_of
from lyapcheck.check.loop.field import BALLS
from lyapcheck.check.loop.schur import Evaluator
from lyapcheck.check.numbers.balls import precision
from lyapcheck.check.refusal import Refused
from lyapcheck.check.verify import verify
from lyapcheck.control.gains import GainSet, paper_gain_file, read_gain_file
from lyapcheck.robots import load
from lyapcheck.search.certified import certify
from lyapcheck.search.controlled_arm import ControlledArm
from lyapcheck.search.schur import SchurProblem
from lyapcheck.search.weights import Effort, resisting_program, weighted_epsilon
from tests.helpers.schur import schur_of

pytestmark = pytest.mark.slow
F = Fraction
CERTIFIED = {0: F("0.802"), 1: F("0.917"), 2: F("0.629")}
"""What is proved with Λ = I on the two-joint arm."""


def controlled(index):
    return ControlledArm(
        read_gain_file(paper_gain_file("table2_shoulder_elbow")).gains[index], load("reyes-kelly2")
    )


@cache
def weighted(index):
    return weighted_epsilon(controlled(index), certified(index), Effort(boxes=60_000))


def certified(index, share="1"):
    """The proof with Λ = I for a share of what is known."""
    case = controlled(index)
    loop = case.loop(CERTIFIED[index] * F(share))
    found = certify(SchurProblem(loop), 60_000)
    assert found.proved
    accepted = case.proof(loop, BoxTree(found.tree)).accepted()
    assert accepted is not None
    return accepted


@pytest.mark.parametrize("index", [0, 1, 2])
def test_some_joint_gains_much_and_the_product_grows(index):
    result = weighted(index)
    assert max(result.products) > F(13, 10) * CERTIFIED[index]
    assert np.prod([float(x) for x in result.products]) > float(CERTIFIED[index]) ** 2
    assert min(result.proof.loop.Lambda) == 1


def test_the_identity_is_the_answer_where_nothing_better_is_accepted():
    identity = certified(0, "1/2")
    result = weighted_epsilon(controlled(0), identity, Effort(turns=1, boxes=0))
    assert result.proof is identity
    assert result.products == (identity.loop.eps0, identity.loop.eps0)
    assert "the budget of boxes is spent" in result.reason


def test_casadi_finds_where_weights_fail_worse_than_samples_do():
    """P at the ends of the climb, from the definition of S; some starts are moved to smaller eigenvalues."""
    case, weights = controlled(0), np.array([0.9, 1.5])
    program, random = resisting_program(case), np.random.default_rng(5)
    starts = np.hstack([random.uniform(-2, 2, (6, 4)), random.normal(size=(6, 2))])
    ends = program.climb(starts, weights)
    before, after = (np.array([least(case, weights, row) for row in rows]) for rows in (starts, ends))
    assert (after < before + 1e-6).all()
    assert (after < before - 0.05).any()


def least(case, weights, row):
    """λmin(B^−½ P B^−½) at (q, e)."""
    P, root = schur_of(case.model, case.gains, 1.0, row[:2], row[2:4], weights), np.sqrt(case.numeric.viscous)
    return float(np.linalg.eigvalsh(P / np.outer(root, root))[0])


def test_P_over_boxes_holds_P_with_weights():
    case, loop = controlled(0), weighted(0).proof.loop
    scale, eps0 = np.array([float(x) for x in loop.Lambda]), float(loop.eps0)
    random = np.random.default_rng(3)
    with precision(64):
        evaluator = Evaluator(loop, BALLS)
        for _ in range(100):
            q, e = random.uniform(-3, 3, 2), random.uniform(-2, 2, 2)
            exact = schur_of(case.model, case.gains, eps0, q, e, scale)
            box = tuple((float(x) - 1e-4, float(x) + 1e-4) for x in (q[1], *e))
            P = evaluator.schur(box[:1], box[1:], ())
            for i in range(2):
                for j in range(i + 1):
                    assert float(P[i][j].lower()) <= exact[i, j] <= float(P[i][j].upper())


def test_certificates_hold_the_weights():
    proof = weighted(0).proof
    assert verify(proof.statement, proof.certificate).verdict == "proved"
    for coupling in ((F(1),), (F(-1), F(1)), (F(0), F(1))):
        with pytest.raises(Refused):
            verify(statement_of(replace(proof.loop, coupling=coupling)), proof.certificate)


def test_epsilon_seeks_weights_unless_told_not_to():
    case = controlled(0)
    few = {"max_boxes": 4000, "starts": 2}
    usual = epsilon(case.gains, case.model, **few)
    assert usual.weighted is not None
    assert usual.certified is not None
    assert np.prod([float(x) for x in usual.weighted.products]) >= float(usual.certified) ** 2
    assert usual.data()["results"][0]["weighted"]["lambda"][0] is not None
    assert "with weights, y = w − εΛh" in usual.written("text")
    without = epsilon(case.gains, case.model, weights=False, **few)
    assert without.weighted is None
    assert without.certified == usual.certified


def test_one_joint_has_no_weights_to_choose():
    result = epsilon(pendulum(), load("pendulum1"), max_boxes=2000, starts=2)
    assert result.certified is not None
    assert result.weighted is None


def pendulum():
    return GainSet(name="a", family="hyperbolic", m=1, kp=(F(3),), kv=(F(1, 5),))
