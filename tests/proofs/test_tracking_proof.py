"""The tracking proof: what is proved of it and what it rests on; claims adopted from another script."""

import pytest

from lyapcheck.claims import run_proof
from lyapcheck.errors import InputError
from lyapcheck.verdicts import Verdict

pytestmark = pytest.mark.usefixtures("in_this_process")


@pytest.fixture(scope="module")
def result(in_this_process):
    """For the paper's arm and m = 1, 2, 3."""
    return run_proof("tracking.py", ms=(1, 2, 3))


@pytest.mark.slow
def test_every_step_is_proved_for_the_gains_of_the_paper(result):
    assert {row.verdict for row in result.claims} == {Verdict.PROVED}
    concluded = {(row.id, row.m) for row in result.claims if "uniformly asymptotically" in row.statement}
    assert concluded == {(name, m) for name in ("21", "arm.21") for m in result.ms}


@pytest.mark.slow
def test_the_conclusion_needs_bounds_without_time_on_both_sides(result):
    uses = {row.id: set(row.uses) for row in result.claims}
    assert {"21.below", "21.above", "21.form", "21.loop", "21.small"} <= uses["21"]
    assert "rate.5" not in uses["21.form"], "terms 5 and 9 are those with the desired velocity in them"
    assert "rate.9" not in uses["21.form"]


def test_claims_can_be_adopted_from_another_script(tmp_path):
    """With what they use, under their ids; what the script has already stays, and unknown ids are refused."""
    head = "from lyapcheck.claims import *\nproof = Proof('mine', 'mine')\n"
    own = "proof.add('h.bound', 'mine', Constant(expr(1) <= 2))\n"
    path = tmp_path / "mine.py"
    path.write_text(head + own + "proof.adopt('scalar.py', 'rate.5', section='Theirs')\n", encoding="utf-8")
    rows = {row.id: row for row in run_proof(path, ms=(1,), n=2).claims}
    assert {"rate.5", "rate", "V.smooth", "h.steep"} <= set(rows)
    assert (rows["h.bound"].statement, rows["h.bound"].comment) == ("1 ≤ 2", "mine")
    assert rows["rate.5"].section == "Theirs"
    path.write_text(head + "proof.adopt('scalar.py', 'rate.55')\n", encoding="utf-8")
    with pytest.raises(InputError, match=r"did you mean rate\.5"):
        run_proof(path, ms=(1,), n=2)
