"""Proof scripts of users: what they may write, what is refused, and how claims lean on each other."""

import csv
import io
import json
from dataclasses import replace

import pytest
from fastjsonschema import JsonSchemaException

from lyapcheck.claims import run_proof
from lyapcheck.errors import InputError
from lyapcheck.output.answer import JUDGED_FORMATS
from lyapcheck.output.document import Section, Table
from lyapcheck.verdicts import Exit, Verdict
from tests.helpers.json_schema import follows

pytestmark = pytest.mark.usefixtures("in_this_process")

HEAD = """
from lyapcheck.claims import *
proof = Proof("mine", "My proof")
x = var("x")
"""


@pytest.fixture
def write(tmp_path):
    def to_file(body, head=HEAD):
        path = tmp_path / "mine.py"
        path.write_text(head + body, encoding="utf-8")
        return path

    return to_file


def verdicts(path, **options):
    result = run_proof(path, **{"ms": (1,), "n": 2} | options)
    return {row.id: row for row in result.claims}


CHAIN = """
proof.add("a", "tanh x ≤ {slope} x", for_all(tanh(x) <= {slope} * x, 0))
proof.add("b", "1 ≤ 2", Constant(expr(1) <= 2), uses=["a"])
proof.add("c", "1 ≤ 3", Constant(expr(1) <= 3), uses=["b"])
proof.add("d", "3 ≤ 1", Constant(expr(3) <= 1), uses=["a"])
"""


def test_what_rests_on_a_proved_claim_is_proved_with_the_weakest_grade(write):
    rows = verdicts(write(CHAIN.replace("{slope}", "1")))
    assert [rows[k].verdict.value for k in "abcd"] == ["proved", "proved", "proved", "refuted"]
    assert rows["c"].decision.grade.label == "enclosure"
    assert rows["c"].broken == ()


def test_what_rests_on_a_refuted_claim_is_undecided_and_says_so(write):
    rows = verdicts(
        write(CHAIN.replace("{slope}", "Fraction(1, 2)"), HEAD + "from fractions import Fraction\n")
    )
    assert rows["a"].verdict is Verdict.REFUTED
    assert rows["b"].verdict is rows["c"].verdict is Verdict.UNDECIDED
    assert rows["b"].broken == ("a",)
    assert rows["c"].broken == ("b",)
    assert "rests on b" in rows["c"].decision.reason
    assert rows["d"].verdict is Verdict.REFUTED, "a witness needs nothing that it rests on"


def test_a_claim_that_looks_at_m_has_a_row_for_each_m_and_the_others_one(write):
    body = """
@proof.claim("m", "h_m is below 1.06")
def _(case):
    return for_all(h(case.m, x) <= "1.06")

proof.add("none", "1 ≤ 2", Constant(expr(1) <= 2))
proof.add("above", "1 ≤ 2", Constant(expr(1) <= 2), uses=["m"])
"""
    result = run_proof(write(body), ms=(2, 3), n=1)
    assert [(row.id, row.m, row.verdict.value) for row in result.claims] == [
        ("m", 2, "proved"),
        ("m", 3, "refuted"),
        ("none", None, "proved"),
        ("above", 2, "proved"),
        ("above", 3, "undecided"),
    ]
    assert result.exit_code is Exit.REFUTED


def test_a_norm_bound_may_hold_for_one_n_and_fail_for_another(write):
    path = write("""
@proof.claim("n", "‖h_2(x)‖ ≤ √2 γ_2")
def _(case):
    return norm_bound(h(2, x), case.n, sqrt(2) * gamma(2))
""")
    result = [verdicts(path, n=n)["n"] for n in (1, 2, 3)]
    assert [(row.n, row.verdict.value) for row in result] == [(1, "proved"), (2, "proved"), (3, "refuted")]


def test_a_variable_of_any_name_is_that_of_a_relation(write):
    path = write(
        "t = var('t')\nproof.add('a', '', for_all(tanh(t) <= t, 0))\nproof.add('b', '', for_all(-t < 1, -1))"
    )
    result = run_proof(path, ms=(1,), n=1)
    assert [row.decision.verdict.value for row in result.claims] == ["proved", "refuted"]


def test_only_some_claims_are_reported_but_what_they_use_is_decided(write):
    result = run_proof(write(CHAIN.replace("{slope}", "1")), ms=(1,), n=1, only=("c",))
    assert [row.id for row in result.claims] == ["c"]
    assert result.exit_code is Exit.PROVED


