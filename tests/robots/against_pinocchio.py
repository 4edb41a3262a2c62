"""M, g and C w of URDF arms and built-in arms against Pinocchio, to 1e-12.

Not part of the ordinary tests: it needs the packages ``pin`` and ``example-robot-data`` (0.9 GB). Run it as
``pytest tests/robots/against_pinocchio.py``; without the packages it fails. ROBOT_DATA names another
folder of URDFs laid out like example-robot-data.
"""

from __future__ import annotations

import os
import re
import tomllib
from collections.abc import Sequence
from pathlib import Path
from typing import Any

import numpy as np
import pinocchio as pin
import pytest

from lyapcheck import robots
from lyapcheck.robots.numeric import NumericModel
from tests.helpers.urdf_texts import TWO, generic
from tests.robots.test_urdf_kinds import WORDS

STATES = 50
TOLERANCE = 1e-12
RIGHT = np.pi / 2
EXAMPLES = Path(__file__).parents[2] / "examples"


def data_folder() -> Path:
    """Where example-robot-data keeps its robots."""
    given = os.environ.get("ROBOT_DATA")
    if given:
        return Path(given)
    prefix = next(path for path in Path(pin.__file__).parents if path.name == "cmeel.prefix")
    return prefix / "share" / "example-robot-data" / "robots"


ARMS = [
    ("ur_description/urdf/ur5_robot.urdf", None, 6),
    ("ur_description/urdf/ur3_robot.urdf", None, 6),
    ("ur_description/urdf/ur10_robot.urdf", None, 6),
    ("panda_description/urdf/panda.urdf", "panda_hand", 7),
    ("kinova_description/robots/kinova.urdf", None, 6),
    ("xarm_description/urdf/xarm7.urdf", None, 7),
    ("so_arm_description/urdf/so101.urdf", None, 6),
    ("talos_data/robots/talos_left_arm.urdf", None, 7),
    ("asr_twodof_description/urdf/TwoDofs.urdf", None, 2),
    ("double_pendulum_description/urdf/double_pendulum.urdf", None, 2),
    ("double_pendulum_description/urdf/double_pendulum_continuous.urdf", None, 2),
    ("finger_edu_description/robots/finger_edu.urdf", None, 3),
    ("allegro_hand_description/urdf/allegro_left_hand.urdf", "link_3.0_tip", 4),
    ("baxter_description/urdf/baxter.urdf", "left_gripper_base_link", 7),
    # paths from the root stand as they are
    *(
        (str(EXAMPLES / f"{name}.urdf"), None, n)
        for name, n in (("px100", 4), ("px150", 5), ("xarm6", 6), ("iiwa14", 7))
    ),
]


@pytest.mark.parametrize(("file", "tip", "n"), ARMS, ids=[file.split("/")[-1] for file, _, _ in ARMS])
def test_urdf_arms(file: str, tip: str | None, n: int) -> None:
    path = data_folder() / file
    arm = robots.load(path, tip)
    assert arm.n == n
    compare(arm, pin.buildModelFromXML(with_right_angles(path.read_text())))


@pytest.mark.parametrize("name", ["pelican2", "pendulum1"])
def test_built_in_arms(name: str) -> None:
    """The links of the arm file, read by another reader and written as a URDF for Pinocchio."""
    file = Path(robots.__file__).parent / "arms" / f"{name}.toml"
    data = tomllib.loads(file.read_text())
    other = pin.buildModelFromXML(as_urdf(data))
    other.gravity.linear = np.array([value(x) for x in data["gravity"]])
    compare(robots.load(name), other)


@pytest.mark.parametrize(
    "quaternion", ["0 0 0 1", "1 2 -3 0.5", "0.7071 0 0 0.7071", "-3 0 0 1e-3", "0 -1 0 0"]
)
@pytest.mark.parametrize("origin", ['<origin xyz="0.1 0 0" rpy="0 0 0"/>', '<origin xyz="0.3 0 0"/>'])
def test_quaternions_of_urdf_1_1(tmp_path: Path, origin: str, quaternion: str) -> None:
    xyz = origin.split('"')[1]
    text = TWO.replace('<robot name="two">', '<robot name="two" version="1.1">')
    text = text.replace(origin, f'<origin xyz="{xyz}" quat_xyzw="{quaternion}"/>', 1)
    (tmp_path / "arm.urdf").write_text(text)
    compare(robots.load(tmp_path / "arm.urdf"), pin.buildModelFromXML(text))


@pytest.mark.parametrize(("old", "new", "what"), [row for row in WORDS if not row[2].startswith("refused")])
def test_what_is_idle_or_told_is_so_for_pinocchio(tmp_path: Path, old: str, new: str, what: str) -> None:
    """Of every word that is not read: M and g are those of Pinocchio, where it reads such a file."""
    (tmp_path / "arm.urdf").write_text(TWO.replace(old, new, 1))
    try:
        other = pin.buildModelFromXML((tmp_path / "arm.urdf").read_text())
    except ValueError:  # a continuous joint without effort or velocity, for one
        return
    compare(robots.load(tmp_path / "arm.urdf"), other)


