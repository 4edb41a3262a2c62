"""A gain file that names a folder of certificates: the gate rechecks them and searches nothing."""

from __future__ import annotations

import json
from fractions import Fraction

import pytest

from tests.arena.attacks import encoded, sealed
from tests.helpers.command import invoke

GAINS = 'robot = "{arm}"\n{folder}[[gains]]\nname = "g"\nm = 1\nkp = {kp}\nkv = {kv}\n'


def gain_file(folder, name, arm="reyes-kelly2", kp="[5, 1]", kv="[0.5, 0.1]", proofs="proofs"):
    text = GAINS.format(arm=arm, folder=f'certificates = "{proofs}"\n' if proofs else "", kp=kp, kv=kv)
    (folder / name).write_text(text)
    return str(folder / name)


@pytest.fixture
def without_a_search(monkeypatch):
    """Nothing that searches is installed."""
    monkeypatch.setattr("lyapcheck.errors.installed", lambda name: False)


def verdict(file, *options):
    end = invoke("gate", file, *options, "--format", "json")
    return json.loads(end.stdout)["results"][0] if end.exit_code in (0, 1, 3) else end


@pytest.fixture
def proved(tmp_path):
    """A folder with the certificate of the condition global of one gain set."""
    file = gain_file(tmp_path, "search.toml", proofs="")
    folder = str(tmp_path / "proofs")
    assert invoke("gate", file, "--condition", "global", "--certificates", folder).exit_code == 0
    return tmp_path


def test_a_folder_answers_what_no_search_can(proved, without_a_search):
    assert (
        verdict(gain_file(proved, "bare.toml", proofs=""), "--condition", "global")["verdict"] == "undecided"
    )
    found = verdict(gain_file(proved, "kept.toml"), "--condition", "global")
    assert found["verdict"] == "accepted"
    assert Fraction(found["stable_otherwise"]["eps0"]) > 0


@pytest.mark.parametrize(
    "other", [{"kp": "[5, 1.001]"}, {"kv": "[0.5, 0.2]"}, {"arm": "pelican2"}], ids=["kp", "kv", "arm"]
)
def test_certificates_of_other_gains_or_another_arm_do_not_count(proved, without_a_search, other):
    found = verdict(gain_file(proved, "other.toml", **other), "--condition", "global")
    assert found["verdict"] == "undecided"


def test_a_certificate_with_another_number_is_judged_again_and_does_not_count(proved, without_a_search):
    for path in (proved / "proofs").glob("*.json"):
        document = json.loads(path.read_text())
        if document["statement"]["kind"] == "Decreasing":
            document["statement"]["eps0"] = "1000"
            path.write_bytes(encoded(sealed(document)))
        else:
            path.unlink()
    assert verdict(gain_file(proved, "kept.toml"), "--condition", "global")["verdict"] == "undecided"


def test_a_folder_that_is_not_there_is_an_error_at_its_line(tmp_path):
    end = invoke("gate", gain_file(tmp_path, "kept.toml", proofs="nowhere"), "--condition", "global")
    assert end.exit_code == 2
    assert "kept.toml:2: certificates = " in str(end.exception)
    assert "--certificates DIR" in str(end.exception)


def test_what_is_no_certificate_is_passed_over(proved, without_a_search):
    (proved / "proofs" / "notes.json").write_text('{"no": "certificate"}')
    (proved / "proofs" / "broken.json").write_bytes(b"\xff{")
    assert verdict(gain_file(proved, "kept.toml"), "--condition", "global")["verdict"] == "accepted"
