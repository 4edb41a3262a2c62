"""Certificates of ε₀: accepted as they are written, refused when anything that matters is changed."""

import json
from dataclasses import replace
from fractions import Fraction

import pytest

from lyapcheck.answers.epsilon.compute import epsilon
from lyapcheck.answers.epsilon.kept import certificates
from lyapcheck.check.certificate import digest_of, judge, parse, read
from lyapcheck.check.refusal import Refused
from lyapcheck.control.gains import paper_gain_file, read_gain_file
from lyapcheck.output.digits import at_least
from lyapcheck.robots import load
from tests.helpers.command import invoke

pytestmark = pytest.mark.usefixtures("in_this_process")

F = Fraction


@pytest.fixture(scope="module")
def pair():
    """The certificates for and against, of one gain set on the two-joint arm."""
    gains = read_gain_file(paper_gain_file("table2_shoulder_elbow")).gains[0]
    made = certificates(epsilon(gains, load("reyes-kelly2"), starts=3, max_boxes=4_000, weights=False))
    return made["tau_m1.certified.json"], made["tau_m1.falsified.json"]


def reread(certificate, change=lambda data: None):
    """The certificate from its text, changed by somebody who knows how to make a digest."""
    data = json.loads(certificate.text())
    change(data)
    data["digest"] = digest_of({key: value for key, value in data.items() if key != "digest"})
    return read(parse(json.dumps(data)))


def test_both_are_accepted(pair):
    certified, falsified = pair
    assert judge(reread(certified)).verdict == "proved"
    assert judge(reread(falsified)).verdict == "refuted"


@pytest.mark.slow
def test_a_proof_never_says_more_than_the_refutation_allows(pair):
    certified, falsified = pair
    moved = replace(certified, statement=falsified.statement)
    with pytest.raises(Refused):
        judge(moved)


@pytest.mark.slow
def test_the_command_writes_what_recheck_accepts(tmp_path):
    folder = tmp_path / "certificates"
    gains = str(paper_gain_file("table2_shoulder_elbow"))
    options = ["--m", "1", "--starts", "4", "--max-boxes", "2000", "--ranges"]
    first = invoke("epsilon", gains, *options, "--certificates", str(folder))
    assert first.exit_code == 0, first.output
    names = sorted(path.name for path in folder.iterdir())
    kinds = ("certified", "falsified", "scalar", "weighted")
    assert names == [f"tau_m1.{kind}.json" for kind in kinds]
    again = invoke("recheck", str(folder))
    assert again.exit_code == 0, again.output
    assert "4 accepted" in again.output


@pytest.mark.slow
def test_what_is_certified_has_its_certificate_however_few_the_boxes(tmp_path):
    """With one box nothing but norms or bounds in ‖e‖ is left."""
    gains = read_gain_file(paper_gain_file("table2_shoulder_elbow")).gains[1]
    result = epsilon(gains, load("reyes-kelly2"), starts=3, max_boxes=1, weights=False)
    made = certificates(result)
    assert result.certified is not None
    assert made["tau_m2.certified.json"].statement.eps0 == result.certified  # type: ignore[attr-defined]
    assert judge(reread(made["tau_m2.certified.json"])).verdict == "proved"
    assert (result.scalar_grade == "no certificate") == ("tau_m2.scalar.json" not in made)
    row = result.data()["results"][0]
    assert row["scalar_grade"] == result.scalar_grade == "no certificate"
    text = str(result)
    assert f"{at_least(F(row['scalar']))}*" in text
    assert "without a certificate" in text
