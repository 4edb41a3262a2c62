"""Proof scripts of users: what they may write, what is refused, and how claims lean on each other."""

from dataclasses import replace

import pytest

from lyapcheck.claims import run_proof
from lyapcheck.errors import InputError
from lyapcheck.output.document import Section, Table
from lyapcheck.verdicts import Exit, Verdict

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
