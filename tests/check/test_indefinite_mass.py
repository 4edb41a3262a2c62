"""An arm whose M(q) is not positive definite at some postures: nothing says that it is stable."""

import pytest

from lyapcheck.check.kinds.inertia import PostureWitness
from lyapcheck.check.verify import verify
from lyapcheck.claims import decreasing, run_proof
from lyapcheck.claims.procedures import propose
from lyapcheck.control.gains import paper_gain_file, read_gain_file
from lyapcheck.robots import load
from tests.helpers.command import invoke

pytestmark = pytest.mark.usefixtures("in_this_process")

GAINS = paper_gain_file("table2_shoulder_elbow")
ARM = """
title = "M11 = 1 + 1.05 cos q2, which is below 0 where q2 is near π"
source = "no arm has it"

[numbers]
inertia = {{ value = 1, unit = "kg·m²" }}
swing = {{ value = {swing}, unit = "kg·m²" }}

[model]
M11 = [[1, "inertia"], [1, "swing c2"]]
M12 = []
M22 = [[1, "inertia"]]
potential = []

[[joints]]
name = "shoulder"
viscous = 2
torque_limit = 150

[[joints]]
name = "elbow"
viscous = 2
torque_limit = 15
"""


def arm(folder, swing="1.05"):
    """The file of the arm."""
    path = folder / f"swing{swing}.toml"
    path.write_text(ARM.format(swing=swing), encoding="utf-8")
    return path


def test_a_posture_refutes_that_v_decreases_as_there_m_is_not_positive_definite(tmp_path):
    gains = read_gain_file(GAINS).gains[0]
    statement = decreasing(load(str(arm(tmp_path))), gains, "0.001")
    decision = propose(statement)
    assert decision.verdict.value == "refuted"
    assert isinstance(decision.proof, PostureWitness)
    assert verify(statement, decision.proof).verdict == "refuted"


@pytest.mark.slow
def test_no_claim_says_that_the_arm_is_stable(tmp_path):
    claims = ("arm.M", "arm.C", "arm.theta", "arm.stable", "arm.states", "arm.ranges", "arms.all")
    result = run_proof("scalar.py", ms=(1,), robot=str(arm(tmp_path)), gains=GAINS, only=claims)
    outcome = {row.id: row.verdict.value for row in result.claims}
    assert outcome == {
        "arm.M": "refuted",
        "arm.C": "proved",
        "arm.theta": "proved",
        "arm.stable": "undecided",
        "arm.states": "refuted",
        "arm.ranges": "refuted",
        "arms.all": "proved",
    }
    said = [row for row in result.claims if row.verdict.value == "proved" and "stable" in row.statement]
    assert [row.id for row in said] == ["arms.all"], "for every arm with Property 2.1, which this one lacks"
    assert "for every n, every arm with viscous friction" in said[0].stated.text()
    assert any("0 < mu ≤ λmin(M(q))" in line for line in said[0].stated.granted)


@pytest.mark.slow
def test_the_search_for_eps0_writes_no_certificate_for_it(tmp_path):
    folder = tmp_path / "certificates"
    options = ["--m", "1", "--starts", "4", "--max-boxes", "100", "--certificates", str(folder)]
    run = invoke("epsilon", str(GAINS), "--robot", str(arm(tmp_path)), *options)
    assert run.exit_code != 2, run.output
    assert [path.name for path in folder.iterdir()] == ["tau_m1.falsified.json"]
    assert "asymptotically stable" not in run.output
