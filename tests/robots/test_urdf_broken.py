"""URDF files that are wrong: every one is told with its place, its rule and a repair, and nothing hangs."""

from __future__ import annotations

import contextlib
from pathlib import Path

import pytest
from hypothesis import given
from hypothesis import strategies as st

from lyapcheck import robots
from lyapcheck.errors import InputError
from tests.helpers.letters import letters
from tests.helpers.urdf_texts import ARMS, TWO
from tests.robots.test_arm_files import CHAIN, PRINTED

DOCTYPE = '<!DOCTYPE robot [<!ENTITY a "aaaaaaaaaa"><!ENTITY b "&a;&a;&a;&a;&a;">]>\n<robot'
OUTSIDE = '<!DOCTYPE robot [<!ENTITY f SYSTEM "file:///etc/passwd">]>\n<robot'
MASS = '<mass value="1.5"/>'
INERTIA = '<inertia ixx="0.01" ixy="0" ixz="0" iyy="0.02" iyz="0" izz="0.02"/>'
LIMIT = '<limit lower="-1" upper="1" effort="20" velocity="2"/>'
DYNAMICS = '<dynamics damping="0.5" friction="0.1"/>'
ELBOW = '<joint name="elbow" type="continuous">'
AXIS = '<axis xyz="0 1 0"/>'

