"""Inputs of which commands once said something false: what they say of them is true."""

import json
import math
from fractions import Fraction

import pytest

from tests.helpers.arm_texts import ONE_LINK
from tests.promises.draws import asked, invoke, results

RANGED = 'assumed = true, note = "x"'


def files(folder, more="", mass=1, viscous=2, kp=50, kv=1):
    (folder / "arm.toml").write_text(ONE_LINK.format(mass=mass, viscous=viscous, more=more), encoding="utf-8")
    text = f'robot = "arm.toml"\n[[gains]]\nname = "a"\nm = 1\nkp = [{kp}]\nkv = [{kv}]\n'
    (folder / "gains.toml").write_text(text, encoding="utf-8")
    return str(folder / "gains.toml")


def one(*words):
    done = asked(*words)
    (result,) = results(done)
    return done.exit_code, result


def test_a_payload_counts_beside_a_stated_bound_in_gate_sweep_and_tune(tmp_path):
    vary = ("--vary", "payload=0..20")
    gains = files(tmp_path, "gravity_bound = 4.905")
    assert one("gate", gains, *vary)[0] == 1
    plan = tmp_path / "plan.toml"
    sets = '[[gains]]\nname = "a"\nm = 1\nkp = [50]\nkv = [1]\n'
    text = f'robots = ["arm.toml"]\nvariations = [[], ["payload=0..20"]]\nquestions = ["gate"]\n{sets}'
    plan.write_text(text, encoding="utf-8")
    done = asked("sweep", str(plan), "--jobs", "1")
    assert {(len(row["variation"]), row["verdict"]) for row in results(done)} == {
        (0, "accepted"),
        (1, "rejected"),
    }
    tuned = invoke("tune", str(tmp_path / "arm.toml"), "--m", "1", *vary)
    assert (tuned.exit_code, "the torque limit of 60 N·m is not above" in tuned.stdout) == (2, True)
    gains = files(tmp_path, mass=21)  # the end of the range
    code, result = one("gate", gains)
    (row,) = [check for check in result["checks"] if check["id"] == "10p"]
    assert (code, row["limit"]["lower"]) == (1, "-43.005")


def test_the_largest_dry_friction_of_the_file_and_of_options_counts(tmp_path):
    path = tmp_path / "gains.toml"
    sets = '[[gains]]\nname = "a"\nm = 1\nkp = [28, 60, 7]\nkv = [0.05, 0.05, 0.05]\n'
    path.write_text(f'robot = "buap3"\n{sets}', encoding="utf-8")
    text = " ".join(one("gate", str(path))[1]["remarks"])
    assert "leaves at most base 15.01" in text
    assert one("gate", str(path), "--vary", "shoulder_gravity=0%..+200%")[0] == 1
    coulomb = f"coulomb = {{value = 1, low = 1, high = 6, {RANGED}}}"
    gains = files(
        tmp_path,
        coulomb,
        f"{{value = 2, low = 1, high = 3, {RANGED}}}",
        f"{{value = 1, low = 0.5, high = 30, {RANGED}}}",
        4,
        0.4,
    )
    said = " ".join(invoke("gate", gains).stdout.split())
    assert "may hold j1 anywhere" in said
    assert "at most" not in said
    wide = invoke(
        "gate", gains, "--vary", "coulomb=-0%..+200%"
    ).stdout  # up to 3 N·m, which k_p = 4 N·m holds
    assert f"leaves at most {math.degrees(math.atanh(3 / 4)):.2f}°" in wide


def test_an_eps0_over_ranges_is_that_of_all_their_friction(tmp_path):
    path = tmp_path / "gains.toml"
    sets = '[bounds]\nviscous_min = 0.1\n[[gains]]\nname = "a"\nm = 1\nkp = [20, 3]\nkv = [5.0, 0.9]\n'
    path.write_text(f'robot = "reyes-kelly2"\n{sets}', encoding="utf-8")
    words = ("gate", str(path), "--vary", "viscous=-30%..+9900%", "--condition", "scalar")
    _, result = one(*words, "--certificates", str(tmp_path / "made"))
    (row,) = [check for check in result["checks"] if check["id"] == "scalar"]
    assert 0 < Fraction(row["value"]) < Fraction(3, 100_000)
    statement = json.loads((tmp_path / "made" / "a.scalar.json").read_text())["statement"]
    assert max(Fraction(high) for _, high in statement["viscous"]) > 200


@pytest.mark.parametrize("conditions", [("scalar",), ("10p", "lasalle")])
def test_no_certificate_of_a_verdict_over_ranges_rests_on_the_nominal_arm(tmp_path, conditions):
    """Without --vary proofs are about nominal numbers; the verdict is about the ranges of the file."""
    gains = files(tmp_path, "", f"{{value = 1, low = 0.9, high = 1.1, {RANGED}}}", kp=5)
    options = [word for name in conditions for word in ("--condition", name)]
    for number, (vary, ranges) in enumerate([((), False), (("--vary", "mass=0.8..1.2"), True)]):
        made = tmp_path / f"made{number}"
        done = invoke("gate", gains, *options, *vary, "--certificates", str(made))
        assert done.exit_code == 0
        assert invoke("recheck", str(made)).exit_code == 0
        own = json.loads((made / f"a.{conditions[-1]}.json").read_text())["statement"]
        assert bool(own["parameters"]) is ranges
        whole = json.loads((made / "a.json").read_text())["statement"]
        if whole["kind"] == "GateAccepted":
            assert [part["parameters"] for part in whole["stability"]] == [[["4/5", "6/5"]]] * ranges
