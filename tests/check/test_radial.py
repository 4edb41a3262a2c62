"""Proofs in ‖e‖ alone: what they bound, and what they must refuse."""

from __future__ import annotations

from dataclasses import replace
from fractions import Fraction
from functools import cache

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from lyapcheck.check.kinds.decreasing import PositiveAndDecreasing, statement_of
from lyapcheck.check.loop.boxes import BrokenTree
from lyapcheck.check.loop.closed_loop import ClosedLoop, root_above
from lyapcheck.check.loop.radial import BITS, Inequality, Parts, RadialBounds, proves_radially
from lyapcheck.check.loop.rank_one import rank_one_bound
from lyapcheck.check.numbers.balls import precision
from lyapcheck.check.refusal import Refused
from lyapcheck.check.verify import verify
from lyapcheck.control.gains import GainSet, read_gain_file
from lyapcheck.control.paper import paper_gain_file
from lyapcheck.family import named
from lyapcheck.robots import load
from lyapcheck.robots.numeric import NumericModel
from lyapcheck.search.controlled_arm import ControlledArm
from lyapcheck.search.proof import Proof
from lyapcheck.search.radial import radial_epsilon

F = Fraction
CASES = [("reyes-kelly2", "table2_shoulder_elbow", index) for index in range(3)]
CASES += [("buap3", "table2", index) for index in range(3)]
FALSIFIED = {
    ("reyes-kelly2", 0): "0.8105604",
    ("reyes-kelly2", 1): "0.9263772",
    ("reyes-kelly2", 2): "0.6361997",
    ("buap3", 0): "0.1344734",
    ("buap3", 1): "0.1665327",
    ("buap3", 2): "0.1046635",
}
"""What an explicit state refutes, see the falsifier."""


def controlled(robot: str, gains: str, index: int) -> ControlledArm:
    return ControlledArm(read_gain_file(paper_gain_file(gains)).gains[index], load(robot))


@cache
def proof(robot: str, gains: str, index: int) -> Proof:
    result = radial_epsilon(controlled(robot, gains, index))
    assert result is not None
    return result


def data_of(result: Proof) -> RadialBounds:
    assert isinstance(result.by, RadialBounds)
    by = result.by
    return by


@pytest.mark.parametrize(("robot", "gains", "index"), CASES)
def test_it_proves_less_than_what_is_refuted(robot: str, gains: str, index: int) -> None:
    result, limit = proof(robot, gains, index), F(FALSIFIED[robot, index])
    assert 0 < result.loop.eps0 < limit
    assert proves_radially(result.loop, data_of(result))
    assert not proves_radially(replace(result.loop, eps0=limit), data_of(result))


@pytest.mark.parametrize(("robot", "gains", "index"), CASES)
def test_parts_bound_what_they_say_at_random_states(robot: str, gains: str, index: int) -> None:
    """The parts of S, and wᵀPw, by NumPy at states of all sizes."""
    case, result = controlled(robot, gains, index), proof(robot, gains, index)
    data, model, n = data_of(result), NumericModel(load(robot)), case.n
    family = named(case.gains.family, case.gains.m)
    d = np.array([float(x) for x in data.weights])
    scale = 1 / np.outer(d, d)
    with precision(BITS):
        parts = Parts(result.loop, data)
        kappa, coriolis = float(parts.kappa.upper()), float(parts.coriolis.upper())
    random = np.random.default_rng(index)
    for _ in range(200):
        q, e = random.uniform(-np.pi, np.pi, n), random.normal(size=n) * 10 ** random.uniform(-2, 1)
        h = family.h(e)
        C = model.coriolis(q, h) * scale
        assert np.linalg.norm(model.mass(q) * scale, 2) < float(data.inertia)
        assert np.linalg.norm(C, 2) <= coriolis * np.linalg.norm(h) + 1e-12
        assert np.linalg.norm(C + C.T, 2) / 2 <= kappa * np.linalg.norm(h) + 1e-12


@pytest.mark.parametrize(("robot", "gains", "index"), CASES[:4])
def test_the_inequality_is_below_the_smallest_eigenvalue_of_P(robot: str, gains: str, index: int) -> None:
    case, result = controlled(robot, gains, index), proof(robot, gains, index)
    model, n, eps0 = NumericModel(load(robot)), case.n, float(result.loop.eps0)
    family = named(case.gains.family, case.gains.m)
    d = np.array([float(x) for x in data_of(result).weights])
    L, kp, kv = float(family.constants().L.upper), case.kp, case.kv
    random = np.random.default_rng(index)
    for _ in range(300):
        q, e = random.uniform(-np.pi, np.pi, n), random.normal(size=n) * 10 ** random.uniform(-2, 1)
        h, dh, r = family.h(e), family.dh(e), float(np.linalg.norm(e))
        M, B, eps = model.mass(q), np.diag(model.viscous), eps0 / (1 + r)
        S = model.coriolis(q, h) + np.outer(M @ h, e / r) / (1 + r) - M @ np.diag(dh)
        X = B + eps * S
        P = B + eps * (S + S.T) / 2 - eps / 4 * X.T @ np.diag(1 / (kp - eps0 * L * kv / 4)) @ X
        assert np.linalg.eigvalsh(P / np.outer(d, d))[0] > 0


