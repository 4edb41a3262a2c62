"""Weights Λ in y = w − εΛh: what is proved with them, and what is refused."""

from __future__ import annotations

from dataclasses import replace
from fractions import Fraction
from functools import cache

import numpy as np
import pytest

from lyapcheck.check.kinds.decreasing import BoxTree, StateWitness, statement_of
from lyapcheck.check.loop.arithmetic import BALLS
from lyapcheck.check.loop.proof import proves
from lyapcheck.check.loop.schur import Evaluator
from lyapcheck.check.numbers.balls import precision
from lyapcheck.check.refusal import Refused
from lyapcheck.check.verify import verify
from lyapcheck.control.gains import read_gain_file
from lyapcheck.control.paper import paper_gain_file
from lyapcheck.family import named
from lyapcheck.robots import load
from lyapcheck.robots.numeric import NumericModel
from lyapcheck.search.controlled_arm import ControlledArm
from lyapcheck.search.weights import Weighted, weighted_epsilon
from tests.helpers.shares import one_in

F = Fraction
CERTIFIED = {0: F("0.802"), 1: F("0.917"), 2: F("0.629")}
"""What is proved with Λ = I on the two-joint arm."""


def controlled(index: int) -> ControlledArm:
    return ControlledArm(
        read_gain_file(paper_gain_file("table2_shoulder_elbow")).gains[index], load("reyes-kelly2")
    )


@cache
def weighted(index: int) -> Weighted:
    result = weighted_epsilon(controlled(index), CERTIFIED[index], max_boxes=60_000)
    assert result is not None
    return result


@pytest.mark.parametrize("index", one_in(3, [0, 1, 2]))
def test_some_joint_gains_much_and_the_product_grows(index: int) -> None:
    result = weighted(index)
    assert max(result.products) > F(13, 10) * CERTIFIED[index]
    assert np.prod([float(x) for x in result.products]) > float(CERTIFIED[index]) ** 2
    assert min(result.proof.loop.Lambda) == 1


def test_P_over_boxes_holds_P_with_weights() -> None:
    case, loop = controlled(0), weighted(0).proof.loop
    model, family = NumericModel(case.model), named("hyperbolic", 1)
    scale, eps0 = np.array([float(x) for x in loop.Lambda]), float(loop.eps0)
    random, L = np.random.default_rng(3), float(family.constants().L.upper)
    with precision(64):
        evaluator = Evaluator(loop, BALLS)
        for _ in range(100):
            q, e = random.uniform(-3, 3, 2), random.uniform(-2, 2, 2)
            h, dh, r = scale * family.h(e), scale * family.dh(e), float(np.linalg.norm(e))
            M, B, eps = model.mass(q), np.diag(model.viscous), eps0 / (1 + r)
            S = model.coriolis(q, h) + np.outer(M @ h, e / r) / (1 + r) - M @ np.diag(dh)
            X = B + eps * S
            K = np.diag(1 / (case.kp / scale - eps0 * L * case.kv / 4))
            exact = B + eps * (S + S.T) / 2 - eps / 4 * X.T @ K @ X
            box = tuple((float(x) - 1e-4, float(x) + 1e-4) for x in (q[1], *e))
            P = evaluator.schur(box[:1], box[1:], ())
            for i in range(2):
                for j in range(i + 1):
                    assert float(P[i][j].lower()) <= exact[i, j] <= float(P[i][j].upper())


def test_larger_weights_are_refused_for_the_same_tree() -> None:
    proof = weighted(0).proof
    assert isinstance(proof.by, BoxTree)
    loop = proof.loop
    assert proves(loop, proof.by.tree)
    for factors in ((2, 1), (1, 2), (2, 2)):
        coupling = tuple(x * f for x, f in zip(loop.Lambda, factors, strict=True))
        assert not proves(replace(loop, coupling=coupling), proof.by.tree)


def test_certificates_hold_the_weights() -> None:
    proof = weighted(0).proof
    assert verify(proof.statement, proof.certificate).verdict == "proved"
    for coupling in ((F(1),), (F(-1), F(1)), (F(0), F(1))):
        with pytest.raises(Refused):
            verify(statement_of(replace(proof.loop, coupling=coupling)), proof.certificate)


def test_states_are_about_no_weights() -> None:
    loop, nothing = weighted(0).proof.loop, (F(0), F(0))
    witness = StateWitness((F(1), F(1)), (), nothing, (F(1), F(1)), nothing)
    with pytest.raises(Refused):
        verify(statement_of(loop), witness)
