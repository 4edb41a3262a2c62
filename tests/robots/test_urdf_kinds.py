"""URDF files as people have them: every word read, told or refused; encodings; which chain is the arm."""

# ruff: noqa: E501 (tables of texts)

from __future__ import annotations

import re
from collections.abc import Iterator
from fractions import Fraction
from pathlib import Path

import numpy as np
import pytest

from lyapcheck import robots
from lyapcheck.errors import InputError
from lyapcheck.robots.choice import Choice, split
from lyapcheck.robots.numeric import NumericModel
from tests.helpers.shares import one_in
from tests.helpers.urdf_texts import ARMS, TWO

UPPER = '<origin xyz="0.1 0 0" rpy="0 0 0"/>'
PLACE = '<origin xyz="0.3 0 0"/>'
MASS = '<mass value="2"/>'
INERTIA = '<inertia ixx="0.01" ixy="0" ixz="0" iyy="0.02" iyz="0" izz="0.02"/>'
LIMIT = '<limit lower="-1" upper="1" effort="20" velocity="2"/>'
DYNAMICS = '<dynamics damping="0.25"/>'
AXIS = '<axis xyz="0 1 0"/>'
ELBOW = '<joint name="elbow" type="continuous">'
ROBOT = '<robot name="two">'


def load(folder: Path, text: str | bytes, choice: str = "") -> robots.RobotModel:
    file = folder / "arm.urdf"
    file.write_bytes(text if isinstance(text, bytes) else text.encode())
    return robots.load(f"{file}{choice}")


def numbers(arm: robots.RobotModel) -> np.ndarray:
    """M and g at a state, friction and limits."""
    model, q = NumericModel(arm), np.linspace(0.3, 1.1, arm.n)
    limits = [-1 if limit is None else float(limit.value) for limit in arm.torque_limit]
    viscous = [float(b.value) for b in arm.viscous]
    return np.concatenate([model.mass(q).ravel(), model.gravity(q), limits, viscous])


# What is added to which words, and whether it is read, idle, told (by which words) or refused.
WORDS = [
    (INERTIA, INERTIA.replace("/>", ' iyx="0" izx="0" izy="0"/>'), "idle"),
    (INERTIA, INERTIA.replace("/>", ' iyx="0.001"/>'), "refused: iyx = 0.001: differs from ixy"),
    (INERTIA, INERTIA.replace("/>", ' unit="g"/>'), "told: unit of <inertia> (link upper)"),
    (MASS, '<mass value="2" unit="kg"/>', "told: unit of <mass>"),
    (LIMIT, LIMIT.replace("/>", ' motor_velocity="9" peak_effort="9"/>'), "told: motor_velocity of <limit>"),
    (LIMIT, LIMIT.replace("/>", ' acceleration="9" jerk="9"/>'), "idle"),
    (LIMIT, LIMIT.replace("effort", "efort"), "refused: efort: means nothing in URDF; did you mean effort?"),
    (DYNAMICS, DYNAMICS.replace("/>", ' spring_stiffness="9"/>'), "told: spring_stiffness of <dynamics>"),
    (DYNAMICS, DYNAMICS.replace("/>", ' coulomb="9" dampingg="1"/>'), "told: coulomb of <dynamics>"),
    (DYNAMICS, DYNAMICS.replace("damping", "Damping"), "refused: did you mean damping?"),
    (AXIS, '<axis xyz="0 1 0" rpy="0 0 1"/>', "refused: axis"),
    (AXIS, '<axis xyz="0 1 0" expressed_in="base"/>', "refused: expressed_in"),
    (UPPER, '<origin xyz="0.1 0 0" quat_wxyz="1 0 0 0"/>', "refused: did you mean quat_xyzw?"),
    (PLACE, '<origin xyz="0.3 0 0" euler="1 0 0"/>', "refused: places or turns something"),
    (PLACE, '<origin xyz="0.3 0 0" wxyz="1 0 0 0"/>', "refused: places or turns something"),
    (ELBOW, ELBOW + '<armature value="0"/><hardwareInterface/>', "told: armature of <joint> (joint elbow)"),
    (ELBOW, '<joint name="elbow" type="continuous" gear="80">', "told: gear of <joint>"),
    (ELBOW, ELBOW + "<parent_of/><calibration/><safety_controller/>", "told: parent_of of <joint>"),
    (MASS, MASS + "<density/>", "told: density of <inertial>"),
    (
        '<link name="base"/>',
        '<link name="base"><visual/><collision/><collisions/></link>',
        "told: collisions",
    ),
    (ROBOT, ROBOT + "<gazebo/><transmission/><material/><sensor/><ros2_control/>", "idle"),
    (ROBOT, ROBOT + "<loop_joint/>", "told: loop_joint of <robot> (robot two)"),
    (ROBOT, '<robot name="two" xmlns:x="u" version="1.0" xml:lang="en">', "idle"),
    *(
        (ROBOT, f'<robot name="two" version="{v}">', "refused: version of URDF")
        for v in ("2.0", "1.3", "", "x")
    ),
    (LIMIT, LIMIT.replace('"-1"', '"-inf"').replace('"1"', '"1e999"'), "idle"),
    ('type="continuous">', 'type="continuous"><limit velocity="1"/>', "idle"),
    (ELBOW, f'{ELBOW}<limit effort="0" velocity="1"/>', "idle"),
    *((ELBOW, f'{ELBOW}<limit effort="{e}"/>', "idle") for e in ("inf", "+INF", "Infinity", "1e30")),
    *((ELBOW, f'{ELBOW}<limit effort="{e}"/>', "refused: effort") for e in ("-inf", "nan", "-1", "x")),
]


