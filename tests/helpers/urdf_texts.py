"""URDF texts that the tests share."""

import random
from pathlib import Path

ARMS = Path(__file__).parents[2] / "examples"

TWO = """\
<?xml version="1.0"?>
<robot name="two">
  <link name="base"/>
  <link name="upper">
    <inertial>
      <origin xyz="0.1 0 0" rpy="0 0 0"/>
      <mass value="2"/>
      <inertia ixx="0.01" ixy="0" ixz="0" iyy="0.02" iyz="0" izz="0.02"/>
    </inertial>
  </link>
  <link name="lower">
    <inertial>
      <origin xyz="0.2 0 0"/>
      <mass value="1.5"/>
      <inertia ixx="0.01" ixy="0" ixz="0" iyy="0.02" iyz="0" izz="0.02"/>
    </inertial>
  </link>
  <link name="tool">
    <inertial>
      <mass value="0.25"/>
      <inertia ixx="0.001" ixy="0" ixz="0" iyy="0.001" iyz="0" izz="0.001"/>
    </inertial>
  </link>
  <joint name="shoulder" type="revolute">
    <parent link="base"/>
    <child link="upper"/>
    <origin xyz="0 0 0.5" rpy="0 0 0"/>
    <axis xyz="0 1 0"/>
    <limit lower="-1" upper="1" effort="20" velocity="2"/>
    <dynamics damping="0.5" friction="0.1"/>
  </joint>
  <joint name="elbow" type="continuous">
    <parent link="upper"/>
    <child link="lower"/>
    <origin xyz="0.3 0 0"/>
    <axis xyz="0 1 0"/>
    <dynamics damping="0.25"/>
  </joint>
  <joint name="flange" type="fixed">
    <parent link="lower"/>
    <child link="tool"/>
    <origin xyz="0.4 0 0" rpy="0 0 1.5708"/>
  </joint>
</robot>
"""


def generic(n, seed=1):
    """A chain of n joints with nothing special about it: all angles, places and inertias are odd."""
    rng = random.Random(seed)

    def triple(size):
        return " ".join(f"{rng.uniform(-size, size):.3f}" for _ in range(3))

    parts = ['<robot name="generic"><link name="l0"/>']
    for i in range(1, n + 1):
        moments = " ".join(f'i{a}{a}="{rng.uniform(0.02, 0.03):.4f}"' for a in "xyz")
        parts.append(
            f'<link name="l{i}"><inertial><origin xyz="{triple(0.1)}" rpy="{triple(3)}"/>'
            f'<mass value="{rng.uniform(1, 4):.3f}"/>'
            f'<inertia {moments} ixy="0.001" ixz="0.002" iyz="-0.001"/></inertial></link>'
            f'<joint name="j{i}" type="revolute"><parent link="l{i - 1}"/><child link="l{i}"/>'
            f'<origin xyz="{triple(0.3)}" rpy="{triple(3)}"/><axis xyz="{triple(1)}"/>'
            '<limit effort="10" velocity="1" lower="-1" upper="1"/></joint>'
        )
    return "".join(parts) + "</robot>"
