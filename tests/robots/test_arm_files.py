"""Arm files: what is read, and how every way of getting one wrong is told."""

from fractions import Fraction

import pytest

from lyapcheck import robots
from lyapcheck.errors import InputError

CHAIN = """\
title = "two joints"
source = "a test"
gravity = [0, 0, -9.81]

[[links]]
name = "base"
axis = [0, 0, 1]
origin = [0, 0, 0]
com = [0, 0, 0.1]
mass = 2
inertia = { ixx = 0.3, iyy = 0.3, izz = 0.2 }
viscous = 0.5

[[links]]
name = "arm"
axis = [0, 1, 0]
origin = [0, 0, 0.2]
com = [0.3, 0, 0]
mass = 1.5
inertia = { ixx = 0.01, iyy = 0.1, izz = 0.1 }
viscous = 0.25
coulomb = 0.1
torque_limit = 20
encoder = 4096
"""

PRINTED = """\
title = "two printed joints"
source = "a test"

[numbers]
b = 0.084

[model]
M11 = [[2.351, ""], [2, "b c2"]]
M12 = [[0.102, ""], [1, "b c2"]]
M22 = [[0.102, ""]]
potential = [[-38.46501, "c1"], [-1.82466, "c12"]]

[[joints]]
name = "shoulder"
viscous = 2.288

[[joints]]
name = "elbow"
viscous = 0.175
"""


def load(folder, text, name="arm.toml"):
    file = folder / name
    file.write_text(text, encoding="utf-8")
    return robots.load(file)


def problems(folder, text):
    with pytest.raises(InputError) as caught:
        load(folder, text)
    return [str(problem).removeprefix(f"{folder}/") for problem in caught.value.problems]


def test_a_chain_is_read_exactly(tmp_path):
    arm = load(tmp_path, CHAIN)
    assert (arm.name, arm.joints, arm.encoder) == ("arm", ("base", "arm"), (None, 4096))
    assert arm.numbers["arm_mass"].value == Fraction(3, 2)
    assert arm.numbers["arm_mass"].source == "a test"
    assert arm.torque_limit[0] is None
    sin, cos = [Fraction(0)] * 2, [Fraction(1)] * 2
    assert arm.at(sin, cos, Fraction).mass()[1][1] == Fraction("0.1") + Fraction("1.5") * Fraction("0.09")
    assert arm.at(sin, cos, Fraction).gravity() == [0, -Fraction("1.5") * Fraction("9.81") * Fraction("0.3")]


def test_a_printed_model_is_read_exactly(tmp_path):
    arm, built_in = load(tmp_path, PRINTED), robots.load("reyes-kelly2")
    assert (arm.mass, arm.potential) == (built_in.mass, built_in.potential)


def test_gravity_is_not_told_to_be_in_a_potential_that_is_not_there(tmp_path):
    told = problems(tmp_path, CHAIN.replace("[[links]]", "[[joint]]"))
    assert any("links: is missing" in one for one in told)
    assert not any("gravity" in one for one in told)


def test_ranges_become_parameters(tmp_path):
    arm = load(tmp_path, CHAIN.replace("mass = 1.5", "mass = { value = 1.5, low = 1, high = 2 }"))
    assert list(arm.parameters) == ["arm_mass"]
    sin, cos = [Fraction(0)] * 2, [Fraction(1)] * 2
    heavy = arm.at(sin, cos, Fraction, {"arm_mass": Fraction(2)}).mass()
    assert heavy[1][1] == Fraction("0.1") + 2 * Fraction("0.09")