@pytest.mark.parametrize(("old", "new", "what"), WORDS)
def test_every_word_is_read_idle_told_or_refused(tmp_path: Path, old: str, new: str, what: str) -> None:
    assert old in TWO
    kind, _, words = what.partition(": ")
    text = TWO.replace(old, new, 1)
    if kind == "refused":
        with pytest.raises(InputError) as caught:
            load(tmp_path, text)
        assert words in str(caught.value)
        return
    arm, plain = load(tmp_path, text), load(tmp_path, TWO)
    assert np.array_equal(numbers(arm), numbers(plain))
    said = [sentence for sentence in arm.remarks if sentence not in plain.remarks]
    assert len(said) == (kind == "told")
    assert words in "".join(said)


@pytest.mark.parametrize(
    ("quaternion", "rpy"),
    [
        ("0 0 0 1", "0 0 0"),
        ("0.7071067811865476 0 0 0.7071067811865475", "1.570796326794897 0 0"),
        ("3 0 0 3", "1.570796326794897 0 0"),
        ("0 -5 0 5", "0 -1.570796326794897 0"),
        (
            "0.18257418583505536 0.3651483716701107 0.5477225575051661 0.7302967433402214",
            "0.8760580505981934",
        ),
    ],
)
@pytest.mark.parametrize("place", [UPPER, PLACE])
def test_quaternions_are_those_of_angles(tmp_path: Path, place: str, quaternion: str, rpy: str) -> None:
    xyz = place.split('"')[1]
    turned = f'<origin xyz="{xyz}" quat_xyzw="{quaternion}"/>'
    new = TWO.replace(ROBOT, '<robot name="two" version="1.1">').replace(place, turned, 1)
    if " " not in rpy:  # one that no angles of few digits give: held against the formula for R(q)
        x, y, z, w = map(float, quaternion.split())
        pitch, yaw = np.arcsin(2 * (w * y - z * x)), np.arctan2(2 * (w * z + x * y), 1 - 2 * (y * y + z * z))
        rpy = f"{np.arctan2(2 * (w * x + y * z), 1 - 2 * (x * x + y * y))!r} {pitch!r} {yaw!r}"
        rpy = re.sub(r"np\.float64\(([^)]*)\)", r"\1", rpy)
    old = TWO.replace(place, f'<origin xyz="{xyz}" rpy="{rpy}"/>', 1)
    assert np.allclose(numbers(load(tmp_path, new)), numbers(load(tmp_path, old)), atol=1e-13, rtol=0)


