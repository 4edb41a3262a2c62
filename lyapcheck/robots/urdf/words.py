"""Which words of a URDF file an arm is made of, which have no influence on it, and which are told.

Whatever is neither read nor known to be without influence on M, C, g, friction and limits is told as not
used; where it would place or turn something, the file is refused.
"""

from __future__ import annotations

from dataclasses import dataclass

INERTIA = ("ixx", "iyy", "izz", "ixy", "ixz", "iyz")
MIRRORED = {"iyx": "ixy", "izx": "ixz", "izy": "iyz"}
"""The other half of a symmetric tensor, which some programs write."""
VERSIONS = {"1": False, "1.0": False, "1.1": True, "1.2": True}
"""The versions of URDF that there are, and whether they know ``quat_xyzw``."""


@dataclass(frozen=True)
class Words:
    """The words at one place of URDF.

    Args:
        read: what an arm is made of.
        idle: what has no influence on it.
        closed: whether any other word places or turns something.
    """

    read: tuple[str, ...]
    idle: tuple[str, ...] = ()
    closed: bool = False


ATTRIBUTES = {
    "robot": Words(("name", "version")),
    "link": Words(("name",), ("type",)),
    "inertial": Words(()),
    "joint": Words(("name", "type")),
    "origin": Words(("xyz", "rpy", "quat_xyzw"), closed=True),
    "axis": Words(("xyz",), closed=True),
    "mass": Words(("value",)),
    "inertia": Words(INERTIA, tuple(MIRRORED)),
    "dynamics": Words(("damping", "friction")),
    "limit": Words(("effort",), ("lower", "upper", "velocity", "acceleration", "deceleration", "jerk")),
    "parent": Words(("link",)),
    "child": Words(("link",)),
}
CHILDREN = {
    "robot": Words(
        ("link", "joint"), ("material", "transmission", "gazebo", "sensor", "ros2_control", "xacro:property")
    ),
    "link": Words(("inertial",), ("visual", "collision", "self_collision_checking", "sensor", "contact")),
    "inertial": Words(("origin", "mass", "inertia")),
    "joint": Words(
        ("parent", "child", "origin", "axis", "dynamics", "limit", "mimic"),
        ("calibration", "safety_controller", "hardwareInterface"),
    ),
}