# What to replace, by what, and what the message must say.
BROKEN = [
    # XML
    ("</robot>", "", "arm.urdf:45: file: is not XML"),
    ('<link name="base"/>', '<link name="base">', "is not XML: mismatched tag"),
    ('<link name="base"/>', "<link name=base/>", "arm.urdf:3: file: is not XML"),
    ('<link name="base"/>', '<link name="base" name="b"/>', "is not XML: duplicate attribute"),
    ("<robot", DOCTYPE, "arm.urdf:2: file: declares a document type or an entity"),
    ("<robot", OUTSIDE, "declares a document type or an entity"),
    ('<link name="base"/>', "&a;", "is not XML: undefined entity"),
    ("</robot>", "</robot><robot/>", "is not XML: junk after document element"),
    ('<link name="base"/>', "<a>" * 45 + "</a>" * 45, "is nested more than 40 deep"),
    (
        '<link name="base"/>',
        f'<link name="base" x="{"y" * 10_001}"/>',
        "attribute of more than 10000 characters",
    ),
    ('<link name="base"/>', "<a/>" * 100_001, "has more than 100000 elements"),
    ("<robot name", "<model name", "is not XML"),
    # the robot
    ('<robot name="two">', '<robot name="two"><xacro:include filename="x"/>', "is a xacro file"),
    ('<link name="base"/>', "", "joint shoulder: parent = base: is no link of this file"),
    (
        '<link name="base"/>',
        '<link name="base"/><link name="alone"/>',
        "2 links that hang on no joint: base, alone",
    ),
    # links
    ('<link name="base"/>', "<link/>", "arm.urdf:3: link: name: is missing"),
    ('<link name="base"/>', '<link name="upper"/>', "link name = upper: is used by another link"),
    ('<link name="base"/>', f'<link name="{"b" * 65}"/>', "must be at most 64 printable characters"),
    (MASS, "", "link lower: mass: is missing; add <mass …/>"),
    (MASS, MASS * 2, "link lower: mass: is given more than once"),
    (MASS, "<mass/>", "link lower: mass: value: is missing"),
    (MASS, '<mass value="-1.5"/>', "link lower: mass = -1.5: must not be negative"),
    (MASS, '<mass value="nan"/>', "link lower: mass: value = nan: must be a finite decimal number"),
    (MASS, '<mass value="1e400"/>', "value = 1e400: must be at most 1000000000000 in size"),
    (MASS, '<mass value="1e9999999"/>', "value = 1e9999999: must be a finite decimal number"),
    (MASS, '<mass value="1,5"/>', "value = 1,5: must be a finite decimal number"),
    (MASS, '<mass value="٣"/>', "value = ٣: must be a finite decimal number"),
    (MASS, '<mass value="${m}"/>', "is a xacro file"),
    (MASS, f'<mass value="{"1" * 61}"/>', "must be a finite decimal number"),
    (INERTIA, "", "inertia: is missing"),
    (INERTIA, INERTIA * 2, "inertia: is given more than once"),
    (INERTIA, INERTIA.replace(' izz="0.02"', ""), "inertia: izz: is missing"),
    (INERTIA, INERTIA.replace('ixx="0.01"', 'ixx="-0.01"'), "inertia: must be positive semidefinite"),
    (
        '<origin xyz="0.2 0 0"/>',
        '<origin xyz="0.2 0"/>',
        "link lower: origin: xyz = 0.2 0: must be three numbers",
    ),
    (
        '<origin xyz="0.2 0 0"/>',
        '<origin xyz="0.2 0 x"/>',
        "origin: xyz = x: must be a finite decimal number",
    ),
    ('<origin xyz="0.2 0 0"/>', '<origin xyz=""/>', "origin: xyz: is missing"),
    ('<origin xyz="0.2 0 0"/>', '<origin/><origin xyz="0 0 0"/>', "origin: is given more than once"),
    # joints
    (ELBOW, '<joint type="continuous">', "joint: name: is missing"),
    (ELBOW, '<joint name="elbow">', "joint elbow: type: is missing"),
    (ELBOW, '<joint name="elbow" type="ball">', "joint elbow: type = ball: is no joint type of URDF"),
    (ELBOW, '<joint name="shoulder" type="continuous">', "joint name = shoulder: is used by another joint"),
    ('<child link="lower"/>', "", "joint elbow: child: is missing"),
    ('<child link="lower"/>', "<child/>", "joint elbow: child: link: is missing"),
    (
        '<child link="lower"/>',
        '<child link="lowr"/>',
        "child = lowr: is no link of this file; did you mean lower?",
    ),
    ('<child link="lower"/>', '<child link="upper"/>', "already hangs on joint shoulder: closed chains"),
    (
        '<child link="lower"/>',
        '<child link="base"/>',
        "has joints in a circle: base, upper cannot be reached from lower",
    ),
    ('<parent link="base"/>', '<parent link="tool"/>', "has joints in a circle"),
    (AXIS, '<axis xyz="0 0 0"/>', "axis = 0 0 0: must not be zero"),
    (AXIS, "<axis/>", "joint shoulder: axis: xyz: is missing"),
    (AXIS, AXIS * 2, "axis: is given more than once"),
    (LIMIT, "", "joint shoulder: limit: is missing"),
    (LIMIT, LIMIT * 2, "limit: is given more than once"),
    (LIMIT, '<limit velocity="2"/>', "joint shoulder: limit: effort: is missing"),
    (LIMIT, LIMIT.replace('"20"', '"-20"'), "joint shoulder: effort = -20: must not be negative"),
    (LIMIT, LIMIT.replace('"-1"', '"2"'), "limit = 2 > 1: lower is above upper"),
    (DYNAMICS, DYNAMICS.replace('"0.5"', '"-0.5"'), "joint shoulder: damping = -0.5: must not be negative"),
    (DYNAMICS, DYNAMICS.replace('"0.1"', '"a"'), "dynamics: friction = a: must be a finite decimal number"),
    (
        DYNAMICS,
        DYNAMICS.replace("damping", "dampng"),
        "joint shoulder: dampng: means nothing in URDF; did you",
    ),
    (AXIS, AXIS.replace("axis", "axes"), "joint shoulder: axes: means nothing in URDF; did you mean axis?"),
    (MASS, MASS.replace("mass", "Mass"), "link lower: Mass: means nothing in URDF; did you mean mass?"),
    (DYNAMICS, DYNAMICS * 2, "dynamics: is given more than once"),
]


@pytest.mark.parametrize(("old", "new", "expected"), BROKEN)
def test_a_broken_file_is_told_what_is_wrong(tmp_path: Path, old: str, new: str, expected: str) -> None:
    assert old in TWO
    assert expected in printed(tmp_path, TWO.replace(old, new))


def printed(folder: Path, text: str) -> str:
    file = folder / "arm.urdf"
    file.write_text(text, encoding="utf-8")
    with pytest.raises(InputError) as caught:
        robots.load(file)
    assert all(problem.repair for problem in caught.value.problems)
    return str(caught.value)


def test_all_problems_at_once(tmp_path: Path) -> None:
    text = TWO.replace(MASS, '<mass value="-1.5"/>').replace(LIMIT, "").replace('value="2"', 'value="nan"')
    assert len(printed(tmp_path, text).splitlines()) == 3


