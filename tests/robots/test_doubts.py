"""Numbers that look like a template or another unit are told; no verdict rests on it."""

from __future__ import annotations

from pathlib import Path

import pytest

from lyapcheck import robots
from lyapcheck.answers.gate import gate
from lyapcheck.cli.main import run
from tests.helpers.urdf_texts import TWO

SAME = TWO.replace('damping="0.5" friction="0.1"', 'damping="0.25"').replace(
    '<dynamics damping="0.25"/>\n  </joint>\n  <joint name="flange"',
    '<dynamics damping="0.25"/><limit effort="20" velocity="1"/>\n  </joint>\n  <joint name="flange"',
)
ARM = 'title = "t"\nurdf = "two.urdf"\n'


@pytest.mark.parametrize(
    ("old", "new", "words"),
    [
        ("", "", "Viscous friction and torque limit are the same for every joint, as in templates"),
        (
            'damping="0.25"',
            'damping="0.0"',
            "Viscous friction is 0 for every joint, as files say that do not know it",
        ),
        (
            'mass value="2"',
            'mass value="2100"',
            "What shoulder moves has a mass of 2100 kg: is that in grams?",
        ),
        (
            'xyz="0.3 0 0"',
            'xyz="300 0 0"',
            "elbow or its body is 300 m away from the joint before: is that in mm?",
        ),
        ('izz="0.02"', 'izz="2000"', "The inertia behind shoulder is that of a body of"),
        ('izz="0.02"', 'izz="2"', "No body has the inertia behind shoulder: one principal moment exceeds"),
        ('rpy="0 0 0"', 'rpy="0 90 0"', "is above a full turn: is it in degrees?"),
    ],
)
def test_what_is_doubted(tmp_path: Path, old: str, new: str, words: str) -> None:
    (tmp_path / "two.urdf").write_text(SAME.replace(old, new))
    (tmp_path / "sound.urdf").write_text(TWO)
    assert words in "".join(robots.load(tmp_path / "two.urdf").assumptions)
    assert robots.load(tmp_path / "sound.urdf").doubts == ()


@pytest.mark.parametrize(
    ("gravity", "words"), [("[0, 0, 9.81]", "Gravity points upwards"), ("[0, 0, -981]", "that of no place")]
)
def test_gravity_is_doubted(tmp_path: Path, gravity: str, words: str) -> None:
    (tmp_path / "two.urdf").write_text(TWO)
    (tmp_path / "arm.toml").write_text(f"{ARM}gravity = {gravity}\n")
    assert words in "".join(robots.load(tmp_path / "arm.toml").doubts)


def test_doubts_stand_in_the_notes_of_the_gate_and_change_no_verdict(tmp_path: Path) -> None:
    gains = 'robot = "two.urdf"\n[[gains]]\nname = "a"\nm = 1\nkp = [0.2, 0.1]\nkv = [0.001, 0.001]\n'
    (tmp_path / "g.toml").write_text(gains)
    verdicts = []
    for text in (SAME, SAME.replace('damping="0.25"', 'damping="0.250001"', 1)):
        (tmp_path / "two.urdf").write_text(text)
        answer = gate(tmp_path / "g.toml")
        verdicts.append((answer[0].verdict, "as in templates" in " ".join(str(answer).split())))
    assert verdicts == [("accepted", True), ("accepted", False)]


@pytest.mark.parametrize(("target", "told"), [("0.78,0.78", True), ("45,45", False), ("400,0", True)])
def test_a_target_in_radians_is_told(
    tmp_path: Path, target: str, told: bool, capsys: pytest.CaptureFixture[str]
) -> None:
    (tmp_path / "two.urdf").write_text(TWO)
    (tmp_path / "g.toml").write_text(
        'robot = "two.urdf"\n[[gains]]\nname = "a"\nm = 1\nkp = [2, 1]\nkv = [1, 1]\n'
    )
    run(["bounds", str(tmp_path / "g.toml"), "--target", target, "--time", "1"])
    assert ("--target is in degrees" in capsys.readouterr().err) == told
