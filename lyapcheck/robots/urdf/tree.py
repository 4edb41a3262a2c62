"""The links and joints of a URDF file as read, and the tree that they are."""

from __future__ import annotations

import re
from collections.abc import Callable
from dataclasses import dataclass
from fractions import Fraction
from functools import cached_property
from typing import TypeVar

from lyapcheck.errors import nearest
from lyapcheck.robots.fields import LARGEST, decimal
from lyapcheck.robots.urdf.xml import INERTIA, MIRRORED, ORIGIN, VERSIONS, Element, Triple, UrdfNotes

MOVING = ("revolute", "continuous")
KINDS = (*MOVING, "fixed", "prismatic", "floating", "planar")
SHOWN = 8
"""So many names of one sentence."""
_LONGEST_NAME = 64
_INFINITE = re.compile(r"\+?inf(?:inity)?", re.IGNORECASE)
P = TypeVar("P")


@dataclass(frozen=True)
class UrdfLink:
    """A link: mass, and about its centre of mass at ``com`` the inertia in axes turned by ``turn``."""

    name: str
    element: Element
    mass: Fraction = Fraction(0)
    com: Triple = ORIGIN
    turn: tuple[Fraction, ...] = ORIGIN
    inertia: tuple[Fraction, ...] = (Fraction(0),) * 6

    @property
    def described(self) -> bool:
        return self.element.tag == "inertial"

    @property
    def tensor(self) -> list[list[Fraction]]:
        """The inertia as the file gives it."""
        xx, yy, zz, xy, xz, yz = self.inertia
        return [[xx, xy, xz], [xy, yy, yz], [xz, yz, zz]]


@dataclass(frozen=True)
class UrdfJoint:
    """A joint: where the child stands in the parent, and what its motor is said to do."""

    name: str
    element: Element
    kind: str
    parent: str
    child: str
    xyz: Triple
    turn: tuple[Fraction, ...]
    axis: Triple
    damping: Fraction | None
    friction: Fraction | None
    effort: Fraction | None

    @property
    def moves(self) -> bool:
        """Whether anything can move about or along it."""
        return self.kind != "fixed"

    @property
    def turns(self) -> bool:
        """Whether it may be a joint of an arm: revolute, with a motor of its own."""
        return self.kind in MOVING and not self.element.all("mimic")


def read_parts(root: Element, notes: UrdfNotes) -> tuple[dict[str, UrdfLink], dict[str, UrdfJoint]]:
    """Links and joints by name, in the order of the file; problems are noted."""
    version = root.attributes.get("version", "1.0").strip()
    if version not in VERSIONS:
        rule = "is a version of URDF that is not known: what it means may differ"
        notes.fail(root, "robot: version", version, rule, f"use one of {', '.join(VERSIONS)}")
    notes.quaternions = VERSIONS.get(version, True)
    notes.words(root, f"robot {root.attributes.get('name', '')}".strip())
    links = _named(root.all("link"), "link", _read_link, notes)
    if not links:
        notes.fail(root, "robot", "", "has no link", 'add <link name="base"/>')
    return links, _named(root.all("joint"), "joint", _read_joint, notes)


def _named(
    elements: list[Element], tag: str, read: Callable[[str, Element, UrdfNotes], P], notes: UrdfNotes
) -> dict[str, P]:
    parts: dict[str, P] = {}
    for element in elements:
        name = notes.text(element, "name", tag)
        if name in parts:
            notes.fail(element, f"{tag} name", name, f"is used by another {tag}", f"give each {tag} its own")
        elif len(name) > _LONGEST_NAME or not name.isprintable():
            rule = f"must be at most {_LONGEST_NAME} printable characters"
            notes.fail(element, f"{tag} name", name, rule, "shorten it")
        elif name:
            parts[name] = read(name, element, notes)
    return parts


def _read_link(name: str, element: Element, notes: UrdfNotes) -> UrdfLink:
    place = f"link {name}"
    notes.words(element, place)
    inertial = notes.only(element, "inertial", place)
    if inertial is None:
        return UrdfLink(name, element)
    notes.words(inertial, place)
    origin = notes.only(inertial, "origin", place)
    mass = notes.only(inertial, "mass", place, required=True)
    tensor = notes.only(inertial, "inertia", place, required=True)
    value = Fraction(0) if mass is None else notes.unsigned(mass, "value", "mass", place)
    com, turn = notes.pose(origin, place)
    if tensor is None:
        return UrdfLink(name, inertial, value, com, turn)
    entries = {key: notes.number(tensor, key, f"{place}: inertia") for key in INERTIA}
    for key, other in MIRRORED.items():
        if key in tensor.attributes and notes.number(tensor, key, f"{place}: inertia") != entries[other]:
            text, rule = tensor.attributes[key], f"differs from {other}: no inertia has that"
            notes.fail(tensor, f"{place}: inertia: {key}", text, rule, "remove one of them")
    return UrdfLink(name, inertial, value, com, turn, tuple(entries.values()))


