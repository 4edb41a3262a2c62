"""The scalar proof: proved for the paper's arm and gains, against numbers, other derivations and faults."""

from dataclasses import replace
from fractions import Fraction
from pathlib import Path

import pytest

from lyapcheck.check.certificate import judge, parse, read
from lyapcheck.claims import run_proof
from lyapcheck.claims.script import find_script
from lyapcheck.robots import load
from lyapcheck.verdicts import Exit, Verdict
from tests.helpers.script_cases import rewriter, verdicts
from tests.helpers.shares import one_in
from tests.helpers.small_proofs import small_proof

pytestmark = pytest.mark.usefixtures("in_this_process")

SCRIPT = Path(find_script("scalar.py"))


@pytest.fixture(scope="module", params=["small", pytest.param("paper", marks=pytest.mark.slow)])
def result(request, tmp_path_factory):
    """For two joints and m = 1, or for the paper's arm and m = 1, 2, 3."""
    if request.param == "small":
        return small_proof(tmp_path_factory, "scalar.py")
    return run_proof("scalar.py", ms=(1, 2, 3))


@pytest.fixture
def altered(tmp_path):
    """The script with something replaced."""
    return rewriter("scalar.py", tmp_path)


def test_every_step_is_proved_for_the_gains_of_the_paper(result):
    assert {row.verdict for row in result.claims} == {Verdict.PROVED}
    assert result.exit_code is Exit.PROVED
    concluding = [row for row in result.claims if "asymptotically" in row.statement]
    kinds = {(row.id, type(row.stated).__name__) for row in concluding}
    assert kinds == {
        ("arms.stable", "Stable"),
        ("arms.all", "Stable"),
        ("arm.stable", "StableArm"),
        ("arm.states", "Decreasing"),
        ("arm.ranges", "Decreasing"),
    }
    assert {(row.id, row.m) for row in concluding} == {(name, m) for name, _ in kinds for m in result.ms}


def test_every_conclusion_rests_on_the_chain_below_it(result):
    uses = {row.id: set(row.uses) for row in result.claims}
    assert {"rate.form", "arm.theta", "arm.M", "arm.C", "h.bounds", "V.positive"} <= uses["arm.stable"]
    assert uses["rate.form"] == {f"rate.{k}" for k in range(1, 12)}


# ε₀ and arms ------------------------------------------------------------------------------------------------


@pytest.mark.slow
def test_an_eps0_that_is_too_large_is_refuted_and_takes_the_conclusion_along(altered):
    path = altered("SHARE = Fraction(99, 100)", "SHARE = Fraction(101, 100)")
    outcome = verdicts(path, ("arm.theta", "arm.stable", "arms.stable"))
    assert outcome == {"arm.theta": "refuted", "arm.stable": "undecided", "arms.stable": "proved"}


@pytest.mark.slow
def test_states_know_better_than_norms_until_one_is_found(altered):
    """Branch and bound proves a larger ε₀ than norms do; far above, a state refutes it."""
    assert verdicts(altered("SHARE = Fraction(99, 100)", "SHARE = Fraction(12, 10)"), ("arm.states",)) == {
        "arm.states": "proved"
    }
    assert verdicts(altered("SHARE = Fraction(99, 100)", "SHARE = Fraction(60)"), ("arm.states",)) == {
        "arm.states": "refuted"
    }


@pytest.mark.slow
def test_another_arm_with_gains_of_its_own():
    gains = SCRIPT.parent / "table2_shoulder_elbow.toml"
    assert set(verdicts("scalar.py", robot="reyes-kelly2", gains=gains).values()) == {"proved"}


@pytest.mark.slow
def test_without_friction_nothing_is_concluded_about_the_arm():
    model = load("buap3")
    number = replace(model.viscous[0], value=Fraction(0), low=None, high=None)
    outcome = verdicts("scalar.py", robot=replace(model, viscous=(number, *model.viscous[1:])))
    assert outcome["arm.M"] == outcome["arm.C"] == "proved"
    assert outcome["arm.stable"] == outcome["arm.theta"] == outcome["arm.states"] == "undecided"
    assert outcome["arms.all"] == "proved"


@pytest.mark.slow
def test_gains_for_another_number_of_joints_leave_the_arm_open():
    outcome = verdicts("scalar.py", robot="pendulum1")
    assert outcome["arm.stable"] == "undecided"
    assert outcome["arms.stable"] == outcome["arm.M"] == "proved"


@pytest.mark.slow
def test_large_members_and_many_joints_for_every_arm():
    outcome = verdicts("scalar.py", ("arms.stable", "arms.all"), ms=(12,), n=4)
    assert outcome == {"arms.stable": "proved", "arms.all": "proved"}


# Faults -----------------------------------------------------------------------------------------------------

FUNCTION = "FAMILY.regulator(FAMILY.h_of(m), eps0)"
AT_REST = "AT_REST.regulator(AT_REST.h_of(m), "
"""h and U as the properties of V and of the loop take them."""


def regulator(value, potential):
    """With another h and U."""
    return f"FAMILY.regulator(FAMILY.member({value}, {potential}, 2, 2, 2), eps0)"


FAULTS = [
    ("arm.integral", "eps * k * a**2 / 2 <= whole", "eps * k * a**2 <= whole"),
    ("arm.integral", "most = above(energy)", "most = above(energy) / 2"),
    ("arm.integral", "most / k_i + 1 for", "most / k_i / 2 for"),
    ("arm.integral", "gains) / 2\n    at_rest", "gains) * 2\n    at_rest"),
    ("h.slope", "Bounds(n, gamma(m), rho(m), secant_bound(m))", "Bounds(n, gamma(m), rho(m), expr('0.8'))"),
    ("h.share", "<= reach * L / (reach + L)", "<= reach * L / (reach + 2 * L)"),
    ("V.positive", FUNCTION, regulator("h(m, x)", "2 * potential(m, x)")),
    ("V.smooth", FUNCTION, regulator("2 * h(m, x)", "potential(m, x)")),
    ("equilibrium", AT_REST, "AT_REST.regulator(FAMILY.member(x**3 - x, x**4 / 4 - x**2 / 2, 2, 2, 2), "),
    ("rate.1", '["h.odd"], [], ["damping"]', '["h.odd"], ["w"]'),
    ("rate.4", "eps * known.G * beta * b**2", "eps * known.G / 2 * beta * b**2"),
    ("rate.8", "eps * known.L * kv_max", "eps * '0.8' * kv_max"),
    ("rate.form", "return eps * k, -eps / 2", "return eps * k, -eps / 3"),
    (
        "arm.C",
        "ArmBounds(robot).coriolis_below()",
        "(lambda arm: type(arm.coriolis_below())(arm.mass, (), arm.kc / 100))(ArmBounds(robot))",
    ),
    ("arm.stable", "Kp=gains.kp, Kv", "Kp=[k / 9 for k in gains.kp], Kv"),
    ("arm.properties", "plus(turning, transpose(turning))", "plus(turning, turning)"),
]


@pytest.mark.parametrize(
    ("claim", "right", "wrong"), one_in(6, FAULTS), ids=[f"{row[0]}: {row[2]}" for row in FAULTS]
)
def test_a_planted_fault_is_not_proved(altered, claim, right, wrong):
    assert verdicts(altered(right, wrong), (claim,))[claim] in ("refuted", "undecided")


def test_its_certificates_are_accepted_from_their_text(result):
    made = result.certificates
    assert len(made) == len(result.claims)
    for certificate in made.values():
        assert judge(read(parse(certificate.text()))).verdict == "proved"