@pytest.mark.parametrize(
    ("content", "rule"),
    [
        (b"", "is not XML: no element found"),
        (b"<robot name='\xff'/>", "is not UTF-8 text"),
        (b"<sdf/>", "is SDF, which is not read here; convert it"),
        (b"<COLLADA/>", "is XML with the root <COLLADA>, and no robot"),
        (b"<robot/>", "has no link"),
        (b'<robot><link name="a"/></robot>', "has no revolute joint on this chain"),
        (b" " * 5_000_001, "is larger than 5000000 bytes"),
        (b"<robot name='\x00'/>", "is not XML"),
    ],
)
def test_what_is_no_arm_at_all(tmp_path: Path, content: bytes, rule: str) -> None:
    file = tmp_path / "arm.urdf"
    file.write_bytes(content)
    with pytest.raises(InputError, match=rule):
        robots.load(file)


def test_an_arm_that_nothing_keeps_in_place(tmp_path: Path) -> None:
    """A joint that moves no inertia leaves M singular."""
    light = TWO.replace('value="1.5"', 'value="0"').replace('value="0.25"', 'value="0"')
    light = light.replace('iyy="0.02" iyz="0" izz="0.02"', 'iyy="0" iyz="0" izz="0"').replace("0.001", "0")
    told = printed(tmp_path, light.replace("0.01", "0"))
    assert "has a joint elbow that moves no mass: links of mass 0: lower (line 12), tool (line 19)" in told


def test_more_joints_than_are_understood(tmp_path: Path) -> None:
    inertial = f'<inertial><mass value="1"/>{INERTIA}</inertial>'
    links = "".join(f'<link name="l{i}">{inertial}</link>' for i in range(14))
    joints = "".join(
        f'<joint name="j{i}" type="continuous"><parent link="l{i}"/><child link="l{i + 1}"/></joint>'
        for i in range(13)
    )
    assert "has a chain of 13 joints, more than 12" in printed(tmp_path, f"<robot>{links}{joints}</robot>")


# Fuzzing, guided by Hypothesis -----

SEEDS = {
    "arm.urdf": [TWO, (ARMS / "panda.urdf").read_text()[:3000] + "</robot>"],
    "arm.toml": [CHAIN, PRINTED],
}
WORDS = sorted(
    {word for texts in SEEDS.values() for text in texts for word in text.replace('"', ' " ').split()}
    | {"nan", "-1", "1e99", "&lt;", "<!DOCTYPE a>", "<![CDATA[", "\x00", "é", "]]", "{}", "''''", "<!--"}
    | {
        "9" * 400,
        "1e99999999",
        "1e" + "9" * 50,
        "٣",
        "[" * 200,
        "{ a = " * 60,
        "<a>" * 60,
        "${pi}",
        "c1 " * 30,
    }
    | {'<!ENTITY a "&b;&b;">', "&a;", "</robot>", "/dev/zero", "../../etc/passwd", "1979-05-27", "s12^9"}
)


def survives(file: Path, text: str) -> None:
    """A model or an `InputError`; anything else is an error of lyapcheck."""
    file.write_text(text, encoding="utf-8", newline="")
    with contextlib.suppress(InputError):
        assert isinstance(robots.load(file), robots.RobotModel)


@given(st.sampled_from(sorted(SEEDS)), st.data())
def test_garbled_files_never_end_in_another_error(
    tmp_path_factory: pytest.TempPathFactory, name: str, data: st.DataObject
) -> None:
    text = data.draw(st.sampled_from(SEEDS[name]))
    for _ in range(data.draw(st.integers(1, 4))):
        at = data.draw(st.integers(0, len(text)))
        cut = data.draw(st.integers(0, 12))
        text = text[:at] + data.draw(st.sampled_from(WORDS) | letters(most=3)) + text[at + cut :]
    survives(tmp_path_factory.getbasetemp() / name, text.encode("utf-8", "ignore").decode())


@given(st.sampled_from(sorted(SEEDS)), st.binary(max_size=200))
def test_bytes_never_end_in_another_error(
    tmp_path_factory: pytest.TempPathFactory, name: str, content: bytes
) -> None:
    file = tmp_path_factory.getbasetemp() / name
    file.write_bytes(content)
    with contextlib.suppress(InputError):
        robots.load(file)