def _read_joint(name: str, element: Element, notes: UrdfNotes) -> UrdfJoint:
    place = f"joint {name}"
    kind = notes.text(element, "type", place)
    if kind and kind not in KINDS:
        notes.fail(
            element, f"{place}: type", kind, "is no joint type of URDF", f"use one of {', '.join(KINDS)}"
        )
    notes.words(element, place)
    xyz, turn = notes.pose(notes.only(element, "origin", place), place)
    ends = ((tag, notes.only(element, tag, place, required=True)) for tag in ("parent", "child"))
    parent, child = (
        "" if end is None else notes.text(end, "link", f"{place}: {tag}") for tag, end in [*ends]
    )
    axis, direction = notes.only(element, "axis", place), (Fraction(1), Fraction(0), Fraction(0))
    if axis is not None:
        x, y, z = notes.vector(axis, "xyz", f"{place}: axis")
        direction = x, y, z
        if kind in (*MOVING, "prismatic") and not any(direction) and "xyz" in axis.attributes:
            text = axis.attributes["xyz"]
            notes.fail(axis, f"{place}: axis", text, "must not be zero", 'write xyz="0 0 1"')
    dynamics = notes.only(element, "dynamics", place)
    damping, friction = (
        None
        if dynamics is None or key not in dynamics.attributes
        else notes.unsigned(dynamics, key, key, place)
        for key in ("damping", "friction")
    )
    effort = _effort(element, kind, place, notes)
    return UrdfJoint(name, element, kind, parent, child, xyz, turn, direction, damping, friction, effort)


def _effort(element: Element, kind: str, place: str, notes: UrdfNotes) -> Fraction | None:
    """The torque limit, ``None`` where the file knows none: nothing, 0 or a number without bounds."""
    limit = notes.only(element, "limit", place, required=kind == "revolute")
    if limit is None or kind not in MOVING:
        return None
    ends = {key: limit.attributes.get(key, "0") for key in ("lower", "upper")}
    lower, upper = (
        None
        if _unbounded(text.strip().lstrip("-"))
        else notes.number(limit, key, f"{place}: limit")
        if key in limit.attributes
        else Fraction(0)
        for key, text in ends.items()
    )
    if lower is not None and upper is not None and lower > upper:
        texts = " > ".join(ends.values())
        notes.fail(limit, f"{place}: limit", texts, "lower is above upper", "exchange them")
    if kind == "continuous" and "effort" not in limit.attributes:
        return None
    if _unbounded(limit.attributes.get("effort", "")):
        return None
    return notes.unsigned(limit, "effort", "effort", place) or None


def _unbounded(text: str) -> bool:
    """Whether a limit is infinite, or larger than any quantity of an arm, by which files say the same."""
    value = decimal(text.strip())
    return bool(_INFINITE.fullmatch(text.strip())) or (value is not None and value > LARGEST)


# --- The tree of links and joints.


@dataclass(frozen=True)
class Tree:
    """Links and joints that form one tree; ``above`` is the joint that each link but the root hangs on."""

    root: str
    links: dict[str, UrdfLink]
    joints: dict[str, UrdfJoint]
    above: dict[str, UrdfJoint]

    def path(self, link: str) -> list[UrdfJoint]:
        result: list[UrdfJoint] = []
        while link != self.root:
            result.append(self.above[link])
            link = self.above[link].parent
        return result[::-1]

    @cached_property
    def below(self) -> dict[str, list[UrdfJoint]]:
        result: dict[str, list[UrdfJoint]] = {}
        for joint in self.joints.values():
            result.setdefault(joint.parent, []).append(joint)
        return result

    def downwards(self) -> list[UrdfJoint]:
        """All joints, each after the one above it."""
        result, waiting = [], [self.root]
        while waiting:
            here = self.below.get(waiting.pop(), [])
            result += here
            waiting += [joint.child for joint in here]
        return result


def build_tree(
    links: dict[str, UrdfLink], joints: dict[str, UrdfJoint], robot: Element, notes: UrdfNotes
) -> Tree | None:
    """The tree, ``None`` where the joints do not make one; problems are noted."""
    before = len(notes.problems)
    above: dict[str, UrdfJoint] = {}
    for joint in joints.values():
        for key, link in (("parent", joint.parent), ("child", joint.child)):
            if link not in links:
                repair, rule = nearest(link, links, "name a link of this file"), "is no link of this file"
                notes.fail(joint.element, f"joint {joint.name}: {key}", link, rule, repair)
        if joint.child in above:
            rule = f"already hangs on joint {above[joint.child].name}: closed chains are not understood"
            key = f"joint {joint.name}: child"
            notes.fail(joint.element, key, joint.child, rule, "remove one of the joints")
        above.setdefault(joint.child, joint)
    roots = [link for link in links if link not in above]
    if len(notes.problems) == before and len(roots) != 1:
        names = ", ".join(roots[:SHOWN])
        rule = f"has {len(roots)} links that hang on no joint: {names}" if roots else "has joints in a circle"
        notes.fail(robot, "robot", "", rule, "connect all links to one tree")
    if len(notes.problems) > before:
        return None
    tree = Tree(roots[0], links, joints, above)
    reached = {tree.root, *(joint.child for joint in tree.downwards())}
    lost = [link for link in links if link not in reached]
    if lost:
        rule = f"has joints in a circle: {', '.join(lost[:SHOWN])} cannot be reached from {tree.root}"
        notes.fail(robot, "robot", "", rule, "connect all links to one tree")
    return None if lost else tree


def moved_links(tree: Tree, chain: tuple[UrdfJoint, ...]) -> list[list[UrdfLink]]:
    """The links of each body that the chain moves, base first; those of the base do not matter."""
    numbers = {joint.name: i for i, joint in enumerate(chain)}
    moved_by: dict[str, int | None] = {tree.root: None}
    for joint in tree.downwards():
        moved_by[joint.child] = numbers.get(joint.name, moved_by[joint.parent])
    return [[link for link in tree.links.values() if moved_by[link.name] == i] for i in range(len(chain))]