@pytest.mark.parametrize(
    ("body", "message"),
    [
        ("def f(:", "is not Python"),
        ("1 / 0", "raises ZeroDivisionError"),
        ("import no_such_module", "raises ModuleNotFoundError"),
        ("expr(0.5)", "not exact"),
        ("second = Proof('b', 'b')", "exactly one Proof"),
        (
            "proof.add('a', '', Constant(expr(1) <= 2), uses=['z'])",
            "uses a claim that the script does not make",
        ),
        (
            "proof.add('a', '', Constant(expr(1) <= 2), uses=['b'])\n"
            "proof.add('b', '', Constant(expr(1) <= 2), uses=['a'])",
            "in a circle",
        ),
        (
            "proof.add('a', '', Constant(expr(1) <= 2))\nproof.add('a', '', Constant(expr(1) <= 2))",
            "two claims",
        ),
        ("@proof.claim('a', '')\ndef _(case):\n    return case.nothing", "raises AttributeError"),
        ("from lyapcheck.claims import forall", r"cannot import name 'forall' .*'; did you mean for_all\?$"),
        ("constant_goal().gains('Kp')[0].mn", r"no attribute 'mn'; did you mean min\?"),
        ("constant_goal().gravty", r"'gravty'; did you mean gravity\?"),
        (
            "constant_goal().M * constant_goal().e",
            "a vector or matrix stands where a number must; write K @ x",
        ),
        ("constant_goal().e + 1", "a number stands beside a vector or matrix"),
        (
            "for_all(var('x') <= var('y'))",
            r'one variable, this has "x", "y"; write implies\(reals\("x", "y"\)',
        ),
        ("var('x') ** 0.5", r"0\.5 is no whole number; write sqrt\(x\)"),
        ("import math\nmath.tanh(var('x'))", "math and numpy take numbers, not letters"),
        ("import numpy\nnumpy.tanh(var('x'))", "math and numpy take numbers, not letters"),
        ("@proof.claim('a', '')\ndef _(case):\n    return 'true'", "not a statement"),
        ("@proof.claim('a', '')\ndef _(case):\n    return expr(1) <= 2", "not a statement"),
    ],
)
def test_a_script_that_cannot_be_used_is_refused_with_the_rule(write, body, message):
    with pytest.raises(InputError, match=message):
        run_proof(write(body), ms=(1,), n=1)


def test_a_script_error_names_its_line(write):
    with pytest.raises(InputError) as caught:
        run_proof(write("\n\n1 / 0\n"), ms=(1,), n=1)
    assert caught.value.problems[0].line == 7


def test_missing_scripts_and_ids_are_refused(write):
    with pytest.raises(InputError, match="no such proof script"):
        run_proof("nowhere.py")
    with pytest.raises(InputError, match="did you mean a"):
        run_proof(write("proof.add('alpha', '', Constant(expr(1) <= 2))"), n=1, only=("alpha2",))


def test_a_claim_about_a_robot_is_undecided_without_one(write):
    path = write("@proof.claim('r', 'M')\ndef _(case):\n    return gravity_bounded(case.robot)\n")
    assert "--robot" in verdicts(path)["r"].decision.reason
    assert verdicts(path, n=None, robot="reyes-kelly2")["r"].verdict is Verdict.PROVED


def test_output_is_the_same_every_time_and_has_no_clock(write):
    path = write(CHAIN.replace("{slope}", "1"))
    one, two = (run_proof(path, ms=(1,), n=2) for _ in range(2))
    for name in JUDGED_FORMATS:
        first, second = one.written(name), two.written(name)
        assert first == second
        assert "seconds" not in first
        assert (str(path) in first) == (name not in ("json", "csv", "latex"))


@pytest.mark.parametrize("timings", [False, True])
def test_json_has_the_fields_of_its_schema(write, timings):
    result = run_proof(write(CHAIN.replace("{slope}", "1")), ms=(1,), n=2)
    data = json.loads(replace(result, timings=timings).written("json"))
    follows(data, "check-2")
    assert all(("seconds" in row) == timings for row in data["claims"])
    assert data["counts"]["refuted"] == 1
    with pytest.raises(JsonSchemaException):
        follows(data | {"claims": [data["claims"][0] | {"says": ""}]}, "check-2")


def test_the_statement_is_what_was_decided_and_the_comment_the_authors_words(write):
    """Whatever an author says about 3 ≤ 1, it is 3 ≤ 1 that stands in every format."""
    result = run_proof(write('proof.add("d", "All is stable.", Constant(expr(3) <= 1))'), ms=(1,), n=2)
    result = replace(result, extent="all")
    (row,) = result.data()["claims"]
    assert (row["statement"], row["comment"], row["verdict"]) == ("3 ≤ 1", "All is stable.", "refuted")
    assert "✗  d      exact  3 ≤ 1\n" in str(result)
    table = result.written("markdown")
    assert "| ✗ | d | exact | 3 ≤ 1 |" in table
    assert "| the author's words: “All is stable.” |" in table
    (case,) = result.annotations()
    assert case.message.startswith("d refuted: 3 ≤ 1; ")
    for name in JUDGED_FORMATS:
        shown = result.written(name)
        assert ("3 ≤ 1" if name != "latex" else r"3 \ensuremath{\le} 1") in shown
        assert shown.count("All is stable.") == (2 if name == "sarif" else 1)


MEMBERS = """
@proof.claim("m", "h_m is below 1.06", section="Bounds")
def _(case):
    return for_all(h(case.m, x) <= "1.06")

proof.add("d", "3 ≤ 1", Constant(expr(3) <= 1), section="Numbers")
proof.add("above", "1 ≤ 2", Constant(expr(1) <= 2), uses=["m"], section="Numbers")
"""