# Each row: the text, what to replace in it, by what, and what the message must say (with its line).
BROKEN = [
    (CHAIN, 'title = "two joints"\n', "", ["arm.toml: title: is missing; add title to this table"]),
    (CHAIN, 'title = "two joints"', "title = 3", ["arm.toml:1: title = 3: must be a non-empty text"]),
    (CHAIN, "mass = 1.5", "mass = 0", ["arm.toml:19: links[2].mass = 0: must be positive"]),
    (CHAIN, "mass = 1.5\n", "", ["links[2].mass: is missing"]),
    (CHAIN, "mass = 1.5", 'mass = { value = 1500, unit = "g" }', ["mass.unit = g: must be kg; convert"]),
    (CHAIN, "mass = 1.5", "mass = { value = 1.5, low = 1 }", ["mass.low = 1: a range needs both ends"]),
    (CHAIN, "mass = 1.5", "mass = { value = 1.5, low = 2, high = 3 }", ["must lie in its range [2, 3]"]),
    (CHAIN, "mass = 1.5", "mass = { value = 1.5, assumed = true }", ["an assumption needs its reason"]),
    (CHAIN, "mass = 1.5", "mass = { low = 1, high = 2 }", ["links[2].mass.value: is missing"]),
    (CHAIN, "coulomb = 0.1", "colomb = 0.1", ["arm.toml:22: links[2].colomb", "did you mean coulomb?"]),
    (
        CHAIN,
        "axis = [0, 1, 0]",
        "axis = [0, 1, 1]",
        ["links[2].axis", "must be a vector whose length is a rational number"],
    ),
    (CHAIN, "com = [0.3, 0, 0]", "com = 0.3", ["links[2].com = 0.3: must be a list of 3 numbers"]),
    (CHAIN, "izz = 0.1 ", "izz = -0.1 ", ["links[2].inertia", "must be positive semidefinite"]),
    (CHAIN, "izz = 0.1 ", "izz = 0.2 ", ["links[2].inertia", "must obey the triangle inequality"]),
    (CHAIN, "inertia = { ixx = 0.01, iyy = 0.1, izz = 0.1 }", "inertia = 0.1", ["turning in a plane only"]),
    (CHAIN, "viscous = 0.25", "viscous = -1", ["links[2].viscous = -1: must be zero or positive"]),
    (CHAIN, "coulomb = 0.1", "coulomb = -0.1", ["links[2].coulomb = -0.1: must be zero or positive"]),
    (CHAIN, "encoder = 4096", "encoder = 4096.5", ["encoder = 4096.5: must be a whole number"]),
    (CHAIN, 'name = "arm"', 'name = "base"', ["links[2].name = base: is used by another joint"]),
    (CHAIN, 'name = "arm"', 'name = "Arm 2"', ["links[2].name = Arm 2: must be up to 31 small letters"]),
    (CHAIN, CHAIN[CHAIN.index("[[links]]") :], "", ["links: is missing; describe the arm by [[links]], or"]),
    (CHAIN, CHAIN[CHAIN.index("[[links]]") :], "links = []", ["links = []: must be an array of tables"]),
    (CHAIN, "encoder = 4096", "[model]", ["model", "does not go together with [[links]]"]),
    (PRINTED, '[1, "b c2"]', '[1, "b c3"]', ["model.M12[2][2]", "'c3' speaks of a joint that this arm of 2"]),
    (PRINTED, '[1, "b c2"]', '[1, "a c2"]', ["'a' is neither a sine, a cosine nor an entry of [numbers]"]),
    (PRINTED, '[1, "b c2"]', '[1, "b*c2"]', ["arm.toml:9: model.M12[2][2] = b*c2: 'b*c2' is no factor"]),
    (PRINTED, '[1, "b c2"]', '["b c2"]', ["model.M12[2]", "must be a decimal and a text of factors"]),
    (PRINTED, '[1, "b c2"]', f'[1, "{"c2 " * 13}"]', ["has more than 12 factors"]),
    (PRINTED, '[1, "b c2"]', '[1, "s12121212^3"]', ["adds up more than 16 angles"]),
    (PRINTED, 'M22 = [[0.102, ""]]', 'M22 = [[0.102, ""]]\nM21 = []', ["model.M21", "M is symmetric"]),
    (PRINTED, "b = 0.084", "b = { value = 0.084, low = 0, high = 9 }", ["not positive definite", "b = 9"]),
    (PRINTED, 'name = "elbow"', 'name = "elbow"\nmass = 3', ["joints[2].mass = 3: is not a known key here"]),
]


def test_a_broken_file_is_told_what_is_wrong(tmp_path):
    for text, old, new, expected in BROKEN:
        assert old in text
        printed = "\n".join(problems(tmp_path, text.replace(old, new)))
        assert all(part in printed for part in expected), (new, printed)


def test_all_problems_at_once(tmp_path):
    broken = (
        CHAIN.replace("mass = 1.5", "mass = -1")
        .replace("mass = 2", "mass = nan")
        .replace("coulomb", "columb")
    )
    assert len(problems(tmp_path, broken)) == 3


def test_one_mistake_is_told_once(tmp_path):
    assert len(problems(tmp_path, CHAIN.replace("axis = [0, 1, 0]", "axis = [0, 2, 1]"))) == 1


def test_more_joints_than_are_understood(tmp_path):
    head, link = CHAIN.split("[[links]]")[:2]
    links = "".join(f"[[links]]{link}".replace('"base"', f'"j{i}"') for i in range(13))
    assert "has more than 12 joints" in "\n".join(problems(tmp_path, head + links))


@pytest.mark.parametrize(
    ("name", "content", "rule"),
    [
        ("arm.urdf", b"<robot/>", "has no link"),
        ("arm.yaml", b"", "is no arm file"),
        ("arm.toml", b"\xff\xfe", "is not UTF-8 text"),
        ("arm.toml", b"#" * 1_000_001, "is larger than 1000000 bytes"),
        ("arm.toml", b"x = " + b"[" * 5000, "is nested too deeply"),
        ("arm.toml", b"x = 1" + b"0" * 5000, "absurd length"),
        ("arm.toml", b"", "title: is missing"),
    ],
)
def test_what_is_no_arm_file_at_all(tmp_path, name, content, rule):
    file = tmp_path / name
    file.write_bytes(content)
    with pytest.raises(InputError, match=rule):
        robots.load(file)
