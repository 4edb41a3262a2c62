"""The scalar proof: proved for the paper's arm and gains, against numbers, other derivations and faults."""

import re
import runpy
from dataclasses import replace
from fractions import Fraction
from pathlib import Path

import numpy as np
import pytest

from lyapcheck.answers.check.run import paper_case
from lyapcheck.check.certificate import judge, parse, read
from lyapcheck.claims import expr, run_proof
from lyapcheck.claims.script import find_script
from lyapcheck.family import hyperbolic
from lyapcheck.lyapunov.numeric import LyapunovNumeric
from lyapcheck.lyapunov.scalar import RobotBounds, scalar_form
from lyapcheck.robots import load
from lyapcheck.verdicts import Exit, Verdict
from tests.helpers.script_cases import rewriter, verdicts
from tests.helpers.shares import one_in
from tests.helpers.small_proofs import small_proof

pytestmark = pytest.mark.usefixtures("in_this_process")

SCRIPT = Path(find_script("scalar.py"))
SOURCE = SCRIPT.read_text(encoding="utf-8")
NAMES = runpy.run_path(str(SCRIPT))


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


# Θ' against numbers and against the other derivation --------------------------------------------------------


@pytest.mark.parametrize("m", [1, 2, 3])
@pytest.mark.parametrize("eps0", [0.03, 1.0])
def test_the_form_bounds_the_rate_of_v_at_random_states(m, eps0):
    """The bound holds for every ε₀, whether Θ' is positive definite or not."""
    case = paper_case(m)
    known, arm = NAMES["known_of"](m, case.n), NAMES["ArmBounds"](case.robot.fixed())
    kp, kv = ([float(k) for k in gains] for gains in (case.gains.kp, case.gains.kv))
    family = hyperbolic(m)
    rng = np.random.default_rng(7)
    scale = 10.0 ** rng.uniform(-3, 2, (3, 4000, 1))
    q, e, w = rng.normal(size=(3, 4000, 3)) * scale
    rate = LyapunovNumeric(case.robot, family, kp, kv, eps0).rate(q, e, w)
    a, b = np.linalg.norm(family.h(e), axis=1), np.linalg.norm(w, axis=1)
    eps = eps0 / (1 + np.linalg.norm(e, axis=1))
    c, d = (float(x) for x in (known.drift(arm.beta, arm.kc), known.cross(arm.b_max, max(case.gains.kv))))
    corner, side, low = NAMES["theta"](eps, min(kp), float(arm.b_min), c, d)
    form = -(corner * a**2 + 2 * side * a * b + low * b**2)
    size = np.abs(corner) * a**2 + 2 * np.abs(side) * a * b + np.abs(low) * b**2
    assert np.all(rate <= form + 1e-9 * size)


@pytest.mark.parametrize("m", [1, 2, 3, 7])
def test_c_and_d_are_those_of_the_other_derivation(m):
    """`lyapcheck.lyapunov.scalar` has the same two numbers, with its constants rounded elsewhere."""
    gains = paper_case(2).gains
    known = NAMES["known_of"](m, 3)
    beta, kc, low, high = Fraction(3), Fraction(2), Fraction(1, 2), Fraction(7, 3)
    form = scalar_form(gains, hyperbolic(m).constants(), RobotBounds(beta, kc, low, high))
    assert float(known.drift(beta, kc)) == pytest.approx(float(form.drift), rel=1e-3)
    assert float(known.cross(high, max(gains.kv))) == pytest.approx(float(form.cross), rel=1e-3)
    assert known.drift(beta, kc) >= form.drift - Fraction(1, 1000)


def test_the_constants_of_the_arm_are_above_sampled_ones():
    from lyapcheck.robots.numeric import NumericModel

    model = load("buap3").fixed()
    arm, numeric = NAMES["ArmBounds"](model), NumericModel(model)
    rng = np.random.default_rng(3)
    q, x = rng.uniform(-4, 4, (2000, 3)), rng.normal(size=(2000, 3))
    x /= np.linalg.norm(x, axis=1)[:, None]
    assert np.linalg.norm(numeric.mass(q), 2, axis=(1, 2)).max() <= float(arm.beta)
    turning = np.linalg.norm(numeric.coriolis(q, x), 2, axis=(1, 2)).max()
    assert 0.3 * float(arm.kc) < turning <= float(arm.kc)


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
    (
        "h.slope",
        "Bounds(n, gamma(m), rho(m), secant_bound(m))",
        "Bounds(n, gamma(m), rho(m), expr('0.8'))",
    ),
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


def test_no_verdict_is_written_in_the_script():
    assert re.findall(r"\b(proved|refuted|undecided|Verdict|Decision)\b", SOURCE) == []


def test_its_certificates_are_accepted_from_their_text(result):
    made = result.certificates
    assert len(made) == len(result.claims)
    for certificate in made.values():
        assert judge(read(parse(certificate.text()))).verdict == "proved"


def test_floats_are_refused_as_everywhere():
    with pytest.raises(TypeError, match="not exact"):
        expr(0.02)
