"""The two ways in which an arm file gives its model: links to derive it from, or the printed polynomials."""

from __future__ import annotations

import re
from collections.abc import Callable, Mapping
from dataclasses import dataclass, replace
from fractions import Fraction
from typing import Any, ClassVar, Protocol

from lyapcheck.check.loop.chain import UNIT, RigidLink
from lyapcheck.robots import trig
from lyapcheck.robots.bodies import BodyEntry, components, read_bodies
from lyapcheck.robots.dynamics import Chain, Dynamics, ParameterShare, Polynomials
from lyapcheck.robots.fields import ROTOR, ArmFields, JointEntry, Number, read_joints
from lyapcheck.robots.printed import PrintedTerms, PrintedTorques, is_angle, read_printed, read_torques

MOST_JOINTS = 12
MOST_PRINTED = 9
"""A name like c12 is the cosine of q1 + q2, so that joints have one digit."""
_NAME = re.compile(r"[A-Za-z][A-Za-z0-9_]{0,40}")


class ModelPlan(Protocol):
    """A checked description of M and the potential."""

    place: ClassVar[str]
    """The key of the file that holds it."""

    @property
    def joints(self) -> list[JointEntry]:
        """The joints, base first."""

    @property
    def torques(self) -> PrintedTorques | None:
        """C and g in print, where they are."""

    def numbers(self) -> dict[str, Number]:
        """The numbers of the description, by name."""

    def used(self) -> set[str]:
        """The names of the numbers that enter M or the potential."""

    def build(self, numbers: Mapping[str, Number], parameters: tuple[str, ...]) -> Dynamics:
        """M and the potential, with these values of the numbers and these names as parameters."""


@dataclass(frozen=True)
class ChainPlan:
    """A serial chain of links."""

    place: ClassVar[str] = "links"
    joints: list[JointEntry]
    bodies: list[BodyEntry]
    gravity: tuple[Number, ...]
    torques: None = None

    def numbers(self) -> dict[str, Number]:
        """Masses, lengths and inertias as ``joint_key``, gravity as ``gravity_x`` and so on."""
        result = components("gravity", self.gravity)
        for joint, body in zip(self.joints, self.bodies, strict=True):
            result |= body.numbers(joint.name) | joint.rotors
        return result

    def used(self) -> set[str]:
        """All of them."""
        return set(self.numbers())

    def build(self, numbers: Mapping[str, Number], parameters: tuple[str, ...]) -> Dynamics:
        def entry(name: str) -> Any:
            if name in parameters:
                return ParameterShare(name)
            return numbers[name].value if name in numbers else Fraction(0)

        bodies = zip(self.joints, self.bodies, strict=True)
        links = tuple(_link(joint.name, body, entry) for joint, body in bodies)
        return Chain(links, tuple(entry(f"gravity_{letter}") for letter in "xyz"), parameters)


@dataclass(frozen=True)
class PrintedPlan:
    """M and the potential in print."""

    place: ClassVar[str] = "model"
    joints: list[JointEntry]
    entries: dict[str, Number]
    printed: PrintedTerms
    torques: PrintedTorques | None

    def numbers(self) -> dict[str, Number]:
        return dict(self.entries, **_rotors(self.joints))

    def used(self) -> set[str]:
        return self.printed.names() | set(_rotors(self.joints))

    def build(self, numbers: Mapping[str, Number], parameters: tuple[str, ...]) -> Dynamics:
        n = len(self.joints)
        ring = trig.trig_ring(n, parameters)
        polys = {key: trig.constant(ring, number.value) for key, number in numbers.items()}
        polys |= dict(zip(parameters, ring.gens()[2 * n :], strict=True))
        mass, potential = self.printed.build(ring, polys)
        rotors = [polys.get(f"{joint.name}{ROTOR}", 0) for joint in self.joints]
        whole = tuple(
            tuple(entry + rotors[i] if i == j else entry for j, entry in enumerate(row))
            for i, row in enumerate(mass)
        )
        return Polynomials(whole, potential, parameters)


def _rotors(joints: list[JointEntry]) -> dict[str, Number]:
    return {name: number for joint in joints for name, number in joint.rotors.items()}


