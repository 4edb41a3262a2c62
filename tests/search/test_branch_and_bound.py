"""The search for certificates: P over boxes, covers, and what must never be proved."""

from dataclasses import replace
from fractions import Fraction
from functools import cache

import numpy as np
import pytest

from lyapcheck.check.kinds.link_bounds import LinkBounds
from lyapcheck.check.loop.field import leaves
from lyapcheck.check.verify import verify
from lyapcheck.control.gains import GainSet, paper_gain_file, read_gain_file
from lyapcheck.robots import load
from lyapcheck.search import certified, schur
from lyapcheck.search.boxes import EXHAUSTED, RESISTS, CoverOutcome
from lyapcheck.search.certified import CertifiedEpsilon, certified_epsilon, certify, linked_otherwise
from lyapcheck.search.controlled_arm import ControlledArm, DecreaseProof
from lyapcheck.search.scalar_program import norm_epsilon
from lyapcheck.search.schur import Reach, SchurProblem, _Boxes
from tests.helpers.schur import schur_of
from tests.helpers.shares import one_in
from tests.helpers.urdf_texts import generic

F = Fraction
GAINS = {
    "reyes-kelly2": read_gain_file(paper_gain_file("table2_shoulder_elbow")).gains,
}
FALSIFIED = (F("0.81057"), F("0.92638"), F("0.63621"))
"""For the three gain sets on the two-joint arm, just above ε₀ at which test_falsify.py has states."""


@cache
def controlled(robot, index):
    return ControlledArm(GAINS[robot][index], load(robot))


def problem(robot, index, eps0):
    case = controlled(robot, index)
    return SchurProblem(case.loop(eps0))


def exact_schur(case, eps0, q, e):
    return schur_of(case.model, case.gains, eps0, q, e)


def random_state(generator, n):
    return generator.uniform(-np.pi, np.pi, n), generator.normal(size=n) * 10.0 ** generator.uniform(-4, 1)


def test_a_wrong_sign_of_coriolis_would_be_noticed():
    """Without Coriolis terms, or with their sign changed, intervals at points miss P."""
    task, case = problem("reyes-kelly2", 0, F(1, 4)), controlled("reyes-kelly2", 0)
    q, e = np.array([0.0, 1.0]), np.array([0.5, -0.3])
    point = np.concatenate([q[1:], e])
    exact = exact_schur(case, 0.25, q, e)
    for sign, agrees in ((1, True), (0, False), (-1, False)):
        signed = [
            {k: (sign * a, sign * b) for k, (a, b) in x.items()} if len(place) == 3 else x
            for place, _, x in task.parts
        ]
        changed = problem("reyes-kelly2", 0, F(1, 4))
        changed.reach = Reach(signed, 2)
        entry = _Boxes(changed, np.stack([point, point])[None]).P()[1][0]
        assert bool(entry.lo[0] - 1e-12 <= exact[1, 0] <= entry.hi[0] + 1e-12) is agrees


@pytest.mark.parametrize("index", one_in(3, [1, 0, 2]))
def test_proved_below_the_falsified_and_never_above(index):
    assert certify(problem("reyes-kelly2", index, FALSIFIED[index] * F(9, 10)), 20_000).proved
    above = certify(problem("reyes-kelly2", index, FALSIFIED[index] * F(101, 100)), 20_000)
    assert not above.proved
    assert above.tree == ""
    assert above.reason == RESISTS
    assert above.point is not None
    q, e = np.zeros(2), above.point[1:]
    q[1] = above.point[0]
    exact = exact_schur(controlled("reyes-kelly2", index), float(FALSIFIED[index]) * 1.01, q, e)
    assert np.linalg.eigvalsh(exact)[0] < 1e-6


@pytest.mark.parametrize("index", [0, 1, 2])
@pytest.mark.parametrize("broken", ["friction", "inertia"])
def test_a_weaker_arm_is_not_proved(index, broken):
    """A tenth of the friction of one joint, or ten times the inertia, at an ε₀ that the real arm bears."""
    case = controlled("reyes-kelly2", index)
    model, eps0 = case.fixed, FALSIFIED[index] * F(9, 10)
    if broken == "friction":
        first, *others = model.viscous
        model = replace(model, viscous=(replace(first, value=first.value / 10), *others))
    else:
        heavier = tuple(tuple(10 * entry for entry in row) for row in model.mass)
        model = replace(model, dynamics=replace(model.dynamics.polynomials, mass=heavier))
    weak = ControlledArm(case.gains, model)
    assert not certify(SchurProblem(weak.loop(eps0)), 20_000).proved
    assert certify(SchurProblem(weak.loop(eps0 / 40)), 20_000).proved


