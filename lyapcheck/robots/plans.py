"""The two ways in which an arm file gives its model: links to derive it from, or the printed polynomials."""

from __future__ import annotations

import re
from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any, ClassVar, Protocol

from flint import fmpq_mpoly, fmpq_mpoly_ctx

from lyapcheck.robots import trig
from lyapcheck.robots.bodies import Body, components, read_bodies
from lyapcheck.robots.chain import Chain, exact_chain
from lyapcheck.robots.chain_bounds import ChainBounds, chain_bounds
from lyapcheck.robots.fields import ArmFields
from lyapcheck.robots.joints import Joint, read_joints
from lyapcheck.robots.links import Link, chain
from lyapcheck.robots.number import Number
from lyapcheck.robots.printed import Printed, is_angle, read_printed
from lyapcheck.robots.printed_torques import PrintedTorques, read_torques

_MOST_JOINTS = 9
_NAME = re.compile(r"[A-Za-z][A-Za-z0-9_]{0,40}")
Dynamics = tuple[tuple[tuple[fmpq_mpoly, ...], ...], fmpq_mpoly]


class Plan(Protocol):
    """A checked description of M and the potential."""

    place: ClassVar[str]
    """The key of the file that holds it."""

    @property
    def joints(self) -> list[Joint]:
        """The joints, base first."""

    @property
    def torques(self) -> PrintedTorques | None:
        """C and g in print, where they are."""

    def numbers(self) -> dict[str, Number]:
        """The numbers of the description, by name."""

    def used(self) -> set[str]:
        """The names of the numbers that enter M or the potential."""

    def build(self, ring: fmpq_mpoly_ctx, numbers: Mapping[str, fmpq_mpoly]) -> Dynamics:
        """M and the potential, with the given polynomials for the numbers."""

    def bounds(self, ring: fmpq_mpoly_ctx, numbers: Mapping[str, fmpq_mpoly]) -> ChainBounds | None:
        """What masses and distances say of M and gravity, where they are known."""

    def exact(self, ring: fmpq_mpoly_ctx, numbers: Mapping[str, fmpq_mpoly]) -> Chain | None:
        """The links in plain numbers, where they are known and exact."""


@dataclass(frozen=True)
class ChainPlan:
    """A serial chain of links."""

    place: ClassVar[str] = "links"
    joints: list[Joint]
    bodies: list[Body]
    gravity: tuple[Number, ...]
    torques: None = None

    def numbers(self) -> dict[str, Number]:
        """Masses, lengths and inertias as ``joint_key``, gravity as ``gravity_x`` and so on."""
        found = components("gravity", self.gravity)
        for joint, body in zip(self.joints, self.bodies, strict=True):
            found |= body.numbers(joint.name)
        return found

    def used(self) -> set[str]:
        """All of them."""
        return set(self.numbers())

    def build(self, ring: fmpq_mpoly_ctx, numbers: Mapping[str, fmpq_mpoly]) -> Dynamics:
        """M and the potential of the chain."""
        return chain(ring, self._links(ring, numbers), self._gravity(ring, numbers))

    def bounds(self, ring: fmpq_mpoly_ctx, numbers: Mapping[str, fmpq_mpoly]) -> ChainBounds | None:
        """The bounds of the links."""
        return chain_bounds(self._links(ring, numbers), self._gravity(ring, numbers))

    def exact(self, ring: fmpq_mpoly_ctx, numbers: Mapping[str, fmpq_mpoly]) -> Chain | None:
        """The links."""
        return exact_chain(self._links(ring, numbers), self._gravity(ring, numbers))

    def _gravity(self, ring: fmpq_mpoly_ctx, numbers: Mapping[str, fmpq_mpoly]) -> list[fmpq_mpoly]:
        zero = trig.constant(ring, 0)
        return [numbers.get(f"gravity_{letter}", zero) for letter in "xyz"]

    def _links(self, ring: fmpq_mpoly_ctx, numbers: Mapping[str, fmpq_mpoly]) -> list[Link]:
        bodies = zip(self.joints, self.bodies, strict=True)
        return [_link(ring, joint.name, body, numbers) for joint, body in bodies]


@dataclass(frozen=True)
class PrintedPlan:
    """M and the potential in print."""

    place: ClassVar[str] = "model"
    joints: list[Joint]
    entries: dict[str, Number]
    printed: Printed
    torques: PrintedTorques | None

    def numbers(self) -> dict[str, Number]:
        """The entries of ``[numbers]``."""
        return dict(self.entries)

    def used(self) -> set[str]:
        """Those that occur in a term."""
        return self.printed.names()

    def build(self, ring: fmpq_mpoly_ctx, numbers: Mapping[str, fmpq_mpoly]) -> Dynamics:
        """M and the potential as printed."""
        return self.printed.build(ring, numbers)

    def bounds(self, ring: fmpq_mpoly_ctx, numbers: Mapping[str, fmpq_mpoly]) -> ChainBounds | None:
        """None: what is printed need not come from bodies."""
        return None

    def exact(self, ring: fmpq_mpoly_ctx, numbers: Mapping[str, fmpq_mpoly]) -> Chain | None:
        """None."""
        return None


def read_plan(top: ArmFields) -> Plan | None:
    """The model of an arm file, ``None`` when it has none that can be built; problems are noted."""
    links, joints = top.tables("links"), top.tables("joints")
    numbers, model, torques = top.table("numbers"), top.table("model"), top.table("printed")
    gravity = top.vector("gravity", "m/s²") if "links" in top.data or "gravity" in top.data else None
    for key in ("joints", "numbers", "model", "printed"):
        if "links" in top.data and key in top.data:
            top.fail(
                key, "does not go together with [[links]]", "keep the links or the printed model, not both"
            )
    if "links" not in top.data and "gravity" in top.data:
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


def _read_chain(top: ArmFields, tables: list[ArmFields], gravity: tuple[Number, ...] | None) -> Plan | None:
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
) -> Plan:
    joints = _read_joints(top, "joints", tables)
    taken = {name for joint in joints for name in joint.numbers()}
    entries = {} if numbers is None else _read_numbers(numbers, taken)
    names = [] if numbers is None else list(numbers.data)
    n = min(len(joints), _MOST_JOINTS)
    printed = read_printed(model, n, names)
    compared = None if torques is None else read_torques(torques, n, names)
    _close([*tables, model, *([] if torques is None else [torques])])
    return PrintedPlan(joints, entries, printed, compared)


def _read_joints(top: ArmFields, key: str, tables: list[ArmFields]) -> list[Joint]:
    if len(tables) > _MOST_JOINTS:
        top.fail(key, f"has more than {_MOST_JOINTS} joints", "give an arm of fewer joints")
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


def _link(ring: fmpq_mpoly_ctx, name: str, body: Body, numbers: Mapping[str, fmpq_mpoly]) -> Link:
    axis = [trig.constant(ring, x.value) for x in body.axis]
    zero = trig.constant(ring, 0)

    def entry(key: str) -> Any:
        return numbers.get(f"{name}_{key}", zero)

    if "inertia" in body.inertia:
        inertia = [[entry("inertia") * a * b for b in axis] for a in axis]
    else:
        inertia = [[entry(key) for key in row] for row in _TENSOR]
    origin, com = ([entry(f"{key}_{letter}") for letter in "xyz"] for key in ("origin", "com"))
    return Link(axis, origin, entry("mass"), com, inertia)


_TENSOR = (("ixx", "ixy", "ixz"), ("ixy", "iyy", "iyz"), ("ixz", "iyz", "izz"))