def read_plan(top: ArmFields) -> ModelPlan | None:
    """The model of an arm file, ``None`` when it has none that can be built; problems are noted."""
    links, joints = top.tables("links"), top.tables("joints")
    numbers, model, torques = top.table("numbers"), top.table("model"), top.table("printed")
    gravity = top.vector("gravity", "m/s²") if "links" in top.data or "gravity" in top.data else None
    for key in ("joints", "numbers", "model", "printed"):
        if "links" in top.data and key in top.data:
            top.fail(
                key, "does not go together with [[links]]", "keep the links or the printed model, not both"
            )
    if "model" in top.data and "links" not in top.data and "gravity" in top.data:
        top.fail("gravity", "is already inside the printed potential", "remove it")
    if links:
        return _read_chain(top, links, gravity)
    if joints and model:
        return _read_printed(top, joints, numbers, model, torques)
    _note_missing(top)
    return None


def _note_missing(top: ArmFields) -> None:
    if "links" in top.data:
        return
    if "model" not in top.data and "joints" not in top.data:
        top.fail("links", "is missing", "describe the arm by [[links]], or by [model] and [[joints]]")
    for key, form in (("model", "[model]"), ("joints", "[[joints]]")):
        if key not in top.data and ("model" in top.data or "joints" in top.data):
            top.fail(key, "is missing", f"a printed model needs {form} as well")


def _read_chain(
    top: ArmFields, tables: list[ArmFields], gravity: tuple[Number, ...] | None
) -> ModelPlan | None:
    joints, bodies = _read_joints(top, "links", tables), read_bodies(tables)
    _close(tables)
    sound = [body for body in bodies if body is not None]
    return ChainPlan(joints, sound, gravity) if gravity and len(sound) == len(tables) else None


def _read_printed(
    top: ArmFields,
    tables: list[ArmFields],
    numbers: ArmFields | None,
    model: ArmFields,
    torques: ArmFields | None,
) -> ModelPlan:
    joints = _read_joints(top, "joints", tables)
    taken = {name for joint in joints for name in joint.numbers()} | set(_rotors(joints))
    entries = {} if numbers is None else _read_numbers(numbers, taken)
    names = [] if numbers is None else list(numbers.data)
    n = min(len(joints), MOST_PRINTED)
    printed = read_printed(model, n, names)
    compared = None if torques is None else read_torques(torques, n, names)
    _close([*tables, model, *([] if torques is None else [torques])])
    return PrintedPlan(joints, entries, printed, compared)


def _read_joints(top: ArmFields, key: str, tables: list[ArmFields]) -> list[JointEntry]:
    most = MOST_JOINTS if key == "links" else MOST_PRINTED
    if len(tables) > most:
        top.fail(key, f"has more than {most} joints", "give an arm of fewer joints")
    return read_joints(tables)


def _read_numbers(fields: ArmFields, taken: set[str]) -> dict[str, Number]:
    entries = {name: fields.quantity(name, "") for name in fields.data}
    for name in fields.data:
        if not _NAME.fullmatch(name) or is_angle(name):
            rule = "must be letters, digits and underscores, and not look like a sine or cosine (s1, c23)"
            fields.fail(name, rule, "rename it")
        elif name in taken:
            fields.fail(name, "is also the name of a number of a joint", "rename it")
    return {name: number for name, number in entries.items() if number is not None}


def _close(tables: list[ArmFields]) -> None:
    for table in tables:
        table.close()


def _link(name: str, body: BodyEntry, entry: Callable[[str], Any]) -> RigidLink:
    axis = tuple(x.value for x in body.axis)
    if "inertia" in body.inertia:
        own = entry(f"{name}_inertia")
        inertia = tuple(tuple(_times(own, a * b) for b in axis) for a in axis)
    else:
        inertia = tuple(tuple(entry(f"{name}_{key}") for key in row) for row in _TENSOR)
    origin, com = (tuple(entry(f"{name}_{key}_{letter}") for letter in "xyz") for key in ("origin", "com"))
    rotor = entry(f"{name}{ROTOR}")
    return RigidLink(axis, origin, entry(f"{name}_mass"), com, inertia, UNIT, rotor)


def _times(number: Any, factor: Fraction) -> Any:
    """The multiple of an exact number or of a parameter."""
    if isinstance(number, ParameterShare):
        return replace(number, factor=factor) if factor else factor
    return number * factor


_TENSOR = (("ixx", "ixy", "ixz"), ("ixy", "iyy", "iyz"), ("ixz", "iyz", "izz"))
