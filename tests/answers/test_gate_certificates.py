"""Certificates as conditions, and what the gate says where they and (19) disagree."""

import json
from dataclasses import replace
from fractions import Fraction
from pathlib import Path

import numpy as np
import pytest

from lyapcheck import load_robot, named_family
from lyapcheck.answers.gate import GateAnswer, gate, remarks
from lyapcheck.answers.gate.certificates import certificates
from lyapcheck.check.certificate import read
from lyapcheck.check.kinds.resting import AtBounds, Resting
from lyapcheck.check.refusal import Refused
from lyapcheck.check.verify import verify
from lyapcheck.control.conditions import Check
from lyapcheck.control.gains import paper_gain_file, read_gain_file
from lyapcheck.control.judgement import JudgedStatement, degrees_above
from lyapcheck.errors import InputError
from lyapcheck.robots.numeric import NumericModel
from lyapcheck.search.controlled_arm import DecreaseProof
from tests.helpers.command import invoke
from tests.helpers.shares import one_in

pytestmark = pytest.mark.usefixtures("in_this_process")

TABLE2 = paper_gain_file("table2_shoulder_elbow")


def judged(path=TABLE2, *deciding, strict=False):
    outcome = gate(read_gain_file(path), None, deciding or ("10p", "19"), strict=strict)
    return {result.name: result for result in outcome}


def gain_file(path, top, kv="[0.1, 0.1]", end=""):
    path.write_text(f"{top}\n[[gains]]\nname = 'a'\nm = 2\nkp = [1, 1]\nkv = {kv}\n{end}")
    return path


@pytest.fixture(scope="module")
def scalar():
    return judged(TABLE2, "scalar")


# --- dry friction --------------------------------------------------------------------------------


def test_what_dry_friction_does_is_what_the_checker_accepts(tmp_path):
    """One joint is held anywhere, the others within angles that are said, and that are tight."""
    path = gain_file(tmp_path / "g.toml", 'robot = "buap3"', "[0.1, 0.1, 0.1]")
    path.write_text(path.read_text().replace("kp = [1, 1]", "kp = [0.025, 60, 5]"))
    answer = gate(read_gain_file(path))
    made, _ = certificates(answer)
    anywhere, rest = made["a.held.base.json"], made["a.rest.json"].statement
    assert isinstance(rest, Resting)
    for one in (anywhere, made["a.rest.json"]):
        assert verify(one.statement, one.proof).verdict == one.verdict == "proved"
    assert not {"a.held.shoulder.json", "a.held.elbow.json"} & set(made)
    assert rest.errors[0] is None
    said = " ".join(remarks(answer[0]))
    for joint, error in zip(("shoulder", "elbow"), rest.errors[1:], strict=True):
        assert error is not None
        assert f"{joint} {degrees_above(error)}" in said
    nearer = (None, *(error * Fraction(9999, 10000) for error in rest.errors[1:] if error is not None))
    with pytest.raises(Refused):
        verify(replace(rest, errors=nearer), AtBounds())


# --- the scalar certificate --------------------------------------------------------------------


def test_the_scalar_value_is_that_of_norms(scalar):
    """Θ' by its definition, with row sums of M and the Christoffel symbols over a grid of angles."""
    arm, angles = NumericModel(load_robot("reyes-kelly2")), np.linspace(-np.pi, np.pi, 2001)
    q = np.stack([np.zeros_like(angles), angles], axis=1)
    beta = abs(arm.mass(q)).max(axis=0).sum(axis=1).max()
    k_c = np.sqrt((abs(arm.christoffel(q)).max(axis=0) ** 2).sum())
    b = np.array([2.288, 0.175])
    for result in scalar.values():
        (check,) = [check for check in result.checks if check.id == "scalar"]
        assert (check.verdict, result.verdict) == ("accepted", "accepted")
        assert check.value is not None
        known, kp, kv = named_family("hyperbolic", result.m).constants(), result.gains.kp, result.gains.kv
        assert known.gamma is not None
        reach, rho, L = 2**0.5 * float(known.gamma.mid), float(known.rho.mid), float(known.L.mid)
        G = reach * L / (reach + L)
        eps = float(check.value)
        c, d = beta * (rho + G) + reach * k_c, b.max() + L * float(max(kv))
        theta = np.array(
            [[eps * float(min(kp)), -eps / 2 * (d + eps * c)], [-eps / 2 * (d + eps * c), b.min() - eps * c]]
        )
        assert np.linalg.eigvalsh(theta)[0] > 0
        theta[0, 1] = theta[1, 0] = -1.02 * eps / 2 * (d + 1.02 * eps * c)
        theta[1, 1], theta[0, 0] = b.min() - 1.02 * eps * c, 1.02 * eps * float(min(kp))
        assert np.linalg.eigvalsh(theta)[0] < 0


# --- the global certificate --------------------------------------------------------------------