@given(st.integers(0, 10**6), st.integers(1, 5), st.sampled_from([0.0, 0.1, 0.5, 1.0]))
def test_the_pull_is_bounded_for_every_matrix_between_its_ends(seed: int, n: int, nu: float) -> None:
    """½(‖p‖‖v‖ − vᵀp) is the largest eigenvalue of −sym(p vᵀ), here by NumPy, with secants from 0 to s."""
    random = np.random.default_rng(seed)
    d, e = 10 ** random.uniform(-1, 1, n), random.normal(size=n)
    turn = np.linalg.qr(random.normal(size=(n, n)))[0]
    M = turn @ np.diag(random.choice([-nu, 1.0, random.uniform(-nu, 1)], n)) @ turn.T
    s, unit = 10 ** random.uniform(-2, 1), e / np.linalg.norm(e)
    h = random.choice([0.0, s, s * random.uniform()], n) * unit
    pull = np.outer(M @ (d * h), unit / d)
    bound = float(rank_one_bound(F(1), F(nu), [F(x) for x in d])) * s
    assert np.linalg.eigvalsh(-(pull + pull.T) / 2)[-1] <= bound * (1 + 1e-12)


def test_the_pull_of_a_positive_matrix_is_a_quarter_of_its_norm_at_most() -> None:
    """With D = I and ν = 0; M = diag(1, 0), h = s ê at 60° reaches ⅛, a half of the bound at least."""
    assert F(1, 8) <= rank_one_bound(F(1), F(0), [F(1)] * 3) <= F(26, 100)
    unit = np.array([np.cos(np.pi / 3), np.sin(np.pi / 3)])
    pull = np.outer(np.diag([1.0, 0.0]) @ unit, unit)
    assert np.linalg.eigvalsh(-(pull + pull.T) / 2)[-1] == pytest.approx(1 / 8)


WORSE = {
    "μ too small": lambda data: replace(data, inertia=data.inertia / 2),
    "μ negative": lambda data: replace(data, inertia=-data.inertia),
    "ν negative": lambda data: replace(data, lowest=-data.lowest),
    "ν above μ": lambda data: replace(data, lowest=2 * data.inertia),
    "weights too large": lambda data: replace(data, weights=tuple(2 * d for d in data.weights)),
    "a weight of 0": lambda data: replace(data, weights=(F(0), *data.weights[1:])),
    "too few weights": lambda data: replace(data, weights=data.weights[1:]),
    "cuts from 1": lambda data: replace(data, cuts=tuple(1 + x for x in data.cuts)),
    "cuts that fall": lambda data: replace(data, cuts=(F(0), F(2), F(1))),
    "no cuts": lambda data: replace(data, cuts=()),
    "one wide cut": lambda data: replace(data, cuts=(F(0), F(50))),
    "a joint twice": lambda data: replace(data, angles=(1, 1)),
    "an unknown joint": lambda data: replace(data, angles=(1, 7)),
}


@pytest.mark.parametrize("name", WORSE)
def test_data_changed_for_the_worse_prove_nothing(name: str) -> None:
    result = proof(*CASES[3])
    assert not proves_radially(result.loop, WORSE[name](data_of(result)))


def test_a_matrix_that_is_not_positive_needs_a_large_nu() -> None:
    """−M has the norm of M, so that μ stands, but a small ν does not."""
    result = proof(*CASES[3])
    arm = result.loop.arm
    negative = tuple(tuple(tuple((p, -c) for p, c in entry) for entry in row) for row in arm.mass)
    loop, data = replace(result.loop, arm=replace(arm, mass=negative)), data_of(result)
    assert data.lowest < data.inertia / 2
    with precision(BITS):
        assert not Parts(loop, data).inertia_shown()
        assert Parts(loop, replace(data, lowest=data.inertia)).inertia_shown()
    assert not proves_radially(loop, data)


def test_a_broken_tree_is_refused() -> None:
    result = proof(*CASES[3])
    with pytest.raises(BrokenTree):
        proves_radially(result.loop, replace(data_of(result), tree="0."))
    with pytest.raises(Refused):
        verify(
            statement_of(result.loop), PositiveAndDecreasing(result.inertia, replace(result.by, tree="0."))
        )


def test_certificates_are_judged_by_the_same_rule() -> None:
    result = proof(*CASES[3])
    assert verify(result.statement, result.certificate).verdict == "proved"
    larger = replace(result.loop, eps0=2 * result.loop.eps0)
    with pytest.raises(Refused, match="do not show"):
        verify(statement_of(larger), result.certificate)


def test_parameters_with_ranges_are_not_covered() -> None:
    result = proof(*CASES[3])
    ranged = replace(controlled(*CASES[3]), ranges=True)
    assert not proves_radially(ranged.loop(result.loop.eps0), data_of(result))
    assert radial_epsilon(ranged) is None


def test_friction_of_0_has_no_proof() -> None:
    result = proof(*CASES[0])
    free = replace(result.loop, viscous=((F(0), F(0)),) * 2)
    assert not proves_radially(free, data_of(result))


def test_the_linear_function_has_no_proof() -> None:
    gains = GainSet("pd", None, (F(60), F(5)), (F(2), F(1)), "linear")
    assert radial_epsilon(ControlledArm(gains, load("reyes-kelly2"))) is None


def test_the_inequality_fails_once_eps0_is_large() -> None:
    result = proof(*CASES[0])
    with precision(BITS):
        parts = Parts(result.loop, data_of(result))

        def shown(loop: ClosedLoop) -> bool:
            return Inequality(loop, parts).shown()

        assert shown(result.loop)
        assert not shown(replace(result.loop, eps0=result.loop.eps0 * 11 / 10))


@pytest.mark.parametrize("value", [F(2), F(1, 3), F(0), F(10**12), F(1, 10**30)])
def test_roots_are_rounded_up(value: Fraction) -> None:
    root = root_above(value)
    assert root * root >= value
    assert root * root - value <= F(3, 10**12) * (1 + root)
