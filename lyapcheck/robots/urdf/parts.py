"""The links and joints of a URDF file, as read."""

from __future__ import annotations

import re
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from fractions import Fraction
from typing import TypeVar

from lyapcheck.errors import Problem, nearest
from lyapcheck.output.escapes import printable
from lyapcheck.robots.fields import LARGEST
from lyapcheck.robots.urdf.xml import Element

# --- Reading the attributes of URDF elements: exact decimals, and every problem at once.


_DECIMAL = re.compile(r"[+-]?(?:[0-9]+\.?[0-9]*|\.[0-9]+)(?:[eE]([+-]?[0-9]{1,3}))?")
_LONGEST = 60
Triple = tuple[Fraction, Fraction, Fraction]
ORIGIN: Triple = (Fraction(0), Fraction(0), Fraction(0))


class UrdfNotes:
    """Collects the problems of one URDF file."""

    def __init__(self, file: str) -> None:
        self.file = file
        self.problems: list[Problem] = []

    def fail(self, element: Element, key: str, value: str, rule: str, repair: str) -> None:
        """Note one problem at the line of an element."""
        shown = value if len(value) <= _LONGEST else value[: _LONGEST - 3] + "…"
        self.problems.append(Problem(self.file, element.line, key, printable(shown), rule, repair))

    def slips(self, element: Element, place: str, known: Mapping[str, Sequence[str]]) -> None:
        """Note children, and attributes of children, that are spelt nearly like those that URDF knows.

        What is spelt otherwise may stand there: many programs add their own.
        """
        for child in element.children:
            words = [(child.tag, tuple(known))] + [
                (word, known.get(child.tag, ())) for word in child.attributes
            ]
            for word, meant in words:
                repair = "" if word in meant else nearest(word, meant)
                if repair:
                    self.fail(child, f"{place}: {word}", "", "means nothing in URDF", repair)

    def only(self, parent: Element, tag: str, place: str, required: bool = False) -> Element | None:
        """The one child of that tag; more than one is a problem, none only where one is required."""
        result = parent.all(tag)
        if len(result) > 1:
            self.fail(result[1], f"{place}: {tag}", "", "is given more than once", "keep one of them")
        if not result and required:
            self.fail(parent, f"{place}: {tag}", "", "is missing", f"add <{tag} …/>")
        return result[0] if result else None

    def text(self, element: Element, attribute: str, place: str) -> str:
        """A required attribute that is not blank; empty when it is missing."""
        value = element.attributes.get(attribute, "").strip()
        if not value:
            self.fail(element, f"{place}: {attribute}", "", "is missing", f'write {attribute}="…"')
        return value

    def number(
        self, element: Element, attribute: str, place: str, default: Fraction | None = None
    ) -> Fraction:
        """One exact decimal; 0 is the answer when there is a problem."""
        if attribute not in element.attributes and default is not None:
            return default
        text = self.text(element, attribute, place)
        value = self._decimal(element, f"{place}: {attribute}", text) if text else None
        return Fraction(0) if value is None else value

    def triple(
        self, element: Element | None, attribute: str, place: str, default: Triple | None = ORIGIN
    ) -> Triple:
        """Three exact decimals; the default where the element or the attribute is missing."""
        if element is None or (attribute not in element.attributes and default is not None):
            return default or ORIGIN
        text = self.text(element, attribute, place)
        if not text:
            return ORIGIN
        words = text.split()
        if len(words) != 3:
            self.fail(
                element, f"{place}: {attribute}", text, "must be three numbers", f'write {attribute}="0 0 1"'
            )
            return ORIGIN
        x, y, z = (self._decimal(element, f"{place}: {attribute}", word) or Fraction(0) for word in words)
        return x, y, z

    def _decimal(self, element: Element, key: str, text: str) -> Fraction | None:
        value = decimal(text)
        if value is None:
            repair = "run xacro on it first" if "${" in text else "write a plain decimal like 0.091"
            self.fail(element, key, text, "must be a finite decimal number", repair)
        elif abs(value) > LARGEST:
            self.fail(element, key, text, f"must be at most {LARGEST} in size", "use SI units")
            return None
        return value


def decimal(text: str) -> Fraction | None:
    """The exact value of a decimal as URDF writes it (``1``, ``.5``, ``5.``, ``1e-3``), or ``None``."""
    result = _DECIMAL.fullmatch(text) if len(text) <= _LONGEST else None
    return None if result is None else Fraction(text)


MOVING = ("revolute", "continuous")
KINDS = (*MOVING, "fixed", "prismatic", "floating", "planar")
INERTIA = ("ixx", "iyy", "izz", "ixy", "ixz", "iyz")
_LONGEST_NAME = 64
_POSE = ("xyz", "rpy")
_OF_LINK = dict.fromkeys(("inertial", "visual", "collision"), ())
_OF_INERTIAL = {"origin": _POSE, "mass": ("value",), "inertia": INERTIA}
_OF_JOINT = {
    "origin": _POSE,
    "axis": ("xyz",),
    "dynamics": ("damping", "friction"),
    "limit": ("effort", "velocity", "lower", "upper"),
    **dict.fromkeys(("parent", "child", "mimic", "calibration", "safety_controller"), ()),
}
_AXIS: Triple = (Fraction(1), Fraction(0), Fraction(0))
P = TypeVar("P")


