"""Proofs by bounds along the links and boxes of e: what they bound, and what they must refuse."""

from dataclasses import replace
from fractions import Fraction
from functools import cache
from pathlib import Path

import numpy as np
import pytest

from lyapcheck.answers.epsilon.compute import by_forms
from lyapcheck.answers.epsilon.compute import proof_of as scalar_proof_of
from lyapcheck.check.kinds.decreasing import PositiveAndDecreasing, statement_of
from lyapcheck.check.kinds.inertia import Links, MassAtCorners
from lyapcheck.check.kinds.link_bounds import LinkBounds
from lyapcheck.check.loop import certifies
from lyapcheck.check.refusal import Refused
from lyapcheck.check.verify import verify
from lyapcheck.control.gains import read_gain_file
from lyapcheck.robots import load
from lyapcheck.robots.fields import Vary
from lyapcheck.robots.vary import varied
from lyapcheck.search.controlled_arm import ControlledArm, DecreaseProof, unphysical
from lyapcheck.search.link_bounds import ErrorBoxes, link_bounds, linked_proof
from lyapcheck.search.worst_states import quadratic, sample

F = Fraction
EXAMPLES = Path(__file__).parents[2] / "examples"
FALSIFIED = {1: F("1.250004"), 2: F("1.607161"), 3: F("1.063894")}
"""What an explicit state refutes on the UR5, see the falsifier."""
SHARE = F(1, 2)
RANGES = [Vary.parsed("viscous=-30%..+30%"), Vary.parsed("payload=0..3")]


PINCHER = {
    ("px100", 1): F("3.796719"),
    ("px100", 2): F("5.027353"),
    ("px150", 1): F("1.405645"),
    ("px150", 2): F("1.774702"),
    ("px150", 3): F("1.184124"),
}
"""The same of four and of five joints."""


@cache
def example(name, m, ranges=False):
    gains = next(item for item in read_gain_file(EXAMPLES / f"{name}_gains.toml").gains if item.m == m)
    model = load(str(EXAMPLES / f"{name}.toml"))
    return ControlledArm(gains, varied(model, RANGES) if ranges else model, ranges)


@cache
def proof(m, ranges=False, share=SHARE):
    return proof_of(example("ur5", m, ranges), share * FALSIFIED[m])


def proof_of(controlled, eps0):
    bounds = link_bounds(controlled)
    assert bounds is not None
    loop = controlled.loop(F(f"{float(eps0):.6g}"))
    result = ErrorBoxes(loop, bounds).covered(30_000)
    assert result.proved
    return DecreaseProof(
        loop, replace(bounds, tree=result.tree, scales=result.scales), controlled.inertia_proof
    )


def data_of(of):
    assert isinstance(of.by, LinkBounds)
    return of.by


def judged(statement, of, by):
    return verify(statement, PositiveAndDecreasing(of.inertia, by)).verdict


@pytest.mark.slow
@pytest.mark.parametrize("m", [1, 2, 3])
def test_it_proves_half_of_what_is_refuted_with_few_boxes(m):
    assert judged(proof(m).statement, proof(m), data_of(proof(m))) == "proved"
    assert proof(m).boxes < 1_000


@pytest.mark.slow
@pytest.mark.parametrize(("name", "m"), PINCHER)
def test_four_and_five_joints_are_as_tight_as_asked(name, m):
    share = F("0.95") if m == 1 else F("0.85")
    found = proof_of(example(name, m), share * PINCHER[name, m])
    assert judged(found.statement, found, data_of(found)) == "proved"
    with pytest.raises(Refused):
        judged(statement_of(replace(found.loop, eps0=PINCHER[name, m])), found, data_of(found))


@pytest.mark.slow
def test_the_scalar_epsilon_of_the_certified_k_c_has_a_certificate():
    controlled = example("px100", 1)
    _, scalar, _ = by_forms(controlled)
    assert scalar.eps0 is not None
    assert F("0.9") < scalar.eps0 < PINCHER["px100", 1]
    # norms as the checker knows them, from rows of M and sums of squares, prove less
    assert not certifies(controlled.loop(F(1)).tail, scalar.eps0)
    found = scalar_proof_of(controlled, scalar.eps0)
    assert found is not None
    assert found.loop.eps0 == scalar.eps0
    assert judged(found.statement, found, data_of(found)) == "proved"
    refuted = quadratic(controlled, sample(controlled, 20_000, 3)).reciprocal().max()
    assert float(scalar.eps0) * refuted < 1


@pytest.mark.slow
def test_M_and_its_rates_stay_within_their_bounds_at_random_postures():
    controlled, data = example("ur5", 3), data_of(proof(3))
    q = np.random.default_rng(1).uniform(-np.pi, np.pi, (2_000, 6))
    q[:500] = np.pi / 2 * np.round(q[:500] / (np.pi / 2))
    U = np.diag([float(x) for x in data.inertia.prices])
    tightest = np.linalg.eigvalsh(U - controlled.numeric.mass(q))[:, 0].min()
    assert 0 < tightest < 0.01
    for joint, bound in enumerate(data.rising, start=1):
        C = controlled.numeric.coriolis(q, np.tile(np.eye(6)[joint], (len(q), 1)))
        half = (C + np.swapaxes(C, 1, 2)) / 2
        Q = np.diag([float(x) for x in bound.prices])
        room = [np.linalg.eigvalsh(Q - sign * half)[:, 0].min() for sign in (1, -1)]
        assert min(room) > 0


@pytest.mark.slow
def test_ranges_of_friction_and_payload_are_proved_by_the_corners_of_the_arm():
    # 0.518 is refuted at one corner
    found = proof(1, ranges=True, share=F("0.405"))
    assert found.loop.eps0 > F("0.97") * F("0.518")
    data = data_of(found)
    assert len(data.arms) == 2
    low, high = found.loop.parameters[0]
    assert high - low == 3
    assert found.loop.viscous[0] == (F("4.2"), F("7.8"))
    assert isinstance(found.inertia, MassAtCorners)
    assert judged(found.statement, found, data) == "proved"
    for wrong in (data.arms[::-1], data.arms[:1]):
        with pytest.raises(Refused):
            judged(found.statement, found, replace(data, arms=wrong))
        with pytest.raises(Refused):
            verify(found.statement, PositiveAndDecreasing(MassAtCorners(tuple(map(Links, wrong))), data))
    wider = replace(found.loop, parameters=((low, high + 1),))
    with pytest.raises(Refused):
        judged(statement_of(wider), found, data)


@pytest.mark.slow
def test_ranges_of_friction_alone_are_proved_by_the_links():
    controlled = example("px100", 1)
    friction = replace(controlled, model=varied(controlled.model, RANGES[:1]), ranges=True)
    assert unphysical(friction) == ""
    found = linked_proof(friction, F(1))
    assert found is not None
    (low, high), *_ = found.loop.viscous
    assert low * 13 == high * 7
    assert judged(found.statement, found, data_of(found)) == "proved"
    weaker = replace(found.loop, viscous=tuple((b / 100, top) for b, top in found.loop.viscous))
    with pytest.raises(Refused):
        judged(statement_of(weaker), found, data_of(found))
