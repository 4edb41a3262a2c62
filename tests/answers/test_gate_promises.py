"""What the gate says of ranges, of stated bounds and of dry friction is true of every arm in them."""

import json
import math
from fractions import Fraction
from xml.etree import ElementTree as ET

import pytest

from tests.helpers.arm_texts import ONE_LINK
from tests.helpers.command import invoke

pytestmark = pytest.mark.usefixtures("in_this_process")


def number(value, low, high, unit):
    """A number of an arm file with a range."""
    return f'{{value = {value}, unit = "{unit}", low = {low}, high = {high}, assumed = true, note = "x"}}'


def files(folder, mass, viscous, more="", gains="kp = [50]\nkv = [1]"):
    (folder / "arm.toml").write_text(ONE_LINK.format(mass=mass, viscous=viscous, more=more))
    path = folder / "g.toml"
    path.write_text(f'robot = "arm.toml"\n[[gains]]\nname = "a"\nm = 1\n{gains}\n')
    return str(path)


def said(done):
    return " ".join(done.output.split())


# --- a bound that is stated ----------------------------------------------------------------------


@pytest.mark.parametrize("name", ["text", "json", "junit", "sarif", "github", "markdown"])
def test_a_bound_that_the_arm_itself_refutes_is_rejected_in_every_format(tmp_path, name):
    path = files(tmp_path, 10, 2, "gravity_bound = 1", "kp = [5]\nkv = [1]")
    done = invoke("gate", path, "--format", name)
    assert done.exit_code == 1
    for word in ("the stated bound of 1 N·m is false", "49.05 N·m"):
        assert word in said(done).replace("\\u00b7", "·")
    if name == "junit":
        assert ET.fromstring(done.output).find(".//failure") is not None


def test_the_certificate_against_a_false_bound_is_rechecked(tmp_path):
    path = files(tmp_path, 10, 2, "gravity_bound = 1", "kp = [5]\nkv = [1]")
    invoke("gate", path, "--certificates", str(tmp_path / "made"))
    assert json.loads((tmp_path / "made" / "a.json").read_text())["verdict"] == "refuted"
    assert invoke("recheck", str(tmp_path / "made")).exit_code == 0


def test_without_a_model_the_bound_is_a_premise(tmp_path):
    path = tmp_path / "g.toml"
    path.write_text(
        '[[gains]]\nname = "a"\nm = 1\nkp = [5]\nkv = [1]\n'
        "[bounds]\nviscous_min = 2\ntorque = [60]\ngravity = [49]\n"
    )
    done = invoke("gate", str(path), "--certificates", str(tmp_path / "made"))
    assert "premise: gravity exerts up to (49) N·m" in said(done)
    outcome = invoke("recheck", str(tmp_path / "made"), "--explain")
    assert (outcome.exit_code, "for which no g is given" in said(outcome)) == (0, True)


@pytest.mark.parametrize(
    ("bounds", "vary", "words"),
    [
        ("viscous_min = 2", "viscous=-50%..+0%", "no limit changes under [bounds]"),
        (
            "viscous_min = 2",
            "payload=0..1",
            "--vary payload=0..1: gravity bound of j1 9.81 instead of 4.905 N·m",
        ),
        ("torque = [60]", "torque_limit=-50%..+0%", "no limit changes under [bounds]"),
    ],
)
def test_a_range_of_what_the_gain_file_replaces_costs_nothing(tmp_path, bounds, vary, words):
    path = files(tmp_path, 1, 2, "", f"kp = [5]\nkv = [1]\n[bounds]\n{bounds}")
    assert words in said(invoke("gate", path, "--vary", vary))


# --- one statement -------------------------------------------------------------------------------


def test_recheck_shows_the_arm_with_its_ranges(tmp_path):
    path = files(tmp_path, 1, 2, "", "kp = [5]\nkv = [1]")
    invoke("gate", path, "--vary", "payload=0..5", "--certificates", str(tmp_path / "made"))
    statement = json.loads((tmp_path / "made" / "a.json").read_text())["statement"]
    assert (statement["parameters"], statement["k_g"]) == ([["1", "6"]], ["2943/100"])
    outcome = invoke("recheck", str(tmp_path / "made"), "-v")
    assert (outcome.exit_code, "p1 in 1 … 6" in said(outcome)) == (0, True)


