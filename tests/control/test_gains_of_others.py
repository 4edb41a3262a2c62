"""Gains as people have them: by joint, in other words and formats, without damping, brought over by init."""

# ruff: noqa: E501 (tables of texts)

from __future__ import annotations

import json
from fractions import Fraction
from pathlib import Path

import pytest

from lyapcheck.answers.gate import gate
from lyapcheck.cli.main import run
from lyapcheck.control.gains import read_gain_file
from lyapcheck.errors import InputError
from tests.helpers.command import invoke
from tests.helpers.urdf_texts import TWO

HEAD = 'robot = "two.urdf"\n[[gains]]\nname = "a"\n'
LIMITED = TWO.replace(
    '<dynamics damping="0.25"/>', '<dynamics damping="0.25"/><limit effort="9" velocity="1"/>'
)
YAML = """\
arm_controller:
  ros__parameters:
    joints: [shoulder, elbow]
    gains:
      shoulder: {p: 60.0, i: 0.0, d: 3.0}
      elbow: {p: 40.0, i: 0.0, d: 2.0}
"""


@pytest.fixture
def place(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    (tmp_path / "two.urdf").write_text(LIMITED, encoding="utf-8")
    monkeypatch.chdir(tmp_path)
    return tmp_path


def told(place: Path, text: str) -> str:
    (place / "g.toml").write_text(text, encoding="utf-8")
    with pytest.raises(InputError) as caught:
        read_gain_file(place / "g.toml")
    return str(caught.value)


def test_gains_by_joint_are_the_list_in_the_order_of_the_arm(place: Path) -> None:
    (place / "list.toml").write_text(HEAD + "m = 1\nkp = [2, 3.50]\nkv = [0.1, 0.2]\n")
    by_joint = "kp = { elbow = 3.50, shoulder = 2 }\nkv = { elbow = 0.2, shoulder = 0.1 }\n"
    (place / "table.toml").write_text(HEAD + "m = 1\n" + by_joint)
    assert read_gain_file(place / "table.toml").gains == read_gain_file(place / "list.toml").gains
    assert gate(place / "table.toml")[0].checks == gate(place / "list.toml")[0].checks


@pytest.mark.parametrize(
    ("lines", "message"),
    [
        (
            "m = 2.0\nkp = [1, 1]\nkv = [1, 1]",
            "gains[1].m = 2.0: must be a whole number from 1 to 10000; write m = 2",
        ),
        (
            "m = 1\nkp = [0,2, 0,2]\nkv = [1, 1]",
            "kp = [0, 2, 0, 2]: has 4 whole numbers, some of them 0, and no gain is 0; write 0.2",
        ),
        (
            "m = 1\nkp = [1, 1]\nkd = [1, 1]",
            "kd = [1, 1]: is not a key here: the gain of the speed is kv; write kv",
        ),
        (
            "m = 1\nkp = [1, 1]\nkv = [1, 1]\nki = [1, 1]",
            "ki = [1, 1]: is an integral, and outside of the theory",
        ),
        (
            "m = 1\nkp = [[1, 0], [0, 1]]\nkv = [1, 1]",
            "is a full matrix, and the gains of the theory are diagonal",
        ),
        (
            "m = 1\nkp = [0, 2]\nkv = [1, 1]",
            "kp = [0, 2]: has 2 whole numbers, some of them 0, and no gain is 0; write 0.2",
        ),
        ("m = 1\nkp = { shoulder = 1 }\nkv = [1, 1]", "kp = { shoulder = 1 }: has no gain for elbow"),
        (
            "m = 1\nkp = { shoulder = 1, elbo = 1 }\nkv = [1, 1]",
            "kp.elbo = 1: is no joint of this arm; did you mean elbow?",
        ),
        ("m = 1\nkp = { shoulder = -1, elbow = 1 }\nkv = [1, 1]", "kp.shoulder = -1: must be positive"),
        ("m = 1\nkp = [1.0, 1]\nkv = [1, 0.0]", "kv[2] = 0.0: must be positive in a; correct"),
    ],
)
def test_what_is_written_otherwise_is_told_with_its_repair(place: Path, lines: str, message: str) -> None:
    assert message in told(place, f"{HEAD}{lines}\n")


def test_gains_by_joint_need_an_arm(place: Path) -> None:
    text = HEAD.partition("\n")[2] + "m = 1\nkp = { a = 1 }\nkv = { a = 1 }\n"
    assert "is by joint, and the file names no arm" in told(place, text)
    (place / "g.toml").write_text(text.replace("{ a", "{ shoulder"))
    assert read_gain_file(place / "g.toml", "two.urdf#tip=upper").gains[0].kp == (1,)


@pytest.mark.parametrize(
    ("name", "text", "kind"),
    [
        ("a.yaml", YAML, "YAML"),
        ("gains", YAML, "YAML"),
        ("a.csv", "joint,kp,kd\nshoulder,60,3\n", "CSV"),
        ("gains", "joint;kp;kd\nshoulder;60;3\n", "CSV"),
        ("gains", '{"shoulder": {"p": 60}}\n', "JSON"),
        ("a.m", "Kp = diag([60 40]);\n", "MATLAB"),
        ("gains", "% gains\nKp = [60 40]\n", "MATLAB"),
    ],
)
def test_another_format_is_named(place: Path, name: str, text: str, kind: str) -> None:
    (place / name).write_text(text)
    with pytest.raises(InputError, match=f"is {kind}, not TOML; bring its gains over: lyapcheck init"):
        read_gain_file(place / name)


@pytest.mark.parametrize("m", ["m = 1", 'family = "linear"'])
def test_no_damping_is_a_verdict_of_the_gate_alone(place: Path, m: str) -> None:
    (place / "g.toml").write_text(f"{HEAD}{m}\nkp = [2, 1]\nkv = [0.1, 0]\n")
    result = invoke("gate", "g.toml", "--format", "json")
    assert result.exit_code == 1
    (damped,) = [c for c in json.loads(result.stdout)["results"][0]["checks"] if c["id"] == "damped"]
    assert (damped["joint"], damped["verdict"]) == ("elbow", "rejected")
    assert "must be positive" in str(invoke("bounds", "g.toml").exception)


# --- init --from -------------------------------------------------------------------------------------------

FORMS = {
    "ros2_control": YAML,
    "a controller a joint": "a:\n  joint: shoulder\n  pid: {p: 60.0, d: 3.0}\nb:\n  joint: elbow\n  pid: {p: 40.0, d: 2.0}\n",
    "pid_gains of Gazebo": "gazebo_ros_control:\n  pid_gains:\n    shoulder: {p: 60.0, i: 0, d: 3.0}\n    elbow: {p: 40.0, d: 2.0}\n",
    "lists": "joints: [elbow, shoulder]\nkp: [40.0, 60.0]\nkd: [2.0, 3.0]\n",
    "JSON": '{"shoulder": {"p": 60.0, "d": 3.0}, "elbow": {"p": 40.0, "d": 2.0}}',
    "CSV": "joint,kp,kd\nelbow,40.0,2.0\nshoulder,60.0,3.0\n",
    "CSV with units": '"Joint";"Kp [N m/rad]";"Kd (N m s/rad)"\nelbow;40.0;2.0\nshoulder;60.0;3.0\n',
}


@pytest.mark.parametrize("form", FORMS)
def test_gains_are_brought_over_by_joint_and_pass_the_gate(place: Path, form: str) -> None:
    (place / "pid.txt").write_text(FORMS[form])
    assert run(["init", "new", "--from", "pid.txt", "--arm", "two.urdf"]) == 0
    (gains,) = read_gain_file(place / "new" / "gains.toml").gains
    for kp, kv, (p, d) in zip(gains.kp, gains.kv, ((60, 3), (40, 2)), strict=True):
        assert 0 < kp <= p
        assert abs(kp / kv - Fraction(p, d)) < Fraction(1, 1000)
    assert gains.condition == ("10p", "lasalle")
    assert "adds g(q)" in (place / "new" / "gains.toml").read_text().replace("has to add", "adds")
    assert [one.verdict for one in gate(place / "new" / "gains.toml")] == ["accepted"]


@pytest.mark.parametrize(
    ("text", "message"),
    [
        (
            YAML.replace("i: 0.0, d: 3.0", "i: 0.5, d: 3.0"),
            "pid.yaml:5: shoulder: i = 0.5: is an integral, and outside",
        ),
        (
            YAML.replace("p: 60.0", "p: x"),
            "pid.yaml:5: shoulder: p = x: must be a number that is not negative",
        ),
        (
            YAML.replace("      elbow", "      elbo"),
            "joint elbow: has no p gain in this file; did you mean elbo?",
        ),
        (
            YAML + YAML.replace("arm", "other").replace("60", "50"),
            "has several sets of gains, in lines 5, 11",
        ),
        ("kp: [[1, 0], [0, 1]]\njoints: [shoulder, elbow]\n", "is a full matrix"),
        ("kp: [1, 2, 3]\n", "is a list of 3 gains for 0 joints"),
        ("shoulder,60,3\nelbow,40,2\n", "header = shoulder,60,3: has no header that names the columns"),
        ("joint;kp;kd\nshoulder;60,5;3\nelbow;40;2\n", "p = 60,5: must be a number"),
        ("# joint,kp,kd\n", "pid.csv:1: header: has no header"),
        ("joint,kp [N·m/deg],kd\nshoulder,1,1\nelbow,1,1\n", "kp = N·m/deg: is not the unit of gains here"),
        ("kp: [60, 40]\nkd: 3\nki: 2\n", "shoulder: i = 2: is an integral"),
        ("MATLAB 5.0 MAT-file, Platform: GLNXA64\n", "is MATLAB"),
        ("a: [1\n", "is no YAML"),
        ("a: &a [*a]\n", "has no p gain in this file"),
    ],
)
def test_gains_that_cannot_be_brought_over(place: Path, text: str, message: str) -> None:
    name = "pid.yaml" if ":" in text.partition("\n")[0] else "pid.csv" if text[0] == "#" else "pid"
    (place / name).write_text(text)
    with pytest.raises(InputError) as caught:
        run(["init", "new", "--from", name, "--arm", "two.urdf"])
    assert message in str(caught.value)


def test_init_needs_both(place: Path) -> None:
    with pytest.raises(InputError, match="--arm: is missing"):
        run(["init", "--from", "two.urdf"])
    assert not (place / "gains.toml").exists()
