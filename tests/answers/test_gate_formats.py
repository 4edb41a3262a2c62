"""What the gate says in each format, and where it points."""

import json
import re
from fractions import Fraction
from pathlib import Path
from xml.etree import ElementTree as ET

import pytest
from hypothesis import given
from hypothesis import strategies as st

from lyapcheck.answers.gate import GateAnswer, gate
from lyapcheck.answers.gate.words import significant_text
from lyapcheck.control.gains import paper_gain_file, read_gain_file
from lyapcheck.output.answer import JUDGED_FORMATS, Level
from lyapcheck.output.document import Table
from lyapcheck.output.text import Depth, View


@pytest.fixture(scope="module")
def paper():
    return gate(read_gain_file(paper_gain_file("table2")))


@pytest.fixture(scope="module")
def undecided(tmp_path_factory):
    path = tmp_path_factory.mktemp("gate") / "g.toml"
    path.write_text("robot = 'pelican2'\n[[gains]]\nname = 'u'\nm = 2\nkp = [1, 1]\nkv = [0.001, 0.001]\n")
    return gate(read_gain_file(path))


@pytest.mark.parametrize("name", JUDGED_FORMATS)
def test_each_format_tells_the_whole_outcome(name, paper):
    text = paper.written(name, View(Depth.VERBOSE)).replace(r"\_", "_")
    for part in ("tau_m2", "tau_m3", "0.223", "0.222", "0.210", "shoulder"):
        assert part in text


@pytest.mark.parametrize("name", JUDGED_FORMATS)
def test_what_is_undecided_says_why(name, undecided):
    text = undecided.written(name)
    assert "torque limit" in text
    assert "undecided" in text or name in ("junit", "sarif")


BREAK = "break (19), stability proved otherwise"


def test_the_title_counts_sets_or_names_the_only_one(paper, undecided):
    assert paper.document().title == f"✗ 2 {BREAK}; 1 accepted"
    assert GateAnswer([*paper, *undecided]).document().title == f"✗ 2 {BREAK}; 1 undecided; 1 accepted"
    assert undecided.document().title == "? u: undecided, (10p) at shoulder and elbow"
    assert GateAnswer(paper[:1]).document().title == (
        "! tau_m1: accepted; dry friction (assumed) leaves at most 20.73°"
    )
    assert GateAnswer(paper[1:2]).document().title == "✗ tau_m2: breaks (19), stability proved otherwise"


def test_the_title_names_joints_whose_dry_friction_nobody_stated(tmp_path):
    whole = (Path(__file__).parents[2] / "examples" / "init" / "arm.toml").read_text()
    (tmp_path / "arm.toml").write_text(whole.replace("coulomb = 0.4\n", ""))
    sets = "[[gains]]\nname = 'g'\nm = 1\nkp = [22, 10]\nkv = [12, 3]\ncondition = ['10i', 'lasalle']\n"
    (tmp_path / "g.toml").write_text(f"robot = 'arm.toml'\n{sets}")
    title = gate(tmp_path / "g.toml").document().title
    assert title.endswith("leaves at most 2.607°, unknown at elbow")


def test_failing_rows_come_first_and_details_have_all(paper):
    document = paper.document()
    (table,) = [block for block in document.blocks if isinstance(block, Table)]
    assert [row[:2] for row in table.rows] == [("✗", "tau_m3"), ("✗", "tau_m2"), ("✓", "tau_m1")]
    *sections, formulas = document.details
    for section, result in zip(sections, paper, strict=True):
        every, (*_, bullets) = section.blocks[0], section.blocks
        assert len(every.rows) == len(result.checks) == 7
        broken = [line for line in bullets.items if line.startswith("(19) base, shoulder, elbow: k_v = ")]
        assert len(broken) == (result.verdict != "accepted")
    assert "(19) k_v < λmin(B)/(√n γ)" in formulas.blocks[0].items


# --- JSON --------------------------------------------------------------------------------------------


def test_json_has_the_fields_that_scripts_rely_on(paper):
    document = json.loads(paper.written("json"))
    assert document["schema"] == "lyapcheck/gate/1"
    assert [(result["name"], result["m"], result["verdict"]) for result in document["results"]] == [
        ("tau_m1", 1, "accepted"),
        ("tau_m2", 2, "rejected"),
        ("tau_m3", 3, "rejected"),
    ]
    for result in document["results"]:
        assert [(check["id"], check["joint"]) for check in result["checks"]] == [
            ("10", None),
            *[("10p", joint) for joint in ("base", "shoulder", "elbow")],
            *[("19", joint) for joint in ("base", "shoulder", "elbow")],
        ]
        for check in result["checks"]:
            assert check.keys() >= {
                "id",
                "joint",
                "verdict",
                "value",
                "limit",
                "margin",
                "largest_admissible",
            }
            assert check["verdict"] in ("accepted", "rejected", "undecided")


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


