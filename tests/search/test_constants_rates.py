"""k_c along a chain with a certificate: the power beside C, the bound beside boxes, what must not pass."""

from dataclasses import replace
from fractions import Fraction as F

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from lyapcheck.check.kinds.chain import ChainCoriolisBelow, RateBounds
from lyapcheck.check.kinds.coriolis import CoriolisBelow
from lyapcheck.check.kinds.inertia import Bisection, PostureWitness
from lyapcheck.check.loop.chain import RigidLink
from lyapcheck.check.loop.storage import Shown
from lyapcheck.check.refusal import Refused
from lyapcheck.check.verify import verify
from lyapcheck.claims.bounds import ArmBounds, coriolis_bounded
from lyapcheck.claims.procedures import propose
from lyapcheck.constants import arm_constants, extreme
from lyapcheck.constants.storage import BoundWithProof, storage_proof
from lyapcheck.robots import load
from lyapcheck.robots.dynamics import Chain
from lyapcheck.robots.numeric import NumericModel
from lyapcheck.verdicts import Verdict
from tests.helpers.committed import ROOT
from tests.helpers.stated import outcome
from tests.search.test_constants_storage import arm_of

UNIT = ((F(1), F(0), F(0)), (F(0), F(1), F(0)), (F(0), F(0), F(1)))
NOWHERE, AHEAD, AXIS = (F(0), F(0), F(0)), (F(1), F(0), F(0)), (F(0), F(0), F(1))


def shown_for(name, folder):
    shown = storage_proof(arm_of(name, folder).chain, "k_c")
    assert isinstance(shown, BoundWithProof)
    assert isinstance(shown.statement, ChainCoriolisBelow)
    assert isinstance(shown.proof, RateBounds)
    return shown.statement, shown.proof


@pytest.mark.parametrize("name", ["leaning", "ur5"])
def test_what_exceeds_a_bound_of_0_is_the_square_of_the_coriolis_torques(name, tmp_path):
    arm = arm_of(name, tmp_path)
    q, x = np.random.default_rng(1).uniform(-3, 3, (2, arm.n))
    posture = PostureWitness(tuple(map(F, q)), (), tuple(map(F, x)))
    excess = ChainCoriolisBelow(tuple(arm.chain.links), F(0)).excess(posture)
    torques = NumericModel(arm).coriolis(q, x) @ x
    assert float(excess) == pytest.approx(torques @ torques, rel=1e-10)


def charge(Q, s, t, x, z):
    """Σ_j (s_j zᵀQ_jz + x_j² xᵀQ_jx/s_j + ½ t_j z_j² + ½ (xᵀQ_jx)²/t_j) of the squares of x and z."""
    total = 0
    for j, (row, share, other) in enumerate(zip(Q, s, t, strict=True), 1):
        along_x, along_z = (sum(q * v for q, v in zip(row, squares, strict=True)) for squares in (x, z))
        total = total + share * along_z + x[j] * along_x / share + (other * z[j] + along_x**2 / other) / 2
    return total


@given(st.integers(1, 5), st.randoms(use_true_random=False))
def test_what_is_reached_is_twice_the_largest_coefficient(n, random):
    """The coefficients of z_i² and of x_i² x_k², read off values at units."""
    rows = [[F(random.randint(1, 99), 7) for _ in range(n)] for _ in range(n - 1)]
    s, t = ([F(random.randint(1, 99), 9) for _ in range(n - 1)] for _ in "st")
    unit, none = [[F(int(i == k)) for k in range(n)] for i in range(n)], [F(0)] * n
    of_x = {
        (i, k): charge(rows, s, t, [a + b * (i != k) for a, b in zip(unit[i], unit[k], strict=True)], none)
        for i in range(n)
        for k in range(n)
    }
    mixed = [(of_x[i, k] - of_x[i, i] - of_x[k, k]) / 2 for i in range(n) for k in range(i)]
    largest = max(*(charge(rows, s, t, none, e) for e in unit), *(of_x[i, i] for i in range(n)), *mixed, F(0))
    rates = tuple(Shown(tuple(row), ()) for row in rows)
    assert RateBounds(rates, tuple(s), tuple(t)).reached == 2 * largest


@given(st.integers(2, 5), st.integers(0, 10**6))
def test_no_slopes_within_the_bounds_exceed_what_they_are_charged(n, seed):
    """zᵀC(q, x)x for slopes ½ ∂M/∂q_j at the border of ± diag(Q_j) that add the most at some x and z."""
    random = np.random.default_rng(seed)
    Q, (x, z) = 10.0 ** random.uniform(-1, 1, (n - 1, n)), random.normal(size=(2, n))
    along_x, along_z = Q @ x**2, Q @ z**2
    s, t = np.abs(x[1:]) * np.sqrt(along_x / along_z), along_x / np.abs(z[1:])
    slopes = [np.zeros((n, n))]
    for j, row in enumerate(Q):
        root, mirror = np.sqrt(row), -np.sign(z[j + 1]) * np.eye(n)
        if random.random() < 0.6:  # a reflection that takes x to z
            away = root * x / np.sqrt(along_x[j]) - np.sign(x[j + 1]) * root * z / np.sqrt(along_z[j])
            mirror = np.eye(n) - 2 * np.outer(away, away) / (away @ away)
        slopes.append(root[:, None] * mirror * root)
    half = np.array(slopes)  # of M_ij along q_k: half[k, i, j]
    c = np.einsum("kij->ijk", half) + np.einsum("jik->ijk", half) - half
    reached = np.einsum("ijk,i,j,k", c, z, x, x)
    assert reached <= charge(Q, s, t, x**2, z**2) * (1 + 1e-9)
    crossed = sum(2 * x[j] * (z @ slope @ x) for j, slope in enumerate(slopes))
    squared = sum(z[j] * (x @ slope @ x) for j, slope in enumerate(slopes))
    assert reached == pytest.approx(crossed - squared)


