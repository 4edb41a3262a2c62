"""What a newcomer gets: files to begin with, arms to edit, ids to look up, messages that say what to do."""

import sys
from pathlib import Path

import numpy as np
import pytest

from lyapcheck import gate, robots
from lyapcheck.answers.tune.trial import Trials, Wishes, tried
from lyapcheck.cli import main as cli
from lyapcheck.errors import InputError
from lyapcheck.robots import arm_text
from lyapcheck.robots.numeric import NumericModel
from lyapcheck.simulate.task import task_for

ROOT = Path(__file__).parents[2]


def leaves(monkeypatch, *words):
    monkeypatch.setattr(sys, "argv", ["lyapcheck", *words])
    with pytest.raises(SystemExit) as left:
        cli.main()
    return int(left.value.code or 0)


def test_init_starts_files_that_the_gate_takes_and_keeps_what_is_there(monkeypatch, capsys, tmp_path):
    folder = tmp_path / "bench"
    assert leaves(monkeypatch, "init", str(folder)) == 0
    assert leaves(monkeypatch, "gate", str(folder / "gains.toml")) == 0
    (folder / "gains.toml").write_text("mine")
    assert leaves(monkeypatch, "init", str(folder)) == 2
    assert (folder / "gains.toml").read_text() == "mine"
    assert "is there already" in capsys.readouterr().err


def test_the_gains_of_init_are_gains_that_tune_would_recommend(monkeypatch, tmp_path):
    """The gate accepts them by their conditions, and they meet the targets that the file names."""
    assert leaves(monkeypatch, "init", str(tmp_path)) == 0
    (result,) = gate(tmp_path / "gains.toml")
    assert (result.verdict, result.deciding) == ("accepted", ("10p", "scalar"))
    assert "--overshoot 5 --settle 2.5 --rest-error 3" in (tmp_path / "gains.toml").read_text()
    arm, asked = robots.load(tmp_path / "arm.toml"), Wishes(overshoot=5, settle=2.5, rest_error=3)
    motions = tuple(task_for(2, np.radians(goal), None, None, 5.0) for goal in ((45, 45), (-30, 90), (90, 0)))
    trial = tried(result.gains, [arm], Trials(asked, motions), exact=True)
    assert trial.kept
    assert trial.worst <= 1


@pytest.mark.parametrize("name", ["buap3", "pelican2", "ur5", "UR5", str(ROOT / "examples" / "panda.toml")])
def test_an_exported_arm_is_the_arm(name, tmp_path):
    (tmp_path / "mine.toml").write_text(arm_text(name, tmp_path))
    theirs, mine = robots.load(name), robots.load(tmp_path / "mine.toml")
    q = np.random.default_rng(2).uniform(-3, 3, (4, theirs.n))
    np.testing.assert_array_equal(NumericModel(mine).mass(q), NumericModel(theirs).mass(q))
    assert mine.viscous == theirs.viscous


def test_a_urdf_file_is_exported_as_an_arm_file_to_be_completed(tmp_path):
    text = arm_text(str(ROOT / "examples" / "ur5.urdf"), tmp_path)
    assert "# viscous = …" in text
    (tmp_path / "mine.toml").write_text(text.replace("# viscous = …", "viscous = 2"))
    assert {float(b.value) for b in robots.load(tmp_path / "mine.toml").viscous} == {2.0}


def test_an_export_keeps_the_tip(monkeypatch, tmp_path):
    urdf, target = str(ROOT / "examples" / "ur5.urdf"), tmp_path / "mine.toml"
    assert leaves(monkeypatch, "robot", urdf, "--tip", "forearm_link", "--export", str(target)) == 0
    assert 'tip = "forearm_link"' in target.read_text()
    assert robots.load(target).joints == robots.load(urdf, "forearm_link").joints
    assert leaves(monkeypatch, "robot", "buap3", "--tip", "x", "--export", str(tmp_path / "no.toml")) == 2


def test_an_exported_arm_goes_to_standard_output(monkeypatch, capsys):
    assert leaves(monkeypatch, "robot", "buap3", "--export", "-") == 0
    assert capsys.readouterr().out == arm_text("buap3", Path())
    assert not Path("-").exists()


def test_export_says_what_it_wrote_and_does_not_write_over_a_file(monkeypatch, tmp_path, capsys):
    target = tmp_path / "arm.toml"
    assert leaves(monkeypatch, "robot", "buap3", "--export", str(target)) == 0
    said = f"{target}: the arm buap3 as a file to edit\nnext: lyapcheck robot {target}\n"
    assert capsys.readouterr().out == said
    assert target.read_text().startswith('title = "Three-joint')
    assert leaves(monkeypatch, "robot", "buap3", "--export", str(target)) == 2


def test_a_robot_that_is_not_there_names_the_examples():
    with pytest.raises(InputError, match="examples: iiwa14, panda, px100, px150, ur5, xarm6"):
        robots.load("UR6")
