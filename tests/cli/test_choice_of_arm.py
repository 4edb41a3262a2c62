"""``--base``, ``--tip`` and ``--fixed`` of every command that takes an arm, and what is written with them."""

from __future__ import annotations

from pathlib import Path

import pytest

from lyapcheck import load_robot
from lyapcheck.control.gains import read_gain_file
from tests.helpers.command import invoke
from tests.helpers.urdf_texts import TWO

GAINS = 'robot = "two.urdf"\n[[gains]]\nname = "a"\nm = 1\nkp = [2]\nkv = [0.1]\n'


@pytest.fixture(autouse=True)
def _place(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    (tmp_path / "two.urdf").write_text(TWO, encoding="utf-8")
    (tmp_path / "g.toml").write_text(GAINS, encoding="utf-8")
    monkeypatch.chdir(tmp_path)


@pytest.mark.parametrize("choice", [("--tip", "upper"), ("--fixed", "elbow=0.4"), ("--fixed=elbow=0",)])
@pytest.mark.parametrize("command", ["gate", "bounds --time 1", "simulate --time 0.2"])
def test_a_choice_is_of_the_arm_that_the_file_names(command: str, choice: tuple[str, ...]) -> None:
    name, *more = command.split()
    assert "gains for" in str(invoke(name, "g.toml", *more).exception)
    assert invoke(name, "g.toml", *more, *choice).exit_code in (0, 3)


def test_what_tune_and_robot_write_is_that_arm() -> None:
    assert invoke("tune", "two.urdf", "--fixed", "elbow=0.4", "--m", "1", "--out", "new.toml").exit_code == 0
    assert read_gain_file("new.toml").robot == "two.urdf#fixed.elbow=0.4"
    assert invoke("gate", "new.toml").exit_code == 0
    assert invoke("robot", "two.urdf", "--fixed", "elbow=0.4", "--export", "arm.toml").exit_code == 0
    exported, held = load_robot("arm.toml"), load_robot("two.urdf#fixed.elbow=0.4")
    assert (exported.joints, exported.mass, exported.potential) == (held.joints, held.mass, held.potential)
    assert held.potential != load_robot("two.urdf#fixed.elbow=0").potential