@pytest.mark.parametrize(
    ("version", "words", "told"),
    [
        ("", 'quat_xyzw="1 0 0 1"', "turns something from URDF 1.1 on"),
        (' version="1.0"', 'quat_xyzw="1 0 0 1"', "turns something from URDF 1.1 on"),
        (' version="1.2"', 'quat_xyzw="1 0 0 1" rpy="0 0 0"', "turns what rpy turns, too"),
        (' version="1.1"', 'quat_xyzw="0 0 0 0"', "must not be zero"),
        (' version="1.1"', 'quat_xyzw="1 0 0"', "must be four numbers"),
    ],
)
def test_quaternions_that_are_none(tmp_path: Path, version: str, words: str, told: str) -> None:
    text = TWO.replace(ROBOT, f'<robot name="two"{version}>').replace(PLACE, f'<origin xyz="0 0 0" {words}/>')
    with pytest.raises(InputError, match=told):
        load(tmp_path, text)


BODY = TWO.partition("\n")[2].replace(ROBOT, f"<!-- Größe -->{ROBOT}")


@pytest.mark.parametrize(
    "data",
    [
        *(
            f'<?xml version="1.0" encoding="{code}"?>\n{BODY}'.encode(code)
            for code in ("ISO-8859-1", "windows-1252", "utf-8", "UTF-16", "ISO-8859-15")
        ),
        b"\xef\xbb\xbf" + BODY.encode(),
        b"\n \n" + f'<?xml version="1.0" encoding="ISO-8859-1"?>\n{BODY}'.encode("ISO-8859-1"),
        *(
            f"{doctype}\n{BODY}".encode()
            for doctype in ("<!DOCTYPE robot>", "<!DOCTYPE robot []>", '<!DOCTYPE robot SYSTEM "urdf.dtd">')
        ),
    ],
)
def test_encodings_and_document_types(tmp_path: Path, data: bytes) -> None:
    assert np.array_equal(numbers(load(tmp_path, data)), numbers(load(tmp_path, TWO)))


@pytest.mark.parametrize(
    ("data", "told"),
    [
        (BODY.encode("ISO-8859-1"), "is not UTF-8 text"),
        (f'<?xml version="1.0" encoding="klingon"?>{BODY}'.encode(), "klingon|not known|unknown encoding"),
        (f'<!DOCTYPE robot SYSTEM "a.dtd">\n{BODY}'.replace('"2"', '"&m;2"').encode(), "an entity"),
        (f'<!DOCTYPE robot [<!ATTLIST mass unit CDATA "g">]>\n{BODY}'.encode(), "document type"),
    ],
)
def test_what_no_encoding_or_declaration_explains(tmp_path: Path, data: bytes, told: str) -> None:
    with pytest.raises(InputError, match=told):
        load(tmp_path, data)


def test_missing_inertia_is_told_by_link_and_line(tmp_path: Path) -> None:
    bare = re.sub(r"<inertial>.*?</inertial>", "", TWO, flags=re.DOTALL)
    lines = {
        match[1]: bare.count("\n", 0, match.start()) + 1 for match in re.finditer('<link name="(.*?)"', bare)
    }
    with pytest.raises(InputError) as caught:
        load(tmp_path, bare)
    places = ", ".join(f"{name} (line {lines[name]})" for name in ("upper", "lower", "tool"))
    assert f"4 of 4 links have no <inertial>: {places}: this file describes geometry only" in str(
        caught.value
    )


@pytest.mark.parametrize(("size", "sound"), [("1e-16", True), ("-2.2e-33", True), ("-1e-5", False)])
def test_a_sound_body_may_have_a_link_off_by_rounding(tmp_path: Path, size: str, sound: bool) -> None:
    text = TWO.replace('ixx="0.001"', f'ixx="{size}"')
    assert text != TWO
    if sound:
        assert load(tmp_path, text).n == 2
        text = text.replace('<mass value="1.5"/>', '<mass value="0"/>').replace('value="0.25"', 'value="0"')
    wrong = text.replace('ixx="0.01" ixy="0"', 'ixx="-0.01" ixy="0"')
    with pytest.raises(InputError, match="must be positive semidefinite"):
        load(tmp_path, wrong)


# Which chain is the arm -----

BODY_OF = f'<inertial><origin xyz="0.1 0 0"/><mass value="1"/>{INERTIA}</inertial>'


