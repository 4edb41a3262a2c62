"""The example proofs: one of another family that is proved, and one that must not be accepted."""

from fractions import Fraction
from pathlib import Path

import pytest

from lyapcheck.check.certificate import judge
from lyapcheck.claims import run_proof
from lyapcheck.claims.script import find_script
from lyapcheck.report.findings import witness_words
from lyapcheck.report.model import ClaimRow
from lyapcheck.verdicts import Exit, Verdict
from tests.helpers.command import invoke
from tests.helpers.shares import one_in

pytestmark = pytest.mark.usefixtures("in_this_process")

EXAMPLES = Path(find_script("published.py")).parent / "examples"
ARCTAN, MUST_FAIL = EXAMPLES / "arctan.py", EXAMPLES / "must_fail.py"


def verdicts(path, **options):
    rows = run_proof(path, ms=(1,), **options).claims
    return {row.id: row.verdict.value for row in rows}


@pytest.mark.parametrize("options", one_in(3, [{"n": 1}, {}, {"n": 5}]))
def test_arctan_is_proved_for_any_number_of_joints(options):
    result = verdicts(ARCTAN, **options)
    if options:
        assert result.pop("arm") == "undecided", "a number of joints is no arm"
    assert set(result.values()) == {"proved"}


@pytest.mark.slow
def test_the_wrong_claims_are_refuted_and_what_rests_on_them_is_open():
    result = run_proof(MUST_FAIL, ms=(1,))
    outcome = {row.id: row.verdict.value for row in result.claims}
    assert outcome == {
        "wrong": "refuted",
        "rests": "undecided",
        "sign": "refuted",
        "large": "refuted",
        "right": "proved",
    }
    assert result.exit_code is Exit.REFUTED
    for certificate in result.certificates.values():
        assert judge(certificate).verdict == outcome[certificate.claim.id]


def test_both_sides_of_a_refuted_inequality_look_different():
    result = run_proof(MUST_FAIL, ms=(1,), only=("wrong",))
    row = ClaimRow.of(result.claims[0], result.name, result.title, None, None)
    left, right = (row.decision.witness[side] for side in ("left", "right"))
    assert Fraction(left[0]) > Fraction(right[1])
    shown = witness_words(row)
    first, second = shown.split(" at ")[0].split(" is not ≤ ")
    assert first != second


def test_the_command_says_so_too():
    run = invoke("check", str(MUST_FAIL), "--m", "1", "--only", "wrong")
    assert run.exit_code == Exit.REFUTED
    assert "✗  wrong " in run.output


ARCTAN_BOUNDS = 'gamma="1.58", rho=1, L=1'
CHANGES = [
    (ARCTAN, "bound", "atan(x) <= pi / 2", "atan(x) <= '1.57'"),
    (ARCTAN, "slope", ARCTAN_BOUNDS, "gamma='1.58', rho=1, L='0.99'"),
    (ARCTAN, "steep", ARCTAN_BOUNDS, "gamma='1.58', rho='0.99', L=1"),
    (ARCTAN, "potential", "log(1 + x**2) / 2", "log(1 + x**2)"),
    (ARCTAN, "bounds", "term_9=term(9, eps**2 * known.reach", "term_9=term(9, eps**3 * known.reach"),
    (ARCTAN, "arm", '"0.02"', '"20"'),
    (ARCTAN, "sizes", ARCTAN_BOUNDS, "gamma='1.57', rho=1, L=1"),
    (ARCTAN, "sizes", ARCTAN_BOUNDS, "gamma='1.58', rho='0.99', L=1"),
    (ARCTAN, "sizes", ARCTAN_BOUNDS, "gamma='1.58', rho=1, L='0.99'"),
    (ARCTAN, "positive", "log(1 + x**2) / 2", "log(1 + x**2)"),
    (ARCTAN, "positive", "log(1 + x**2) / 2", "log(2 + x**2) / 2"),
    (ARCTAN, "smooth", "SLOPE = 1 / (1 + x**2)", "SLOPE = 1 / (2 + x**2)"),
    (MUST_FAIL, "right", "x - x**3 / 3 <= atan(x), 0)", "x - x**3 / 4 <= atan(x), 0)"),
]


@pytest.mark.parametrize(("path", "claim", "right", "wrong"), one_in(6, CHANGES))
def test_a_changed_statement_changes_the_verdict(tmp_path, path, claim, right, wrong):
    source = path.read_text(encoding="utf-8")
    assert right in source
    changed = tmp_path / "changed.py"
    changed.write_text(source.replace(right, wrong), encoding="utf-8")
    row = run_proof(changed, ms=(1,), only=(claim,)).claims[0]
    assert row.verdict in (Verdict.REFUTED, Verdict.UNDECIDED)


REPAIRS = [
    ("wrong", "x - x**3 / 3, 0)", "x, 0)"),
    ("sign", "w) / 2 + ε", "w) / 2 - ε"),
    ("large", "robot, gains, 2)", 'robot, gains, "0.02")'),
]


@pytest.mark.parametrize(("claim", "wrong", "right"), REPAIRS, ids=[row[0] for row in REPAIRS])
def test_a_repaired_claim_is_proved(tmp_path, claim, wrong, right):
    source = MUST_FAIL.read_text(encoding="utf-8")
    repaired = tmp_path / "repaired.py"
    text = source.replace(wrong, right)
    assert text != source
    repaired.write_text(text, encoding="utf-8")
    assert run_proof(repaired, ms=(1,), only=(claim,)).claims[0].verdict is Verdict.PROVED
