"""MJCF arms against MuJoCo: M without armature, g, damping, dry friction and limits; xacro files expanded.

Not part of the ordinary tests: they need the packages ``mujoco`` and ``xacrodoc``, which ``make test-robots``
installs.
"""

from __future__ import annotations

from pathlib import Path

import mujoco
import numpy as np
import pytest

from lyapcheck import robots
from lyapcheck.errors import InputError
from lyapcheck.robots.numeric import NumericModel
from tests.helpers.urdf_texts import TWO

LINK = '<body name="{name}" {pose}>{joints}<inertial pos="0.05 -0.02 0.1" quat="1 0.2 0 -0.3" mass="{mass}" diaginertia="0.01 0.02 0.025"/>{inside}</body>'  # noqa: E501
HINGE = (
    '<joint name="{name}" type="hinge" axis="{axis}" damping="0.3" frictionloss="0.1" armature="0.4" {more}/>'
)
MOTORS = (
    '<actuator><motor joint="a" gear="50" ctrlrange="-1 2" ctrllimited="true"/>'
    '<position joint="b" kp="9" forcerange="-7 8" forcelimited="true"/></actuator>'
)
POSES = ['pos="0 0 0.3"', 'pos="0.2 0.1 0" euler="30 0 90"', 'pos="0.1 0 0.2" quat="1 2 -1 0.5"']


def chain(*joints: str, gravity: str = "0.3 -1 -9") -> str:
    """One body inside the other, each with its joints."""
    inside = ""
    for i in reversed(range(len(joints))):
        pose = POSES[i % len(POSES)]
        inside = LINK.format(name=f"l{i}", pose=pose, joints=joints[i], mass=i + 1, inside=inside)
    return f'<mujoco model="m"><option gravity="{gravity}"/><worldbody>{inside}</worldbody>{MOTORS}</mujoco>'


def hinge(name: str, axis: str, more: str = "") -> str:
    return HINGE.format(name=name, axis=axis, more=more)


A, B, C = hinge("a", "0 0 1"), hinge("b", "0 1 0"), hinge("c", "1 1 0")
SLIDE = '<joint name="s" type="slide" axis="0 0 1"/>'
MODELS = {
    "plain": (chain(A, B, C), "a b c"),
    "joints beside their bodies": (chain(A, hinge("b", "0 1 0", 'pos="0.1 0.2 -0.1"'), C), "a b c"),
    "a reference angle": (
        chain(hinge("a", "0 0 1", 'ref="40"'), hinge("b", "1 2 3", 'ref="-70"'), C),
        "a b c",
    ),
    "two joints a body": (chain(A + B, C), "a b c"),
    "a body without a joint": (chain(A, "", B), "a b"),
    "a slide above": (chain(SLIDE, A, B), "a b"),
    "a free base": (chain('<freejoint name="s"/>', A, B), "a b"),
}


@pytest.mark.parametrize("name", MODELS)
def test_mjcf_is_what_mujoco_says(tmp_path: Path, name: str) -> None:
    text, joints = MODELS[name]
    file = tmp_path / "arm.xml"
    file.write_text(text)
    arm, m = robots.load(file), mujoco.MjModel.from_xml_path(str(file))
    assert arm.joints == tuple(joints.split())
    data, mine, rng = mujoco.MjData(m), NumericModel(arm), np.random.default_rng(1)
    ids = [mujoco.mj_name2id(m, mujoco.mjtObj.mjOBJ_JOINT, joint) for joint in arm.joints]
    places, degrees = m.jnt_qposadr[ids], m.jnt_dofadr[ids]
    for _ in range(5):
        q = rng.uniform(-2, 2, arm.n)
        data.qpos[:], data.qvel[:] = m.qpos0, 0
        data.qpos[places] = q
        mujoco.mj_forward(m, data)
        mass = np.array([_column(m, data, k) for k in degrees])[:, degrees] - np.diag(m.dof_armature[degrees])
        assert np.allclose(mine.mass(q), mass, atol=1e-12, rtol=0)
        assert np.allclose(mine.gravity(q), data.qfrc_bias[degrees], atol=1e-11, rtol=0)
    assert [float(b.value) for b in arm.viscous] == [0.3] * arm.n
    assert [x and float(x.value) for x in arm.coulomb] == [0.1] * arm.n
    limits = [x and float(x.value) for x in arm.torque_limit]
    assert limits == [{"a": 50.0, "b": 7.0}.get(joint) for joint in arm.joints]
    assert "compiled by MuJoCo" in arm.viscous[0].source
    assert "Rotor inertia that the file gives" in "".join(arm.remarks)


def _column(m: mujoco.MjModel, data: mujoco.MjData, k: int) -> np.ndarray:
    result = np.zeros(m.nv)
    mujoco.mj_mulM(m, data, result, np.eye(m.nv)[k])
    return result


def test_what_mujoco_refuses_is_told(tmp_path: Path) -> None:
    (tmp_path / "arm.xml").write_text(
        '<mujoco><worldbody><body name="a"><joint type="ball"/></body></worldbody></mujoco>'
    )
    with pytest.raises(InputError, match="is MJCF that MuJoCo refuses"):
        robots.load(tmp_path / "arm.xml")


XACRO = TWO.replace(
    '<robot name="two">', '<robot name="two" xmlns:xacro="x"><xacro:arg name="m" default="2"/>'
)


def test_xacro_is_expanded_with_its_arguments(tmp_path: Path) -> None:
    (tmp_path / "two.urdf").write_text(TWO.replace('<mass value="2"/>', '<mass value="3.5"/>'))
    (tmp_path / "arm.urdf.xacro").write_text(XACRO.replace('value="2"', 'value="${$(arg m) + 1}"'))
    plain = robots.load(tmp_path / "two.urdf")
    arm = robots.load(f"{tmp_path}/arm.urdf.xacro#xacro.m=2.5")
    assert (arm.mass, arm.potential, arm.name) == (plain.mass, plain.potential, "arm")
    assert "expanded by xacro" in arm.viscous[0].source
    with pytest.raises(InputError, match="a xacro file that cannot be expanded"):
        robots.load(f"{tmp_path}/arm.urdf.xacro#xacro.m=x")