def test_json_of_what_has_no_limit(undecided):
    (result,) = json.loads(undecided.written("json"))["results"]
    norm = result["checks"][0]
    assert (norm["verdict"], norm["limit"], norm["margin"], norm["largest_admissible"]) == (
        "undecided",
        None,
        None,
        None,
    )
    assert result["verdict"] == "undecided"


# --- JUnit -------------------------------------------------------------------------------------------


def test_junit_counts_what_it_lists(paper, undecided):
    top = ET.fromstring(GateAnswer([*paper, *undecided]).written("junit"))
    assert top.tag == "testsuites"
    assert [suite.get("name") for suite in top] == ["tau_m1", "tau_m2", "tau_m3", "u"]
    for suite in top:
        assert suite.get("tests") == str(len(suite.findall("testcase")))
        assert suite.get("failures") == str(len(suite.findall("testcase/failure")))
        assert suite.get("skipped") == str(len(suite.findall("testcase/skipped")))
    assert [suite.get("tests") for suite in top] == ["1", "1", "1", "1"]
    assert [suite.get("failures") for suite in top] == ["0", "1", "1", "0"]
    assert [suite.get("skipped") for suite in top] == ["0", "0", "0", "1"]
    failure = top.find("testsuite[2]/testcase/failure")
    assert failure is not None
    assert "lower it to at most 0.222" in (failure.get("message") or "")


# --- annotations -------------------------------------------------------------------------------------


def test_annotations_point_at_the_gain(paper):
    lines = paper_gain_file("table2").read_text().splitlines()
    failed = [one for one in paper.annotations() if one.level is Level.FAILED]
    assert [(one.rule, one.group, one.case) for one in failed] == [
        ("gate", "tau_m2", ""),
        ("gate", "tau_m3", ""),
    ]
    for one in failed:
        assert one.path == str(paper_gain_file("table2"))
        assert lines[one.line - 1].startswith("kv")
        assert lines[one.line - 1][one.column - 1 :].startswith("0.223")
        assert one.message.startswith("breaks (19), stability proved otherwise; (19) base, shoulder, elbow: ")
        assert "k_v = 0.223 breaks" in one.message
        assert one.message.endswith("; --condition 10p --condition scalar accepts it")
    assert not [one for one in paper.annotations() if one.level is Level.REMARK]


def test_a_set_is_one_annotation(paper, undecided):
    """A reader of the pull request is not told an error first and a notice that takes it back after."""
    lines = GateAnswer([*paper, *undecided]).written("github").splitlines()
    assert [line.partition(" ")[0] for line in lines] == ["::error", "::error", "::warning", "::notice"]
    assert lines[-1].startswith("::notice title=lyapcheck gate::")


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


def test_conditions_that_do_not_decide_are_no_cases(paper):
    (text,) = {one.rule_text for one in paper.annotations()}
    assert text == "the gains meet (10p), (19)"


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


def test_what_to_change_would_pass(tmp_path):
    """Doing what each message says makes the gate accept."""
    path = tmp_path / "g.toml"
    kp, kv = ["29.5", "60.5", "9.5"], ["0.3", "0.3", "0.3"]
    for _ in range(3):
        path.write_text(
            f"robot = 'buap3'\n[[gains]]\nname = 'a'\nm = 2\nkp = [{', '.join(kp)}]\nkv = [{', '.join(kv)}]\n"
        )
        (result,) = gate(read_gain_file(path))
        (row,) = json.loads(GateAnswer([result]).written("json"))["results"]
        printed = [item["message"] for item in row["checks"] if item["message"]]
        for check, text in zip(result.failures, printed, strict=False):
            assert check.joint is not None
            changed = re.search(r"lower (k_p|it) to at most ([0-9.]+)$", text)
            assert changed, text
            (kp if changed[1] == "k_p" else kv)[check.joint] = changed[2]
    assert result.verdict == "accepted"


# --- Python and notebooks ------------------------------------------------------------------------------


def test_results_print_as_the_command_does(paper):
    assert f"{paper}\n" == paper.written("text")
    shown = paper._repr_html_()
    assert f"✗ tau_m2: {BREAK.replace('break', 'breaks')}" in shown
    assert "lower it to at most 0.222" in shown
