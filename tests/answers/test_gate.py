"""The gate: the verdicts on the paper's gains, the exit codes, and the summary of a job."""

import shutil
import sys
from dataclasses import replace
from fractions import Fraction
from pathlib import Path

import pytest

from lyapcheck.answers.gate import gate
from lyapcheck.check.refusal import Refused
from lyapcheck.cli import main as cli
from lyapcheck.cli.show import show
from lyapcheck.control import limits
from lyapcheck.control.gains import paper_gain_file, read_gain_file
from lyapcheck.control.limits import arm_limits
from lyapcheck.errors import InputError
from lyapcheck.robots import load


def table2(**options):
    outcome = gate(read_gain_file(paper_gain_file("table2")), **options)  # type: ignore[arg-type]
    return {result.name: result for result in outcome}


def command(monkeypatch, *words):
    monkeypatch.setattr(sys, "argv", ["lyapcheck", "gate", *words])
    with pytest.raises(SystemExit) as left:
        cli.main()
    assert isinstance(left.value.code, int)
    return left.value.code


@pytest.fixture
def one(tmp_path):
    """Gains that every condition admits."""
    return gain_file(tmp_path / "one.toml", "robot = 'buap3'")


def gain_file(path, top, kp="[1, 1, 1]", kv="[0.1, 0.1, 0.1]", end=""):
    path.write_text(f"{top}\n[[gains]]\nname = 'a'\nm = 2\nkp = {kp}\nkv = {kv}\n{end}")
    return path


# --- what a row says ---------------------------------------------------------------------------------


def test_a_row_promises_nothing_about_another_value():
    row = next(check for check in table2()["tau_m1"].checks if check.verdict == "accepted")
    assert row.own_promise.says("accepted") == "accepted"
    with pytest.raises(Refused, match="has no directions"):
        _ = replace(row, value=row.value / 2).own_promise


# --- the paper's gains -------------------------------------------------------------------------------


def test_table_2_with_the_true_gamma():
    """(19) lets k_v = 0.233 pass for m = 1, and k_v = 0.223 for neither m = 2 nor m = 3."""
    results = table2()
    assert {name: result.verdict for name, result in results.items()} == {
        "tau_m1": "accepted",
        "tau_m2": "rejected",
        "tau_m3": "rejected",
    }
    for name in ("tau_m2", "tau_m3"):
        assert [(check.id, check.joint) for check in results[name].failures] == [
            ("19", 0),
            ("19", 1),
            ("19", 2),
        ]
    assert results["tau_m1"].failures == ()


def test_the_conditions_that_decide_can_be_chosen():
    """Of (10), (10p) and (19) only the last refuses tau_m2; none at all decides nothing."""
    verdicts = {
        deciding: table2(deciding=deciding)["tau_m2"].verdict
        for deciding in ((), ("10",), ("10p",), ("19",), ("10", "10p"), ("10", "19"))
    }
    assert list(verdicts.values()) == [
        "undecided",
        "accepted",
        "accepted",
        "rejected",
        "accepted",
        "rejected",
    ]


# --- exit codes --------------------------------------------------------------------------------------


def test_the_command_leaves_with_the_exit_code(monkeypatch, capsys, tmp_path, one):
    paper = str(paper_gain_file("table2"))
    undecided = str(gain_file(tmp_path / "u.toml", "robot = 'pelican2'", "[1, 1]", "[0.001, 0.001]"))
    assert command(monkeypatch, str(one)) == 0
    assert command(monkeypatch, paper) == 1
    assert command(monkeypatch, str(one), paper) == 1
    assert command(monkeypatch, paper, "--condition", "10p") == 0
    assert command(monkeypatch, paper, "--condition", "10p", "--condition", "19") == 1
    assert command(monkeypatch, undecided) == command(monkeypatch, str(one), undecided) == 3
    assert command(monkeypatch, undecided, paper) == 1
    assert command(monkeypatch, undecided, "--strict") == 1
    assert command(monkeypatch, undecided, "--strict", "--condition=19") == 0
    assert capsys.readouterr().err == ""
    assert command(monkeypatch, str(one), "--format", "yaml") == 2
    assert command(monkeypatch, str(one), "--condition", "20") == 2
    assert command(monkeypatch) == 2


