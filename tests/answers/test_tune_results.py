"""What a user sees of tuned gains: every complaint at once, shares in percent, notebooks, other arms."""

from __future__ import annotations

import subprocess
import sys
from dataclasses import replace
from decimal import Decimal
from fractions import Fraction
from pathlib import Path

import numpy as np
import pytest

from lyapcheck.answers.gate import gate
from lyapcheck.answers.tune.targets import Targets
from lyapcheck.answers.tune.tuning import tune
from lyapcheck.cli.commands.tune import FORMATS
from lyapcheck.control.gains import paper_gain_file, read_gain_file
from lyapcheck.output.digits import at_least
from lyapcheck.robots import load
from lyapcheck.simulate.closed_loop import simulate
from lyapcheck.simulate.task import Task
from tests.helpers.command import invoke
from tests.helpers.shares import one_in

UR5 = str(Path(__file__).parents[2] / "examples" / "ur5.urdf")
TABLE2 = replace(read_gain_file(paper_gain_file("table2")), path="Table 2")


def run(*arguments):
    return invoke("tune", *arguments)


def test_every_bad_option_is_named_in_one_go(tmp_path):
    bad = {
        "--m": "0,2.5",
        "--digits": "77",
        "--peak-share": "3",
        "--kv-share": "a,b",
        "--kv-min": "0",
        "--damping": ",",
        "--torque": "1,2",
        "--gravity": "-1,0,0",
        "--viscous-min": "x",
        "--compare": str(tmp_path / "none.toml"),
        "--out": str(tmp_path / "no" / "gains.toml"),
    }
    problems = run("buap3", *(f"{option}={value}" for option, value in bad.items())).exception.problems
    named = [problem.key for problem in problems]
    assert {*bad} - {"--compare"} == {key for key in named if key.startswith("--")}
    assert named.count("--m") == 2
    assert named.count("--kv-share") == 2
    assert any("none.toml" in problem.file for problem in problems)
    assert all(problem.rule and problem.repair for problem in problems)


def test_an_unknown_arm_does_not_hide_the_other_mistakes():
    problems = run("nowhere", "--torque", "1,a", "--viscous-min", "0").exception.problems
    assert sorted(problem.key for problem in problems) == ["--torque", "--viscous-min", "robot"]


@pytest.mark.parametrize(("m", "theirs"), [(1, (28, 60, 5)), (2, (27, 50, 5)), (3, (25, 50, 5))])
def test_the_share_left_on_the_table_is_that_of_the_largest_gain(m, theirs):
    (item,) = tune("buap3", [m], against=TABLE2).sets
    for joint, compared, kp in zip(item.joints, item.comparison.joints, theirs, strict=True):
        share = 1 - Fraction(kp) / joint.kp
        assert compared.kp_left_share <= share < compared.kp_left_share + Fraction(1, 10**6)
        assert f" {at_least(100 * compared.kp_left_share)} %" in str(tune("buap3", [m], against=TABLE2))


@pytest.mark.parametrize(
    ("arguments", "n"),
    one_in(
        4,
        [
            (("reyes-kelly2",), 2),
            (("buap3",), 3),
            ((UR5, "--viscous-min", "6"), 6),
            (
                (UR5, "--viscous-min", "6", "--torque", "150,150,150,28,28,28", "--gravity", "0,60,25,2,1,0"),
                6,
            ),
        ],
    ),
)
def test_twenty_members_of_any_arm_are_tuned_and_accepted(arguments, n, tmp_path):
    out = tmp_path / "gains.toml"
    assert run(*arguments, "--m", "1:20", "--out", str(out)).exit_code == 0
    results = gate(read_gain_file(out))
    assert [result.m for result in results] == [*range(1, 21)]
    assert {result.verdict for result in results} == {"accepted"}
    assert {len(result.gains.kp) for result in results} == {n}


def test_a_urdf_without_friction_says_what_to_measure():
    result = run(UR5)
    assert result.exit_code == 2
    assert "give --viscous-min" in result.stdout


@pytest.mark.slow
def test_what_m_does_is_shown_in_runs():
    task = Task((0.7, 0.7), (0.0, 0.0), (0.0, 0.0), 5.0)
    tuning = tune("reyes-kelly2", [1, 3], task=task)
    first, last = tuning.effects
    for one, item in zip((first, last), tuning.sets, strict=True):
        run = simulate(item.gains, load("reyes-kelly2"), task.q_d)
        assert pytest.approx(run.L2) == one.L2
        assert one.speed == pytest.approx(np.max(np.abs(run.w)))
        assert one.share == pytest.approx(max(run.peak_torque / [150, 15]))
    assert last.L2 > first.L2
    assert last.rest > first.rest
    said = " ".join(str(tuning).split())
    assert f"L2 goes from {first.L2:.1f}° to {last.L2:.1f}°" in said
    assert tuning.data()["effects"][0]["m"] == 1


@pytest.mark.parametrize("form", FORMATS)
def test_every_format_holds_the_gains(form):
    assert "63.112" in run("buap3", "--m", "1", "--viscous-min", "0.406", "--format", form).stdout


def test_the_first_line_says_whether_there_are_gains():
    damped = tune("buap3", [1], Targets.of(damping="0.11"))
    assert str(damped).startswith("✓ buap3: the largest gains within (10p) and (19)\n")
    assert str(tune("buap3", [1])).startswith("! buap3: the largest gains within (10p) and (19); estimated")
    assert str(tune("pelican2", [1, 3])).startswith("? pelican2: its limits are not known")
    assert "for m = 1, 3\n" in str(tune("pelican2", [1, 3]))
    refused = tune("buap3", [2], Targets.of(kv_min=100)).document()
    assert refused.title == "✗ buap3: no gains within (10p) and (19) for m = 2"
    assert "lower --kv-min" in refused.blocks[1].blocks[0].items[0]


def test_a_record_is_a_joint_beside_what_it_is_compared_with():
    first, *others = tune("buap3", [1, 2], against=TABLE2).records()
    assert (first["name"], first["joint"], first["kp"]) == ("tau_m1", "base", "28.633")
    assert (first["compared"]["kp"], first["compared"]["broken"]) == ("28", "")
    assert [row["compared"]["broken"] for row in others[2:]] == ["19"] * 3
    (missing,) = tune("pelican2", [2]).records()
    assert missing["status"] == "undecided"
    assert "give --torque" in missing["reasons"]


def test_targets_are_read_as_they_are_written():
    several = Targets.of(peak_share=["0.8", Decimal("0.9"), 1], kv_min=Fraction(1, 7))
    assert several.peak_share == (Fraction(4, 5), Fraction(9, 10), Fraction(1))
    assert several.kv_min == (Fraction(1, 7),)
    assert several.kv_share is None
    assert Targets.of() == Targets()


@pytest.mark.parametrize("share", [0.8, [0.8], [None]])
def test_targets_that_are_not_exact_are_refused(share):
    with pytest.raises(TypeError, match="is not exact"):
        Targets.of(peak_share=share)


@pytest.mark.slow
def test_the_public_names_are_the_functions_themselves():
    code = (
        "import lyapcheck\n"
        "assert lyapcheck.tune_gains('pendulum1', [2]).sets[0].gains is not None\n"
        "assert lyapcheck.build_table([2]).rows[0].m == 2\n"
        "import lyapcheck.answers.tune\n"
        "assert callable(lyapcheck.tune_gains)"
    )
    assert subprocess.run([sys.executable, "-c", code], check=False).returncode == 0
