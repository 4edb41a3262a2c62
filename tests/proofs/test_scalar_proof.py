"""The scalar proof: proved for the paper's arm and gains, against numbers and other derivations."""

from dataclasses import replace
from fractions import Fraction
from pathlib import Path

import pytest

from lyapcheck.claims import run_proof
from lyapcheck.claims.script import find_script
from lyapcheck.robots import load
from lyapcheck.verdicts import Exit, Verdict
from tests.helpers.small_proofs import small_proof

pytestmark = pytest.mark.usefixtures("in_this_process")

SCRIPT = Path(find_script("scalar.py"))


@pytest.fixture(scope="module", params=["small", pytest.param("paper", marks=pytest.mark.slow)])
def result(request, tmp_path_factory):
    """For two joints and m = 1, or for the paper's arm and m = 1, 2, 3."""
    if request.param == "small":
        return small_proof(tmp_path_factory, "scalar.py")
    return run_proof("scalar.py", ms=(1, 2, 3))


def verdicts(only=(), ms=(2,), **options):
    """The verdict of each claim, by id."""
    rows = run_proof("scalar.py", ms=ms, only=only, **options).claims
    return {row.id: row.verdict.value for row in rows}


def test_every_step_is_proved_for_the_gains_of_the_paper(result):
    assert {row.verdict for row in result.claims} == {Verdict.PROVED}
    assert result.exit_code is Exit.PROVED
    concluding = [row for row in result.claims if "asymptotically" in row.statement]
    kinds = {(row.id, type(row.stated).__name__) for row in concluding}
    assert kinds == {
        ("arms.stable", "Stable"),
        ("arms.all", "Stable"),
        ("arm.stable", "StableArm"),
        ("arm.states", "Decreasing"),
        ("arm.ranges", "Decreasing"),
    }
    assert {(row.id, row.m) for row in concluding} == {(name, m) for name, _ in kinds for m in result.ms}


def test_every_conclusion_rests_on_the_chain_below_it(result):
    uses = {row.id: set(row.uses) for row in result.claims}
    assert {"rate.form", "arm.theta", "arm.M", "arm.C", "h.bounds", "V.positive"} <= uses["arm.stable"]
    assert uses["rate.form"] == {f"rate.{k}" for k in range(1, 12)}


# ε₀ and arms ------------------------------------------------------------------------------------------------


@pytest.mark.slow
def test_another_arm_with_gains_of_its_own():
    gains = SCRIPT.parent / "table2_shoulder_elbow.toml"
    assert set(verdicts(robot="reyes-kelly2", gains=gains).values()) == {"proved"}


@pytest.mark.slow
def test_without_friction_nothing_is_concluded_about_the_arm():
    model = load("buap3")
    number = replace(model.viscous[0], value=Fraction(0), low=None, high=None)
    outcome = verdicts(robot=replace(model, viscous=(number, *model.viscous[1:])))
    assert outcome["arm.M"] == outcome["arm.C"] == "proved"
    assert outcome["arm.stable"] == outcome["arm.theta"] == outcome["arm.states"] == "undecided"
    assert outcome["arms.all"] == "proved"


@pytest.mark.slow
def test_gains_for_another_number_of_joints_leave_the_arm_open():
    outcome = verdicts(robot="pendulum1")
    assert outcome["arm.stable"] == "undecided"
    assert outcome["arms.stable"] == outcome["arm.M"] == "proved"


@pytest.mark.slow
def test_large_members_and_many_joints_for_every_arm():
    outcome = verdicts(("arms.stable", "arms.all"), ms=(12,), n=4)
    assert outcome == {"arms.stable": "proved", "arms.all": "proved"}