KINDS = {"c": "continuous", "p": "prismatic", "x": "fixed", "f": "floating"}


def tree(*branches: str) -> str:
    """A robot of branches ``LINK:KIND NAME, KIND NAME …``, each joint with a link of its name."""
    parts = ['<link name="root"/>']
    for branch in branches:
        above, _, joints = branch.partition(":")
        for words in joints.split(","):
            kind, name = words.split()
            mimic = '<mimic joint="a1"/>' if kind == "mimic" else ""
            parts.append(
                f'<link name="{name}">{BODY_OF}</link><joint name="{name}" type="{KINDS.get(kind, "revolute")}">'
                f'<parent link="{above}"/><child link="{name}"/><origin xyz="0.2 0 0.1"/><axis xyz="0 1 0"/>{mimic}'
                '<limit effort="9" velocity="1"/></joint>'
            )
            above = name
    return f"<robot>{''.join(parts)}</robot>"


ARM = "root:r a1,r a2,r a3"
LEFT, RIGHT = "torso:r l1,r l2,r l3,p l4", "torso:r r1,r r2,r r3,p r4"
PALM = [f"a3:{','.join(f'r f{i}{k}' for k in range(length))}" for i, length in enumerate((3, 2, 2))]
ROBOTS: list[tuple[str, list[str], str]] = [
    ("plain", [ARM], "a1 a2 a3"),
    ("two fingers", [ARM, "a3:r f1", "a3:mimic f2"], "a1 a2 a3"),
    ("sliding fingers", [ARM, "a3:p f1", "a3:p f2"], "a1 a2 a3"),
    ("a hand with a thumb", ["root:r a0,r a1,r a2,r a3", PALM[1], PALM[2].replace("f2", "g")], "a0 a1 a2 a3"),
    ("a camera on the way", [ARM, "a1:r pan"], "a1 a2 a3"),
    ("a lift", ["root:p lift,r a1,r a2"], "a1 a2"),
    ("a floating base", ["root:f free,r a1,r a2"], "a1 a2"),
    ("a turret", ["root:c yaw,p slide,x mount,r a1,r a2"], "a1 a2"),
    ("a quill", ["root:r a1,r a2,p quill,r a4"], "a1 a2"),
    ("a mimic", ["root:r a1,mimic a2,r a3,r a4"], "a3 a4"),
    ("two arms", ["root:p torso", LEFT, RIGHT], ""),
    ("two arms on a turning torso", ["root:r torso", LEFT, RIGHT], ""),
    ("two arms behind a lift that turns", ["root:r yaw,p torso", LEFT, RIGHT], ""),
    ("only fixed", ["root:x a,x b"], ""),
    ("only a lift", ["root:p lift"], ""),
    ("too many", [f"root:{','.join(f'r j{i}' for i in range(15))}"], ""),
]


@pytest.mark.parametrize(("name", "branches", "joints"), ROBOTS, ids=[name for name, _, _ in ROBOTS])
def test_the_arm_is_the_longest_run_up_to_where_chains_part(
    tmp_path: Path, name: str, branches: list[str], joints: str
) -> None:
    if joints:
        arm = load(tmp_path, tree(*branches))
        assert arm.joints == tuple(joints.split())
        assert ("are held" in "".join(arm.remarks)) == (name != "plain")
    else:
        with pytest.raises(InputError):
            load(tmp_path, tree(*branches))


def advised(error: InputError) -> Iterator[str]:
    """Every choice that the repair of an error writes for the command line."""
    for problem in error.problems:
        for words in re.findall(r"((?:--(?:base|tip|fixed) \S+ ?)+)\(in an arm file", problem.repair):
            pairs = re.findall(r"--(base|tip|fixed) (\S+)", words)
            fixed = {
                word.partition("=")[0]: Fraction(word.partition("=")[2])
                for key, word in pairs
                if key == "fixed"
            }
            links = {key: word for key, word in pairs if key != "fixed"}
            yield Choice(links.get("base", ""), links.get("tip", ""), fixed).of("")