@pytest.mark.parametrize("seed", range(100))
def test_random_chains(tmp_path: Path, seed: int) -> None:
    """Chains of 1 to 12 joints with nothing special about their frames."""
    file = tmp_path / "arm.urdf"
    file.write_text(generic(1 + seed % 12, seed))
    compare(robots.load(file), pin.buildModelFromXML(file.read_text()))


@pytest.mark.parametrize("seed", range(10))
def test_rotor_inertia_is_what_is_called_armature_there(tmp_path: Path, seed: int) -> None:
    file = tmp_path / "arm.urdf"
    file.write_text(generic(1 + seed, seed))
    other, bare = pin.buildModelFromXML(file.read_text()), robots.load(file)
    J = np.random.default_rng(seed).uniform(0, 2, bare.n).round(6)
    rows = [
        f'[[joints]]\nname = "{name}"\nrotor_inertia = {x}\n' for name, x in zip(bare.joints, J, strict=True)
    ]
    (tmp_path / "arm.toml").write_text(f'title = "Arm"\nurdf = "arm.urdf"\n{"".join(rows)}')
    other.armature = J[[bare.joints.index(name) for name in other.names[1:]]]
    compare(robots.load(tmp_path / "arm.toml"), other)


def compare(arm: robots.RobotModel, full: pin.Model) -> None:
    """M, g and C w at random states; joints that are not of the chain are locked at zero."""
    locked = [full.getJointId(name) for name in full.names[1:] if name not in arm.joints]
    other = pin.buildReducedModel(full, locked, pin.neutral(full))
    data, mine = other.createData(), NumericModel(arm)
    weightless = other.copy()
    weightless.gravity.linear = np.zeros(3)
    joints = [other.joints[other.getJointId(name)] for name in arm.joints]
    order = [joint.idx_v for joint in joints]
    rng = np.random.default_rng(20190301)
    states, rates_of = rng.uniform(-3, 3, (STATES, arm.n)), rng.uniform(-2, 2, (STATES, arm.n))
    result = mine.mass(states), mine.gravity(states), mine.coriolis(states, rates_of)
    for q, w, M, g, C in zip(states, rates_of, *result, strict=True):
        there, rates = configuration(other, joints, q), np.zeros(other.nv)
        rates[order] = w
        upper = np.triu(pin.crba(other, data, there))
        mass = (upper + np.triu(upper, 1).T)[np.ix_(order, order)]
        gravity = pin.computeGeneralizedGravity(other, data, there).copy()
        torque = pin.nle(weightless, weightless.createData(), there, rates)[order]
        assert_close(M, mass)
        assert_close(g, gravity[order])
        assert_close(C @ w, torque)


def assert_close(result: np.ndarray, expected: np.ndarray) -> None:
    scale = max(float(np.max(np.abs(expected))), 1e-3)
    assert float(np.max(np.abs(result - expected))) <= TOLERANCE * scale


def configuration(model: pin.Model, joints: Sequence[Any], q: np.ndarray) -> np.ndarray:
    """Pinocchio keeps a continuous joint as cosine and sine."""
    there = pin.neutral(model)
    for joint, angle in zip(joints, q, strict=True):
        there[joint.idx_q : joint.idx_q + joint.nq] = (
            [np.cos(angle), np.sin(angle)] if joint.nq == 2 else [angle]
        )
    return there


def with_right_angles(text: str) -> str:
    """The URDF with every angle within 10⁻⁹ rad of a multiple of π/2 in all digits of a double."""

    def exact(word: str) -> str:
        angle = RIGHT * round(float(word) / RIGHT)
        return repr(angle) if abs(float(word) - angle) <= 1e-9 else word

    return re.sub(
        r'rpy\s*=\s*"([^"]*)"', lambda result: f'rpy="{" ".join(exact(w) for w in result[1].split())}"', text
    )


def value(entry: Any) -> float:
    return float(entry["value"] if isinstance(entry, dict) else entry)


def as_urdf(data: dict[str, Any]) -> str:
    """The links of an arm file, at nominal values."""
    parts = ['<robot name="arm"><link name="base"/>']
    before = "base"
    for link in data["links"]:
        name, axis = link["name"], [value(x) for x in link["axis"]]
        inertia = link["inertia"]
        if not isinstance(inertia, dict) or "value" in inertia:
            keys = ("ixx", "iyy", "izz", "ixy", "ixz", "iyz")
            places = ((0, 0), (1, 1), (2, 2), (0, 1), (0, 2), (1, 2))
            inertia = {
                key: value(inertia) * axis[i] * axis[k] for key, (i, k) in zip(keys, places, strict=True)
            }
        moments = " ".join(
            f'{key}="{value(inertia.get(key, 0))!r}"' for key in ("ixx", "iyy", "izz", "ixy", "ixz", "iyz")
        )
        parts.append(
            f'<link name="{name}_body"><inertial><origin xyz="{words(link["com"])}"/>'
            f'<mass value="{value(link["mass"])!r}"/><inertia {moments}/></inertial></link>'
            f'<joint name="{name}" type="continuous"><parent link="{before}"/><child link="{name}_body"/>'
            f'<origin xyz="{words(link["origin"])}"/><axis xyz="{words(link["axis"])}"/></joint>'
        )
        before = f"{name}_body"
    return "".join([*parts, "</robot>"])


def words(vector: Sequence[Any]) -> str:
    return " ".join(repr(value(x)) for x in vector)