@dataclass(frozen=True)
class UrdfLink:
    """A link: mass, and about its centre of mass at ``com`` the inertia in axes turned by ``rpy``."""

    name: str
    element: Element
    mass: Fraction = Fraction(0)
    com: Triple = ORIGIN
    rpy: Triple = ORIGIN
    inertia: tuple[Fraction, ...] = (Fraction(0),) * 6


@dataclass(frozen=True)
class UrdfJoint:
    """A joint: where the child stands in the parent, and what its motor is said to do."""

    name: str
    element: Element
    kind: str
    parent: str
    child: str
    xyz: Triple
    rpy: Triple
    axis: Triple
    damping: Fraction | None
    friction: Fraction | None
    effort: Fraction | None

    @property
    def moves(self) -> bool:
        """Whether anything can move about or along it."""
        return self.kind != "fixed"


def read_parts(root: Element, notes: UrdfNotes) -> tuple[dict[str, UrdfLink], dict[str, UrdfJoint]]:
    """Links and joints by name, in the order of the file; problems are noted."""
    if root.tag != "robot":
        notes.fail(root, f"<{root.tag[:40]}>", "", "is no URDF: its root must be <robot>", "give a URDF file")
        return {}, {}
    if any(child.tag.startswith("xacro:") for child in root.children):
        notes.fail(root, "robot", "", "is a xacro file", "run xacro on it, and give the URDF that it writes")
        return {}, {}
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
    notes.slips(element, place, _OF_LINK)
    inertial = notes.only(element, "inertial", place)
    if inertial is None:
        return UrdfLink(name, element)
    notes.slips(inertial, place, _OF_INERTIAL)
    origin = notes.only(inertial, "origin", place)
    mass = notes.only(inertial, "mass", place, required=True)
    tensor = notes.only(inertial, "inertia", place, required=True)
    value = Fraction(0) if mass is None else notes.number(mass, "value", f"{place}: mass")
    if mass is not None and value < 0:
        notes.fail(
            mass, f"{place}: mass", mass.attributes["value"], "must not be negative", "correct the sign"
        )
    entries = [
        Fraction(0) if tensor is None else notes.number(tensor, key, f"{place}: inertia") for key in INERTIA
    ]
    com, rpy = (notes.triple(origin, key, f"{place}: origin") for key in ("xyz", "rpy"))
    return UrdfLink(name, inertial, value, com, rpy, tuple(entries))


def _read_joint(name: str, element: Element, notes: UrdfNotes) -> UrdfJoint:
    place = f"joint {name}"
    kind = notes.text(element, "type", place)
    if kind and kind not in KINDS:
        notes.fail(
            element, f"{place}: type", kind, "is no joint type of URDF", f"use one of {', '.join(KINDS)}"
        )
    notes.slips(element, place, _OF_JOINT)
    origin = notes.only(element, "origin", place)
    parent, child = (notes.only(element, tag, place, required=True) for tag in ("parent", "child"))
    axis = notes.only(element, "axis", place)
    direction = notes.triple(axis, "xyz", f"{place}: axis", None) if axis is not None else _AXIS
    if kind in MOVING and axis is not None and not any(direction) and "xyz" in axis.attributes:
        notes.fail(axis, f"{place}: axis", axis.attributes["xyz"], "must not be zero", 'write xyz="0 0 1"')
    damping, friction = _dynamics(element, place, notes)
    return UrdfJoint(
        name,
        element,
        kind,
        "" if parent is None else notes.text(parent, "link", f"{place}: parent"),
        "" if child is None else notes.text(child, "link", f"{place}: child"),
        notes.triple(origin, "xyz", f"{place}: origin"),
        notes.triple(origin, "rpy", f"{place}: origin"),
        direction,
        damping,
        friction,
        _effort(element, kind, place, notes),
    )


def _dynamics(element: Element, place: str, notes: UrdfNotes) -> tuple[Fraction | None, Fraction | None]:
    """Viscous and Coulomb friction, ``None`` where nothing is written."""
    dynamics = notes.only(element, "dynamics", place)
    result: list[Fraction | None] = []
    for key in ("damping", "friction"):
        if dynamics is None or key not in dynamics.attributes:
            result.append(None)
            continue
        value = notes.number(dynamics, key, f"{place}: dynamics")
        if value < 0:
            notes.fail(
                dynamics,
                f"{place}: {key}",
                dynamics.attributes[key],
                "must not be negative",
                "correct the sign",
            )
        result.append(value)
    return result[0], result[1]


def _effort(element: Element, kind: str, place: str, notes: UrdfNotes) -> Fraction | None:
    """The torque limit, ``None`` where none is written or it is 0, which URDF files write for unknown."""
    limit = notes.only(element, "limit", place, required=kind == "revolute")
    if limit is None or kind not in MOVING:
        return None
    value = notes.number(limit, "effort", f"{place}: limit")
    if value < 0:
        notes.fail(
            limit, f"{place}: effort", limit.attributes["effort"], "must not be negative", "correct the sign"
        )
    lower, upper = (notes.number(limit, key, f"{place}: limit", Fraction(0)) for key in ("lower", "upper"))
    if lower > upper:
        texts = f"{limit.attributes.get('lower', '0')} > {limit.attributes.get('upper', '0')}"
        notes.fail(limit, f"{place}: limit", texts, "lower is above upper", "exchange them")
    return value or None