def tables(block):
    """The tables of a document by the titles above them."""
    if isinstance(block, Table):
        yield (), block
    for inner in getattr(block, "blocks", ()):
        for titles, table in tables(inner):
            yield ((block.title, *titles) if isinstance(block, Section) else titles), table


def every(result):
    """The tables of all claims by the titles above them."""
    return dict(tables(replace(result, extent="all").document()))


def test_what_is_not_proved_comes_first_and_the_tally_is_the_title(write):
    found = run_proof(write(MEMBERS), ms=(1, 2, 3), n=1)
    document = found.document()
    assert document.title == "✗ 2 refuted, 1 undecided, 4 proved: mine"
    assert document.lead[0] == "My proof"
    assert [row[:3] for row in dict(tables(document))[()].rows] == [
        ("✗", "m (m = 3)", "refuted"),
        ("✗", "d", "refuted"),
        ("?", "above (m = 3)", "undecided"),
    ]
    assert list(every(found)) == [
        ("Refuted (2)", "Bounds"),
        ("Refuted (2)", "Numbers"),
        ("Undecided (1)", "Numbers"),
        ("Proved (4)", "Bounds"),
        ("Proved (4)", "Numbers"),
    ]


def test_every_claim_shows_verdict_m_grade_statement_words_and_what_supports_it(write):
    result = every(run_proof(write(MEMBERS), ms=(1, 2, 3), n=1))
    refuted = result["Refuted (2)", "Bounds"]
    assert refuted.heads == ("", "claim", "m", "grade", "statement")
    head, *below = refuted.rows
    assert head == ("✗", "m", "3", "enclosure", "h_3(x) ≤ 1.06 for all x in (−∞, ∞)")
    said = [row[-1] for row in below]
    assert said[0].startswith("witness: at x = ")
    assert " is not ≤ right 1.06" in said[0].replace("[1.05999999999, 1.06000000001]", "1.06")
    assert said[1] == "the author's words: “h_m is below 1.06”"
    assert said[2].startswith("method: ")
    assert all(row[:-1] == ("",) * 4 for row in below)
    (head, reason, _, _) = result["Undecided (1)", "Numbers"].rows
    assert head == ("?", "above", "3", "numeric", "1 ≤ 2")
    assert "rests on m" in reason[-1]


def test_the_words_for_several_m_stand_once(write):
    proved = every(run_proof(write(MEMBERS), ms=(1, 2), n=1))["Proved (4)", "Bounds"]
    assert [row[:3] for row in proved.rows if row[0]] == [("✓", "m", "1"), ("✓", "m", "2")]
    assert sum(row[-1].startswith("the author's words") for row in proved.rows) == 1


def test_systems_that_run_checks_get_a_case_a_claim(write):
    path = write(MEMBERS)
    cases = run_proof(path, ms=(1, 3), n=1).annotations()
    assert [(case.rule, case.case, case.level.value) for case in cases] == [
        ("m", "m = 1", "passed"),
        ("m", "m = 3", "failed"),
        ("d", "", "failed"),
        ("above", "m = 1", "passed"),
        ("above", "m = 3", "undecided"),
    ]
    assert {case.path for case in cases} == {str(path)}
    assert {case.group for case in cases} == {"My proof"}
    assert all(bool(case.message) == (case.level.value != "passed") for case in cases)


def test_a_row_of_the_csv_is_a_claim_and_an_m(write):
    rows = list(csv.DictReader(io.StringIO(run_proof(write(MEMBERS), ms=(1, 3), n=1).written("csv"))))
    assert [(row["id"], row["m"], row["verdict"]) for row in rows] == [
        ("m", "1", "proved"),
        ("m", "3", "refuted"),
        ("d", "", "refuted"),
        ("above", "1", "proved"),
        ("above", "3", "undecided"),
    ]
    assert rows[1]["witness"].startswith("at x = ")
    assert rows[4]["uses"] == rows[4]["broken"] == "m"


def test_a_claim_is_handed_what_its_arguments_name(write):
    """A function that asks for what there is not is the author's mistake; a default is its own."""
    body = "@proof.claim('a', '')\ndef _(n, k=2):\n    return Constant(expr(n) < k + 2)\n"
    (row,) = run_proof(write(body), ms=(1, 2), n=3).claims
    assert (row.m, row.n, row.statement) == (None, 3, "3 < 4")
    with pytest.raises(InputError, match="asks for 'joints'; it may ask for m, n, robot, gains"):
        run_proof(write("@proof.claim('a', '')\ndef _(joints):\n    return Constant(expr(1) < 2)\n"), n=3)


def test_variables_are_declared_before_they_are_used(write):
    body = "R = Reals()\n(k,) = R.positive('k')\nproof.add('a', '', R.implies([k <= 1], k**2 <= 1))\n"
    (row,) = run_proof(write(body), n=1).claims
    assert (row.verdict.value, row.statement) == ("proved", "for all k > 0: if k ≤ 1, then k² ≤ 1")
    with pytest.raises(InputError, match="x: declare its range first"):
        run_proof(write(body + "R.implies([k <= 1], k * var('x') <= 1)\n"), n=1)