def test_a_rejected_set_has_a_state_that_saturates_a_motor(tmp_path):
    path = files(tmp_path, 10, 2, "", "kp = [12]\nkv = [1]")
    invoke("gate", path, "--certificates", str(tmp_path / "made"))
    document = json.loads((tmp_path / "made" / "a.json").read_text())
    proof = document["proof"]
    assert (document["verdict"], proof["rule"]) == ("refuted", "saturating state")
    q, x = (float(Fraction(text)) for text in (proof["turns"][0], proof["x"]))
    torque = 12 * math.tanh(x) + 1 * math.tanh(x) + 10 * 9.81 * 0.5 * math.cos(q * math.pi / 2)
    assert abs(torque) > 60


def test_what_fails_by_the_root_alone_is_refuted_as_a_condition(tmp_path):
    path = tmp_path / "g.toml"
    path.write_text('robot = "buap3"\n[[gains]]\nname = "a"\nm = 1\nkp = [28, 70, 7]\nkv = [0.1, 0.1, 0.1]\n')
    invoke("gate", str(path), "--certificates", str(tmp_path / "made"))
    proof = json.loads((tmp_path / "made" / "a.json").read_text())["proof"]
    assert (proof["rule"], proof["condition"], proof["joint"]) == ("broken condition", "10p", 1)


# --- remarks -------------------------------------------------------------------------------------


@pytest.mark.parametrize(
    ("low", "vary", "where"),
    [
        (1, (), "stable (scalar)"),
        (0.9, (), "stable (scalar) at nominal numbers"),
        (0.9, ("--vary", "mass=-5%..+5%"), "stable (scalar)"),
    ],
)
def test_the_headline_tells_that_stability_is_shown_at_nominal_numbers(tmp_path, low, vary, where):
    path = files(tmp_path, number(1, low, 1, "kg"), 2, "", "kp = [5]\nkv = [1]")
    done = invoke("gate", path, "--condition", "10i", "--condition", "scalar", *vary)
    assert done.exit_code == 0
    assert f"no motor saturates (10i), {where}, proved for arm" in said(done)
    broken = invoke("gate", files(tmp_path, number(1, low, 1, "kg"), 2, "", "kp = [5]\nkv = [3]"), *vary)
    nominal = " at nominal numbers" if "nominal" in where else ""
    assert f"breaks (19), stability proved otherwise{nominal}" in said(broken)
    assert "proved stable (scalar); --condition 10p --condition scalar accepts it" in said(broken)


# --- the loop and the ranges in the headline ------------------------------------------------------


def headline(*words):
    """The lines before the table, and all that is said."""
    done = invoke("gate", *words)
    return done.exit_code, done.stdout.split("\n\n", 1)[0].splitlines(), said(done)


def swinging(folder):
    """Gains on an arm with dry friction that are stable by a proof, and swing if they run slowly."""
    path = files(folder, 6, 0.5, "coulomb = 1", "kp = [20]\nkv = [3]")
    return path, "--condition", "10i", "--condition", "scalar"


def test_a_loop_that_is_unstable_but_for_dry_friction_is_told_with_the_acceptance(tmp_path):
    code, lines, _ = headline(*swinging(tmp_path), "--rate", "5")
    assert (code, len(lines)) == (0, 3)
    assert lines[0].endswith(": accepted; unstable at 200 ms without dry friction or unknown gravity")
    assert lines[2] == "  open: sampled"
    _, lines, text = headline(*swinging(tmp_path), "--rate", "100")
    assert ("unstable at" in text, lines[2]) == (True, "  open: sampled")


def test_an_unknown_payload_without_a_rate_is_judged_at_an_infinite_one(tmp_path):
    for words in (("--unknown-payload", "0.1"), ()):
        _, lines, _ = headline(*swinging(tmp_path), *words)
        assert lines[-1].endswith("no [loop] gives a rate: judged for an infinite rate, as in (11)")


@pytest.mark.parametrize(("low", "where"), [(1, "ratio, at"), (0.9, "ratio at nominal numbers, at")])
def test_a_damping_ratio_out_of_ranges_is_at_nominal_numbers(tmp_path, low, where):
    path = files(tmp_path, number(1, low, 1, "kg"), 2, "", "kp = [5]\nkv = [1]")
    assert f"estimated damping {where} the posture of most inertia" in headline(path)[2]