@pytest.mark.parametrize("name", ["scalar", "global"])
def test_what_the_checker_refuses_is_not_accepted(monkeypatch, tmp_path, name):
    """Without the checker's word there is no certificate, whatever the search says; and no rejection."""
    monkeypatch.setattr(DecreaseProof, "accepted", lambda *_: None)
    monkeypatch.setattr("lyapcheck.answers.gate.stability.CEILINGS", (64, 4))
    (result,) = judged(gain_file(tmp_path / "g.toml", "robot = 'reyes-kelly2'"), name).values()
    assert result.verdict == "undecided"
    assert "accepted no proof" in result.failures[0].reason


# --- undecided, never rejected -----------------------------------------------------------------

BOUNDS = "[bounds]\nviscous_min = 0.4\ntorque = [9, 9]\ngravity = [1, 1]\n"


def test_another_friction_leaves_the_global_one_undecided(tmp_path):
    path = gain_file(tmp_path / "g.toml", "robot = 'reyes-kelly2'", end="[bounds]\nviscous_min = 0.1\n")
    (result,) = judged(path, "global").values()
    assert result.verdict == "undecided"
    assert "viscous_min" in result.failures[0].reason


def test_an_unbounded_function_has_no_certificate():
    (result,) = judged(paper_gain_file("table2_pd"), "scalar", "global").values()
    assert [check.verdict for check in result.checks[-2:]] == ["undecided", "undecided"]
    assert all("unbounded" in check.reason for check in result.checks[-2:])
    assert result.stable is not None  # PD with gravity compensation, by LaSalle
    assert result.stable.id == "lasalle"


UNPHYSICAL = """
title = "M11 < 0 where the elbow is folded"
source = "a test"
[model]
M11 = [[1, ""], [1.05, "c2"]]
M12 = [[0.1, ""]]
M22 = [[1, ""]]
potential = [[-1, "c1"]]
[[joints]]
name = "a"
viscous = 2
torque_limit = 50
[[joints]]
name = "b"
viscous = 2
torque_limit = 50
"""


@pytest.mark.slow
@pytest.mark.parametrize("name", one_in(2, ["scalar", "global"]))
@pytest.mark.parametrize("kv", one_in(2, ["[0.1, 0.1]", "[9, 9]"]))
def test_an_arm_that_cannot_exist_is_never_accepted(tmp_path, name, kv):
    (tmp_path / "arm.toml").write_text(UNPHYSICAL)
    path = gain_file(tmp_path / "g.toml", "robot = 'arm.toml'", kv)
    (result,) = judged(path, name).values()
    assert result.verdict == "undecided"
    assert "M(q) is not positive definite at q = (" in result.failures[0].reason
    assert result.stable is None
    for said in (*remarks(result), *remarks(judged(path)["a"])):
        assert "stable without" not in said


# --- what is said where conditions disagree ----------------------------------------------------


def test_stability_is_proved_where_19_alone_fails():
    result = judged(paper_gain_file())["tau_m2"]
    assert (result.verdict, result.standing) == ("rejected", "breaks (19), stability proved otherwise")
    assert result.stable is result.otherwise
    assert result.otherwise is not None
    assert (result.otherwise.id, result.otherwise.verdict) == ("scalar", "accepted")
    said = remarks(result)[0]
    assert said.startswith("(19) fails, yet the gains are proved stable without it: dV/dt < 0 with ε₀ = 0.03")
    assert said.endswith("; --condition 10p --condition scalar accepts it")
    accepted = judged(paper_gain_file(), "10p", "scalar")["tau_m2"]
    assert (accepted.verdict, accepted.standing) == ("accepted", "accepted")


def test_stability_is_not_said_where_it_was_not_verified(monkeypatch):
    """Without the checker's word for either proof nothing is said of stability."""
    undecided = "lyapcheck.search.controlled_arm.judged_statement"
    monkeypatch.setattr(undecided, lambda statement, proofs: JudgedStatement(statement, None, "undecided"))
    monkeypatch.setattr("lyapcheck.answers.gate.stability.Prover.lasalle", lambda *_: UNPROVED)
    result = judged(paper_gain_file())["tau_m2"]
    assert (result.verdict, result.standing) == ("rejected", "rejected")
    assert result.stable is None
    assert remarks(result)[0] == "(19) fails, but it is only sufficient; --condition scalar looks for a proof"


UNPROVED = Check("lasalle")


def test_options_are_named_only_where_they_accept(tmp_path):
    """Two conditions fail, each for its own gain: what replaces one of them alone accepts nothing."""
    path = gain_file(tmp_path / "g.toml", "robot = 'reyes-kelly2'", "[0.5, 0.5]")
    path.write_text(path.read_text().replace("kp = [1, 1]", "kp = [80, 1]"))
    (both,) = judged(path).values()
    first, second = remarks(both)[:2]
    assert "proved stable without it" in first
    assert "by its √n only" in second
    assert all(said.endswith("; --condition 10i --condition scalar accepts it") for said in (first, second))
    path.write_text(path.read_text().replace("kp = [80, 1]", "kp = [1, 20]"))
    (neither,) = judged(path).values()
    assert "proved stable while no motor saturates" in remarks(neither)[0]
    assert not any("accepts it" in said for said in remarks(neither))


