"""Certificates of ε₀: accepted as they are written, refused when anything that matters is changed."""

from __future__ import annotations

import json
from collections.abc import Callable
from dataclasses import replace
from fractions import Fraction
from pathlib import Path
from typing import Any

import pytest

from lyapcheck.answers.epsilon import epsilon
from lyapcheck.answers.epsilon.certificates import certificates
from lyapcheck.certificate import Certificate
from lyapcheck.check.certificate import digest_of, judge, parse, read
from lyapcheck.check.kinds.decreasing import Decreasing, LargerKv, PositiveAndDecreasing
from lyapcheck.check.refusal import Refused
from lyapcheck.control.gains import read_gain_file
from lyapcheck.control.paper import paper_gain_file
from lyapcheck.robots import load
from tests.helpers.command import invoke
from tests.helpers.shares import one_in

pytestmark = pytest.mark.usefixtures("in_this_process")

F = Fraction
Document = dict[str, Any]


@pytest.fixture(scope="module")
def pair() -> tuple[Certificate, Certificate]:
    """The certificates for and against, of one gain set on the two-joint arm."""
    gains = read_gain_file(paper_gain_file("table2_shoulder_elbow")).gains[0]
    made = certificates(epsilon(gains, load("reyes-kelly2"), starts=6, max_boxes=8_000))
    return made["tau_m1.certified.json"], made["tau_m1.falsified.json"]


def reread(certificate: Certificate, change: Callable[[Document], None] = lambda data: None) -> Certificate:
    """The certificate from its text, changed by somebody who knows how to make a digest."""
    data = json.loads(certificate.text())
    change(data)
    data["digest"] = digest_of({key: value for key, value in data.items() if key != "digest"})
    return read(parse(json.dumps(data)))


def test_both_are_accepted(pair: tuple[Certificate, Certificate]) -> None:
    certified, falsified = pair
    assert judge(reread(certified)).verdict == "proved"
    assert judge(reread(falsified)).verdict == "refuted"


def test_any_change_without_a_new_digest_is_refused(pair: tuple[Certificate, Certificate]) -> None:
    data = json.loads(pair[0].text())
    data["statement"]["eps0"] = "1/1000"
    with pytest.raises(Refused, match="digest"):
        read(parse(json.dumps(data)))


def put(value: Any, *path: Any) -> Callable[[Document], None]:
    """Put a value at a place."""

    def change(data: Document) -> None:
        for step in path[:-1]:
            data = data[step]
        data[path[-1]] = value

    return change


def scale(factor: Fraction, *path: Any) -> Callable[[Document], None]:
    """Multiply a rational at a place."""

    def change(data: Document) -> None:
        for step in path[:-1]:
            data = data[step]
        data[path[-1]] = str(F(data[path[-1]]) * factor)

    return change


AGAINST_PROOF = {
    "larger ε₀": scale(F(11, 10), "statement", "eps0"),
    "negative ε₀": scale(F(-1), "statement", "eps0"),
    "less friction": lambda data: [
        data["statement"]["viscous"][i].__setitem__(k, "1/10") for i in (0, 1) for k in (0, 1)
    ],
    "a range of friction": put(["1/100", "3"], "statement", "viscous", 0),
    "reversed range": put(["3", "1/100"], "statement", "viscous", 0),
    "no proportional gain": put("0", "statement", "kp", 0),
    "more inertia": scale(F(2), "statement", "mass", 0, 0, 0, 1),
    "asymmetric inertia": scale(F(2), "statement", "mass", 0, 1, 0, 1),
    "other function": put("linear", "statement", "family"),
    "steeper member": put(9, "statement", "m"),
    "member 0": put(0, "statement", "m"),
    "fewer joints": lambda data: data["statement"]["kp"].pop(),
    "a gap in the tree": lambda data: data["proof"]["rate"].update(tree=data["proof"]["rate"]["tree"][:-1]),
    "one box for all": put(".", "proof", "rate", "tree"),
    "unknown side": lambda data: data["proof"]["rate"].update(tree="9" + data["proof"]["rate"]["tree"][1:]),
    "no tree": put("", "proof", "rate", "tree"),
    "other verdict": put("refuted", "verdict"),
    "better grade": put("exact", "grade"),
    "negative exponent": put(-1, "statement", "mass", 0, 0, 0, 0, 0),
    "unknown parameter": put([["0", "1"]], "statement", "parameters"),
}