# --- what it takes -----------------------------------------------------------------------------------


ARMS = Path(limits.__file__).parents[1] / "robots" / "arms"


def test_an_arm_is_read_once_for_many_files(monkeypatch, tmp_path, capsys):
    """And only for one call: an arm file that has changed since is read again."""
    arm = tmp_path / "arm.toml"
    shutil.copy(ARMS / "pendulum1.toml", arm)
    text = 'robot = "arm.toml"\n[[gains]]\nname = "a"\nm = 1\nkp = [0.1]\nkv = [0.05]\n'
    files = [tmp_path / f"g{i}.toml" for i in range(3)]
    for file in files:
        file.write_text(text)
    reads = []
    monkeypatch.setattr(limits, "arm_limits", lambda name: (reads.append(name), arm_limits(name))[1])
    monkeypatch.setattr(sys, "argv", ["lyapcheck", "gate", *map(str, files)])

    def code():
        with pytest.raises(SystemExit) as left:
            cli.main()
        return left.value.code

    assert code() == 0
    assert reads == [str(arm)]
    arm.write_text(arm.read_text().replace("low = 0.1", "low = 0.01"))
    assert code() == 1


# --- the summary of a job ----------------------------------------------------------------------------


def test_the_summary_of_a_job_is_added_to(monkeypatch, tmp_path):
    path = tmp_path / "summary.md"
    path.write_text("before\n")
    monkeypatch.setenv("GITHUB_STEP_SUMMARY", str(path))
    answer = gate(read_gain_file(paper_gain_file()))
    show(answer, "github")
    text = path.read_text()
    assert text.startswith("before\n# ✗ 2 break (19), stability proved otherwise; 1 accepted")
    assert "## \\! tau_m1" in text
    show(answer, "text")
    assert path.read_text() == text
    monkeypatch.setenv("GITHUB_STEP_SUMMARY", str(tmp_path / "none" / "summary.md"))
    with pytest.raises(InputError, match="GITHUB_STEP_SUMMARY"):
        show(answer, "github")


@pytest.mark.slow
def test_a_summary_of_many_sets_keeps_to_the_size_that_is_shown(monkeypatch, tmp_path):
    sets = (
        f'[[gains]]\nname = "s{i}"\nm = 1\nkp = [1, 1, 1]\nkv = [{0.1 if i % 2 else 0.3}, 0.1, 0.1]\n'
        for i in range(3000)
    )
    (tmp_path / "g.toml").write_text('robot = "buap3"\n' + "".join(sets))
    monkeypatch.setenv("GITHUB_STEP_SUMMARY", str(tmp_path / "summary.md"))
    show(gate(read_gain_file(tmp_path / "g.toml")), "github")
    text = (tmp_path / "summary.md").read_text(encoding="utf-8")
    assert len(text.encode()) < 2**20
    assert text.startswith("# ✗ 1350 rejected; 150 break (19), stability proved otherwise; 1500 accepted; ")
    assert "## ✓" not in text


@pytest.mark.parametrize(
    ("limit", "said"), [(150, "the joint rests wherever"), (10, "the joint may rest wherever")]
)
def test_dry_friction_holds_a_joint_whose_motor_carries_gravity(limit, said, tmp_path):
    """Of gravity up to 40 N·m a motor of 10 N·m and a friction of 7 N·m leave a part."""
    arm = load("reyes-kelly2")
    shoulder, elbow = arm.torque_limit
    weak = replace(arm, torque_limit=(replace(shoulder, value=Fraction(limit)), elbow))
    text = '[[gains]]\nname = "a"\nm = 1\nkp = [5, 20]\nkv = [0.1, 0.1]\ncondition = ["lasalle"]\n'
    (tmp_path / "g.toml").write_text(text)
    assert said in " ".join(str(gate(tmp_path / "g.toml", weak)).split())
