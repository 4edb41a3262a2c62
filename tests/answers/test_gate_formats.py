"""What the gate says in each format, and where it points."""

import json
from fractions import Fraction
from pathlib import Path

import pytest
from hypothesis import given
from hypothesis import strategies as st

from lyapcheck.answers.gate import GateAnswer, gate
from lyapcheck.answers.gate.words import significant_text
from lyapcheck.control.gains import paper_gain_file, read_gain_file
from lyapcheck.output.answer import Level


@pytest.fixture(scope="module")
def paper():
    return gate(read_gain_file(paper_gain_file("table2")))


@pytest.fixture(scope="module")
def undecided(tmp_path_factory):
    path = tmp_path_factory.mktemp("gate") / "g.toml"
    path.write_text("robot = 'pelican2'\n[[gains]]\nname = 'u'\nm = 2\nkp = [1, 1]\nkv = [0.001, 0.001]\n")
    return gate(read_gain_file(path))


BREAK = "break (19), stability proved otherwise"


def test_the_title_counts_sets_or_names_the_only_one(paper, undecided):
    assert paper.document().title == f"✗ 2 {BREAK}; 1 accepted"
    assert GateAnswer([*paper, *undecided]).document().title == f"✗ 2 {BREAK}; 1 undecided; 1 accepted"
    assert undecided.document().title == "? u: undecided, (10p) at shoulder and elbow"
    assert GateAnswer(paper[:1]).document().title == (
        "! tau_m1: accepted; dry friction (assumed) leaves at most 20.73°"
    )
    assert GateAnswer(paper[1:2]).document().title == (
        "✗ tau_m2: breaks (19), stability proved otherwise at nominal numbers"
    )


def test_the_title_names_joints_whose_dry_friction_nobody_stated(tmp_path):
    whole = (Path(__file__).parents[2] / "examples" / "init" / "arm.toml").read_text()
    (tmp_path / "arm.toml").write_text(whole.replace("coulomb = 0.4\n", ""))
    sets = "[[gains]]\nname = 'g'\nm = 1\nkp = [22, 10]\nkv = [12, 3]\ncondition = ['10i', 'lasalle']\n"
    (tmp_path / "g.toml").write_text(f"robot = 'arm.toml'\n{sets}")
    title = gate(tmp_path / "g.toml").document().title
    assert title.endswith("leaves at most 2.607°, unknown at elbow")


# --- JSON --------------------------------------------------------------------------------------------


def test_numbers_of_json_are_decimal_strings_that_enclose(paper):
    document = json.loads(paper.written("json"))
    for result, printed in zip(paper, document["results"], strict=True):
        for check, shown in zip(result.checks, printed["checks"], strict=True):
            assert check.limit is not None
            low, high = Fraction(shown["limit"]["lower"]), Fraction(shown["limit"]["upper"])
            assert low <= check.limit.lower <= check.limit.upper <= high
            assert high - low < Fraction(1, 10**15)
            assert Fraction(shown["value"]) == check.value
            assert Fraction(shown["margin"]) <= low - check.value + Fraction(1, 10**10)
            assert (Fraction(shown["margin"]) > 0) == (shown["verdict"] == "accepted")
            assert Fraction(shown["largest_admissible"]) == check.largest_admissible


# --- annotations -------------------------------------------------------------------------------------


def test_gains_below_the_dry_friction_are_told_though_accepted(tmp_path):
    """A slip of units by a thousand: theory accepts it, and the arm would not move."""
    path = tmp_path / "g.toml"
    path.write_text(
        'robot = "buap3"\n[[gains]]\nname = "slip"\nm = 1\nkp = [0.025, 60, 5]\nkv = [0.1, 0.1, 0.1]\n'
    )
    answer = gate(read_gain_file(path))
    assert answer[0].verdict == "accepted"
    said = "γ k_p of base does not exceed its dry friction of up to 7.17 N·m (assumed)"
    assert said in str(answer).replace("\n  ", " ")
    (remark,) = [one for one in answer.annotations() if one.level is Level.REMARK]
    assert (remark.rule, remark.path) == ("dry-friction", str(path))
    assert said in remark.message
    assert "shoulder" not in remark.message


def sarif(results):
    result = json.loads(GateAnswer(results).written("sarif"))["runs"][0]["results"]
    return result


def test_undecided_warns_and_fails_where_the_gate_is_strict(undecided):
    assert {(one["level"], one["ruleId"]) for one in sarif(undecided)} == {("warning", "gate")}
    strict = gate(undecided[0].file, strict=True)
    assert {one["level"] for one in sarif(strict)} == {"error"}


# --- what to change ----------------------------------------------------------------------------------


@given(st.fractions(), st.integers(1, 12))
def test_a_margin_is_never_shown_larger_than_it_is(value, digits):
    shown = Fraction(significant_text(value.numerator, value.denominator, digits))
    assert shown <= value
    if value:
        assert value - shown <= max(abs(value) * Fraction(10) ** (1 - digits), Fraction(1, 10**40))