def test_without_an_arm_stability_is_not_judged(tmp_path):
    (result,) = judged(gain_file(tmp_path / "g.toml", "", "[9, 9]", BOUNDS)).values()
    assert result.stable is None
    assert "stability is not judged without the arm" in remarks(result)[0]


@pytest.mark.slow
def test_without_friction_lasalle_is_what_is_known(tmp_path):
    """(19) fails for every gain, and no ε₀ is proved without friction: M ≻ 0 is, and more is not promised."""
    path = gain_file(tmp_path / "g.toml", "", "[" + ", ".join(["0.1"] * 6) + "]")
    path.write_text(path.read_text().replace("[1, 1]", "[" + ", ".join(["1"] * 6) + "]"))
    ur5 = str(Path(__file__).parents[2] / "examples" / "ur5.urdf")
    (result,) = gate(read_gain_file(path), ur5)
    assert (result.verdict, result.standing) == ("rejected", "breaks (19), stability proved otherwise")
    assert (result.stable.id, result.stable.value) == ("lasalle", None)
    first, second = remarks(result)[:2]
    assert "LaSalle's theorem; --condition 10p --condition lasalle accepts it" in first
    assert "what is not known is how fast" in second
    assert "no k_v > 0 meets it without friction" in str(GateAnswer([result])).replace("\n  ", " ")
    (asked,) = gate(read_gain_file(path), ur5, ("10p", "lasalle"))
    assert asked.verdict == "accepted"
    (others,) = gate(read_gain_file(path), ur5, ("19", "scalar", "global"))
    assert [check.verdict for check in others.checks[-2:]] == ["undecided", "undecided"]
    assert all("no viscous friction" in check.reason for check in others.checks[-2:])


# --- written down ------------------------------------------------------------------------------


def judged_by_command(*words):
    return invoke("gate", *words)


def recheck(folder):
    done = invoke("recheck", str(folder))
    return done.exit_code, done.output


ALL_CONDITIONS = ("--condition", "scalar", "--condition=global")


@pytest.mark.parametrize("words", [(), ALL_CONDITIONS])
def test_recheck_accepts_a_certificate_for_each_check(tmp_path, words):
    judged_by_command(str(TABLE2), f"--certificates={tmp_path / 'made'}", *words)
    made = {path.name: json.loads(path.read_text()) for path in (tmp_path / "made").iterdir()}
    names = "tau_m1", "tau_m1.10", "tau_m1.10p.shoulder", "tau_m3.19.elbow"
    assert {f"{name}.json" for name in names} <= made.keys()
    assert len(made) == 3 * (9 if "scalar" in words else 8)
    for document in made.values():
        assert document["claim"]["proof"] == "gate"
    code, said = recheck(tmp_path / "made")
    assert (code, f"{len(made)} accepted" in said) == (0, True), said


@pytest.mark.parametrize("family", ["linear", "arctan", "algebraic", "tanh"])
def test_other_functions_have_certificates_too(tmp_path, family):
    path = gain_file(tmp_path / "g.toml", "robot = 'reyes-kelly2'")
    path.write_text(path.read_text().replace("m = 2", f"family = '{family}'"))
    judged_by_command(str(path), "--certificates", str(tmp_path / "made"))
    result = [path.name for path in (tmp_path / "made").iterdir() if ".k_g" not in path.name]
    assert set(result) >= {
        "a.10.json",
        *(f"a.{name}.{joint}.json" for name in ("10p", "19") for joint in ("shoulder", "elbow")),
    }
    assert recheck(tmp_path / "made")[0] == 0


def test_the_verdict_is_one_statement_with_the_gravity_and_the_gains(tmp_path):
    judged_by_command(str(TABLE2), "--certificates", str(tmp_path / "made"), "--condition=10p")
    document = json.loads((tmp_path / "made" / "tau_m1.json").read_text())
    statement = document["statement"]
    assert (document["verdict"], statement["kind"], document["uses"]) == ("proved", "GateAccepted", {})
    certificate = read(document)
    lowered = replace(certificate.statement, k_g=tuple(Fraction(k) / 2 for k in statement["k_g"]))  # type: ignore[call-arg]
    with pytest.raises(Refused, match="squares"):
        verify(lowered, certificate.proof)


def test_sets_of_two_files_with_one_name_are_refused(tmp_path):
    done = judged_by_command(str(TABLE2), str(TABLE2), "--certificates", str(tmp_path / "made"))
    assert isinstance(done.exception, InputError)
    assert "one file at a time" in str(done.exception)