def tried(folder: Path, text: str, choice: str) -> list[str | None]:
    """What to try next: nothing where the arm loads or a link is a wrong one, ``None`` without advice."""
    try:
        load(folder, text, choice)
    except InputError as error:
        lost = "is not between" in str(error)
        return [] if lost else list(advised(error)) or [None]
    return []


@pytest.mark.parametrize(("name", "branches", "joints"), one_in(3, ROBOTS))
def test_every_advice_ends_in_an_arm(tmp_path: Path, name: str, branches: list[str], joints: str) -> None:
    text = tree(*branches)
    links = re.findall('<link name="(.*?)"', text)
    for choice in ("", *(f"#tip={link}" for link in links), *(f"#base={link}" for link in links)):
        waiting, followed = [choice], 0
        while waiting and followed < 30:
            here = waiting.pop()
            new = list(tried(tmp_path, text, here))
            assert new != [None] or name.startswith("only")
            waiting += [word for word in new if word]
            followed += 1
        assert not waiting


def test_joints_are_held_where_they_are_asked_to_be(tmp_path: Path) -> None:
    """A held joint is a fixed one whose origin has its motion in it."""
    text = tree("root:r a1,p a2,r a3")
    arm = load(tmp_path, text, "#fixed.a2=0.25&tip=a3")
    joint = text[text.index('<joint name="a2"') :]
    fixed = joint.replace('xyz="0.2 0 0.1"', 'xyz="0.2 0.25 0.1"', 1).replace("prismatic", "fixed", 1)
    by_hand = load(tmp_path, text.replace(joint, fixed))
    assert arm.joints == by_hand.joints == ("a1", "a3")
    assert np.array_equal(numbers(arm), numbers(by_hand))
    turned = load(tmp_path, tree(ARM), "#fixed.a2=1.25")
    fixed = tree(ARM).replace('type="revolute"><parent link="a1"/>', 'type="fixed"><parent link="a1"/>')
    fixed = fixed.replace(
        '<child link="a2"/><origin xyz="0.2 0 0.1"',
        '<child link="a2"/><origin xyz="0.2 0 0.1" rpy="0 1.25 0"',
    )
    assert np.allclose(numbers(turned), numbers(load(tmp_path, fixed)), atol=1e-14, rtol=0)
    assert "a2 (revolute) at 1.25" in "".join(turned.remarks)


def test_an_arm_file_chooses_as_a_name_does(tmp_path: Path) -> None:
    (tmp_path / "arm.urdf").write_text(tree("root:p torso", LEFT, RIGHT))
    (tmp_path / "arm.toml").write_text(
        'title = "t"\nurdf = "arm.urdf"\nbase = "l1"\ntip = "l3"\nfixed = { torso = 0.1 }\n'
    )
    assert robots.load(tmp_path / "arm.toml").joints == ("l2", "l3")
    assert robots.load(f"{tmp_path}/arm.toml#base=torso&tip=r3").joints == ("r1", "r2", "r3")
    name = Choice("torso", "r3", {"torso": Fraction("0.1")}).of(f"{tmp_path}/arm.urdf#tip=l3")
    assert split(name) == (f"{tmp_path}/arm.urdf", Choice("torso", "r3", {"torso": Fraction("0.1")}))
    assert robots.load(name).joints == ("r1", "r2", "r3")


@pytest.mark.parametrize(
    ("choice", "told"),
    [
        ("#tip=lowr", "tip = lowr: is no link of this file; name one, for instance lower"),
        ("#base=tool&tip=lower", "base = tool: is not between base and lower"),
        ("#fixed.elbo=0", "fixed = elbo: is no joint of this file; name one, for instance elbow"),
        ("#fixed.elbow=x", "x is no decimal number"),
        ("#fixed.elbow=0&fixed.shoulder=0", "has no revolute joint on this chain; choose --tip lower"),
        ("#angle=3", "chooses angle, which means nothing"),
        ("#xacro.a=3", "is no xacro file"),
    ],
)
def test_choices_that_are_none(tmp_path: Path, choice: str, told: str) -> None:
    with pytest.raises(InputError) as caught:
        load(tmp_path, TWO, choice)
    assert told in str(caught.value)


def test_panda_needs_no_tip() -> None:
    assert robots.load(ARMS / "panda.urdf").n == 7