@pytest.mark.parametrize("name", one_in(4, AGAINST_PROOF))
def test_a_proof_changed_for_the_worse_is_refused(pair: tuple[Certificate, Certificate], name: str) -> None:
    with pytest.raises(Refused):
        judge(reread(pair[0], AGAINST_PROOF[name]))


AGAINST_REFUTATION = {
    "smaller ε₀": scale(F(9, 10), "statement", "eps0"),
    "another rate": scale(F(-1), "proof", "w", 0),
    "at the origin": lambda data: data["proof"].update(e=["0", "0"], w=["0", "0"]),
    "no rates": put([], "proof", "w"),
    "another arm": put("1", "proof", "viscous", 0),
    "proved": put("proved", "verdict"),
    "uses something": put({"x": "0" * 64}, "uses"),
}


@pytest.mark.parametrize("name", AGAINST_REFUTATION)
def test_a_changed_refutation_is_refused(pair: tuple[Certificate, Certificate], name: str) -> None:
    with pytest.raises(Refused):
        judge(reread(pair[1], AGAINST_REFUTATION[name]))


@pytest.mark.slow
def test_a_proof_never_says_more_than_the_refutation_allows(pair: tuple[Certificate, Certificate]) -> None:
    certified, falsified = pair
    moved = replace(certified, statement=falsified.statement)
    with pytest.raises(Refused):
        judge(moved)


@pytest.mark.slow
def test_the_command_writes_what_recheck_accepts(tmp_path: Path) -> None:
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
def test_what_is_certified_has_its_certificate_however_few_the_boxes(tmp_path: Path) -> None:
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
    assert f"{row['scalar']}*" in text
    assert "without a certificate" in text


@pytest.mark.slow
def test_an_arm_that_cannot_exist_has_no_certified_number(tmp_path: Path) -> None:
    arm = 'title = "t"\nsource = "a test"\n[model]\nM11 = [[1, ""], [1.05, "c2"]]\nM12 = [[0.1, ""]]\n'
    arm += 'M22 = [[1, ""]]\npotential = [[-1, "c1"]]\n'
    arm += "".join(f'[[joints]]\nname = "{name}"\nviscous = 2\n' for name in "ab")
    (tmp_path / "arm.toml").write_text(arm)
    gains = read_gain_file(paper_gain_file("table2_shoulder_elbow")).gains[1]
    result = epsilon(gains, load(str(tmp_path / "arm.toml")), starts=2, max_boxes=100, weights=False)
    assert (result.certified, result.proof, result.scalar_proof, result.weighted) == (None, None, None, None)
    assert "M(q) is not positive definite at q = (" in result.reasons["certified"]
    assert not [name for name in certificates(result) if "falsified" not in name]


@pytest.mark.slow
def test_an_unbounded_function_has_nothing_certified() -> None:
    gains = read_gain_file(paper_gain_file("table2_pd")).gains[0]
    result = epsilon(gains, load("buap3"), starts=2, max_boxes=100, weights=False)
    assert (result.certified, certificates(result)) == (None, {})
    assert "unbounded" in result.reasons["certified"]


def test_what_is_proved_holds_for_every_smaller_kv_and_no_larger_one(
    pair: tuple[Certificate, Certificate],
) -> None:
    """K_v brakes alone: for less of it, of more than nothing, in each joint; a joint with more is refused."""
    certified = pair[0]
    stated, proof = certified.statement, certified.proof
    assert isinstance(stated, Decreasing)
    assert isinstance(proof, PositiveAndDecreasing)

    def judged(kv: tuple[Fraction, ...], larger: tuple[Fraction, ...] = stated.kv) -> str:
        other = replace(certified, statement=replace(stated, kv=kv), proof=LargerKv(larger, proof))
        return judge(reread(other)).verdict

    first, second = stated.kv
    assert judged((first, second)) == judged((first / 1000, second / 3)) == "proved"
    for worse in ((first * F(1001, 1000), second), (first / 2, second * 2), (F(0), second), (-first, second)):
        with pytest.raises(Refused, match="kv"):
            judged(worse)
    with pytest.raises(Refused, match="must be as many"):
        judged((first, second), (first,))
    with pytest.raises(Refused):
        judged(stated.kv, (first * 10**9, second))
