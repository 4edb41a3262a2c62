"""What an arm file says of a joint's motor: friction, limits, encoder."""

from __future__ import annotations

import re
from dataclasses import dataclass, replace

from lyapcheck.robots.fields import ArmFields, Number, Sign

ROTOR = "_rotor_inertia"
_NAME = re.compile(r"[a-z][a-z0-9_]{0,30}")


@dataclass(frozen=True)
class JointEntry:
    """One joint as read; ``None`` where the file says nothing (or nothing usable)."""

    name: str
    viscous: Number | None
    coulomb: Number | None
    torque_limit: Number | None
    encoder: int | None
    gravity_bound: Number | None
    rotor: Number | None = None

    @property
    def rotors(self) -> dict[str, Number]:
        """Its rotor inertia, which is a number of M(q), under the name that reports use."""
        return {} if self.rotor is None else {f"{self.name}{ROTOR}": self.rotor}

    def numbers(self) -> dict[str, Number]:
        """The other numbers of the joint under the names that reports use."""
        parts = ("viscous", "coulomb", "torque_limit", "gravity_bound")
        result = {f"{self.name}_{part}": getattr(self, part) for part in parts}
        return {name: number for name, number in result.items() if number is not None}


def read_joints(tables: list[ArmFields]) -> list[JointEntry]:
    """The joints of ``[[links]]`` or ``[[joints]]``, base first; names must differ."""
    joints = [_read_joint(table) for table in tables]
    for i, joint in enumerate(joints):
        if joint.name and joint.name in [other.name for other in joints[:i]]:
            tables[i].fail("name", "is used by another joint", "give each joint its own name")
    return joints


def _read_joint(fields: ArmFields) -> JointEntry:
    name = fields.text("name", required=True)
    if name and not _NAME.fullmatch(name):
        rule = "must be up to 31 small letters, digits and underscores, a letter first"
        fields.fail("name", rule, 'write a name like "shoulder"')
    _refuse_other_kinds(fields)
    return read_motor(name, fields, required=True)


def read_motor(name: str, fields: ArmFields, required: bool) -> JointEntry:
    """Friction, limits and encoder of a joint."""
    return JointEntry(
        name,
        fields.quantity("viscous", "N·m·s/rad", Sign.NONNEGATIVE, required=required),
        fields.quantity("coulomb", "N·m", Sign.NONNEGATIVE),
        fields.quantity("torque_limit", "N·m", Sign.POSITIVE),
        fields.integer("encoder", 1, 2**40),
        fields.quantity("gravity_bound", "N·m", Sign.NONNEGATIVE),
        _read_rotor(fields),
    )


def _read_rotor(fields: ArmFields) -> Number | None:
    """What the joint feels of its rotor: one number, or that of the rotor itself times gear²."""
    value = fields.data.get("rotor_inertia")
    if not isinstance(value, dict) or "value" in value:
        return fields.quantity("rotor_inertia", "kg·m²", Sign.NONNEGATIVE)
    table = fields.table("rotor_inertia")
    assert table is not None
    rotor = table.quantity("rotor", "kg·m²", Sign.NONNEGATIVE, required=True)
    gear = table.quantity("gear", "", Sign.POSITIVE, required=True)
    table.close()
    if rotor is None or gear is None:
        return None
    if gear.ranged:
        table.fail("gear", "must be exact", "give a plain number")
    low, high = (end * gear.value**2 for end in rotor.bounds)
    reflected = replace(rotor, value=rotor.value * gear.value**2)
    return replace(reflected, low=low, high=high) if rotor.ranged else reflected


def _refuse_other_kinds(fields: ArmFields) -> None:
    kind = fields.text("type")
    if kind in ("", "revolute", "continuous"):
        return
    rule = "only revolute joints are understood"
    if kind == "prismatic":
        rule = "the paper assumes revolute joints: its bounds on M, C and g fail for a prismatic one"
    fields.fail("type", rule, "remove the joint, or hold it fixed and give the arm without it")
