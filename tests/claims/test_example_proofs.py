"""The example proofs: one of another family that is proved, and one that must not be accepted."""

from pathlib import Path

import pytest

from lyapcheck.check.certificate import judge
from lyapcheck.claims import run_proof
from lyapcheck.claims.script import find_script
from lyapcheck.verdicts import Exit
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