def test_two_joints_lose_less_than_a_half_and_what_shows_less_is_refused(tmp_path):
    arm = arm_of("pelican2", tmp_path)
    statement, proof = shown_for("pelican2", tmp_path)
    reached = extreme(arm, "k_c")[1]
    assert reached < statement.high <= reached * F(3, 2)
    assert outcome(replace(statement, high=reached * F(999, 1000)), proof) == "refused"
    assert outcome(replace(statement, high=proof.reached * F(999_999, 1_000_000)), proof) == "refused"
    assert outcome(replace(statement, high=statement.high * F(1001, 1000)), proof) == "proved"
    assert outcome(replace(statement, links=statement.links[:1]), proof) == "refused"
    assert outcome(replace(statement, links=(*statement.links, statement.links[1])), proof) == "refused"
    assert (
        outcome(replace(statement, links=(statement.links[0], heavier(statement.links[1]))), proof)
        == "refused"
    )


def heavier(link):
    return replace(link, mass=link.mass * 2)


def test_a_last_body_without_mass_changes_little(tmp_path):
    links = arm_of("pelican2", tmp_path).chain.links
    last = replace(links[1], mass=F(0), com=NOWHERE, inertia=(NOWHERE,) * 3)
    bounds = [storage_proof(Chain(chain, NOWHERE), "k_c") for chain in (links, (*links, last))]
    first, second = (shown.bound for shown in bounds if shown is not None)
    assert first <= second <= first * F(1001, 1000)


@pytest.mark.slow
@pytest.mark.parametrize(("name", "most"), [("px100", F(16, 10)), ("ur5", F(16, 10)), ("panda", F(2))])
def test_the_certificate_of_published_arms_is_above_what_is_reached_and_within_twice(name, most):
    arm = load(str(ROOT / "examples" / f"{name}.toml"))
    shown = storage_proof(arm.chain, "k_c")
    assert shown is not None
    assert extreme(arm, "k_c")[1] <= shown.bound <= most * extreme(arm, "k_c")[1]


@pytest.mark.parametrize("size", [F(1, 10), F(1), F(10)])
def test_the_bound_that_a_posture_refutes(size):
    """Two bodies at distance 1: C(q, x)x = sin q₂ (−2x₁x₂ − x₂², x₁²) has length √2 at x = (−1, 1)."""
    nothing = (NOWHERE,) * 3
    links = tuple(RigidLink(AXIS, origin, F(1), AHEAD, nothing, UNIT) for origin in (NOWHERE, AHEAD))
    at = PostureWitness((F(0), F(11, 7)), (), (-size, size))
    reached = F(707, 1000)
    assert verify(ChainCoriolisBelow(links, reached * F(99, 100)), at).verdict == "refuted"
    with pytest.raises(Refused):
        verify(ChainCoriolisBelow(links, reached * F(101, 100)), at)


def test_a_bound_that_is_too_small_is_refuted_by_a_posture(tmp_path):
    arm = arm_of("pelican2", tmp_path)
    smaller = ChainCoriolisBelow(arm.chain.links, extreme(arm, "k_c")[1] * F(9, 10))
    result = propose(smaller)
    assert result.verdict is Verdict.REFUTED
    assert result.proof is not None
    assert verify(smaller, result.proof).verdict == "refuted"


def test_between_what_is_reached_and_what_is_shown_a_bound_is_open(tmp_path):
    arm = arm_of("pelican2", tmp_path)
    between = ChainCoriolisBelow(arm.chain.links, extreme(arm, "k_c")[1] * F(11, 10))
    result = propose(between)
    assert result.proof is None
    assert "take a larger one" in result.reason


def test_boxes_show_norms_of_the_symbols_and_nothing_less():
    """k_c is 0.1381 here, and what boxes can show a twelfth more."""
    mass = ArmBounds(load("reyes-kelly2")).mass
    assert verify(CoriolisBelow(mass, (), F(15, 100)), Bisection()).verdict == "proved"
    assert not CoriolisBelow(mass, (), F(138, 1000)).shown_by_boxes(100)


@pytest.mark.slow
def test_property_26_of_many_joints_has_the_bound_of_the_constant():
    arm = load(str(ROOT / "examples" / "px100.toml"))
    statement = coriolis_bounded(arm)
    (constant,) = arm_constants(arm, names=["k_c"])
    assert constant.shown is not None
    assert type(statement) is type(constant.shown.statement)
    assert constant.shown.bound < statement.high < F(1003, 1000) * constant.shown.bound
    assert propose(statement).verdict is Verdict.PROVED