@pytest.mark.parametrize("index", [0, 1, 2])
def test_every_state_lies_in_a_proved_leaf_or_in_the_tail(index):
    task = problem("reyes-kelly2", index, FALSIFIED[index] * F(9, 10))
    loop, outcome = task.loop, certify(task, 20_000)
    boxes = np.array([np.array(leaf).T for leaf in leaves(loop.start, outcome.tree)])
    assert task.proved(boxes).all()
    generator = np.random.default_rng(index)
    symmetric = [s for s in np.ndindex(2, 2) if s[0] == s[1]]
    seen = 0
    for _ in range(500):
        q, e = random_state(generator, 2)
        if np.linalg.norm(e) >= loop.radius:
            continue
        images = [(q * (1 - 2 * s[0]), e * (1 - 2 * s[0])) for s in symmetric]
        points = [np.array([a[1], *b]) for a, b in images]
        inside = [np.all((boxes[:, 0] <= p) & (p <= boxes[:, 1]), axis=1).any() for p in points]
        assert any(inside)
        seen += 1
    assert seen > 300


@pytest.mark.parametrize("direction", [(1.0, 0.0), (-0.6, 0.8), (0.6, 0.8)])
def test_errors_are_left_to_the_tail_from_its_radius_on(direction, monkeypatch):
    """Seen with a P that is never found positive definite: only the tail is left to prove anything."""
    monkeypatch.setattr(schur, "positive_definite", lambda rows: np.zeros(1, dtype=bool))
    task = problem("reyes-kelly2", 0, F(1, 2))
    for share, left in ((0.5, False), (0.999, False), (1.001, True)):
        point = np.array([0.0, *(share * task.loop.radius * np.array(direction))])
        assert task.proved(np.stack([point, point])[None]).item() is left


def test_gains_out_of_reach_are_said():
    """K̃ = K_p − ¼ ε₀ L K_v is not positive: an answer, not an exception."""
    case = controlled("reyes-kelly2", 0)
    stiff = ControlledArm(replace(case.gains, kv=(F(1000), F(1000))), case.model)
    result = certified_epsilon(stiff, F(1), 1000)
    assert result.proof is None
    assert "K_p is too small beside K_v" in result.reason
    linear = GainSet("pd", None, (F(60), F(5)), (F(1), F(1)), family="linear")
    assert "unbounded" in certified_epsilon(ControlledArm(linear, case.model), F(1), 1000).reason


def test_boxes_that_the_checker_refuses_are_no_certificate(monkeypatch):
    """An arithmetic that proves everything gets no further than the checker."""
    monkeypatch.setattr(SchurProblem, "proved", lambda self, boxes: np.ones(len(boxes), dtype=bool))
    result = certified_epsilon(controlled("reyes-kelly2", 0), 100 * FALSIFIED[0], 1000)
    assert result.eps0 is None
    assert "refused by the checker" in result.reason or "K_p is too small" in result.reason


@pytest.mark.slow
def test_where_nearly_all_is_too_much_smaller_shares_are_tried():
    """What the ceiling is too high for by a quarter, four fifths of it may be."""
    case = controlled("reyes-kelly2", 0)
    nothing = certified_epsilon(case, 5 * FALSIFIED[0], 2000)
    assert nothing.proof is None
    assert nothing.reason
    part = certified_epsilon(case, FALSIFIED[0] * F(5, 4), 2000)
    assert part.eps0 is not None
    assert part.eps0 < FALSIFIED[0]


def test_no_share_takes_what_a_smaller_one_needs(monkeypatch):
    """Where all above 70 % of the ceiling take more boxes than there are, 65 % are proved, not 50."""
    ceiling, tried = F(1), list[float]()

    def dear(task, most, *rest):
        tried.append(float(task.loop.eps0))
        needed = 10 if tried[-1] <= 0.7 else 10**9
        return CoverOutcome(needed <= most, min(needed, most), "" if needed <= most else EXHAUSTED, tree=".")

    monkeypatch.setattr(certified, "certify", dear)
    monkeypatch.setattr(DecreaseProof, "accepted", lambda self, jobs: self)
    result = certified_epsilon(controlled("reyes-kelly2", 0), ceiling, 1000)
    assert tried == pytest.approx([0.99, 0.5, 0.8, 0.65], rel=1e-6)
    assert result.eps0 == F(65, 100)
    assert result.looked_at < 1000


def test_where_boxes_end_far_below_bounds_along_the_links_are_tried(tmp_path):
    damped = generic(3).replace("</joint>", '<dynamics damping="0.5"/></joint>')
    (tmp_path / "arm.urdf").write_text(damped, encoding="utf-8")
    gains = GainSet("own", 1, (F(20), F(15), F(8)), (F(1, 100),) * 3)
    case = ControlledArm(gains, load(tmp_path / "arm.urdf"))
    nothing = CertifiedEpsilon(None, 5, "too few boxes")
    coarse, _ = norm_epsilon(case)
    assert coarse is not None
    ceiling = 3 * coarse.loop.eps0
    result = linked_otherwise(case, ceiling, nothing, 3000)
    assert result.proof is not None
    assert isinstance(result.proof.by, LinkBounds)
    assert verify(result.proof.statement, result.proof.certificate).verdict == "proved"
    assert result.looked_at > nothing.looked_at
    # not where boxes come near, nor for two joints
    assert linked_otherwise(case, F(11, 10) * result.proof.loop.eps0, result, 3000) is result
    assert linked_otherwise(controlled("reyes-kelly2", 0), F(1), nothing, 3000) is nothing
