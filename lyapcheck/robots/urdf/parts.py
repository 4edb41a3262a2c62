"""The links and joints of a URDF file, as read."""

from __future__ import annotations

import re
from collections.abc import Callable, Mapping
from dataclasses import dataclass
from fractions import Fraction
from typing import TypeVar

from lyapcheck.errors import Problem, nearest
from lyapcheck.output.escapes import printable
from lyapcheck.robots.fields import LARGEST
from lyapcheck.robots.urdf.xml import ATTRIBUTES, CHILDREN, INERTIA, MIRRORED, VERSIONS, Element, Words

# --- Reading the attributes of URDF elements: exact decimals, and every problem at once.


_DECIMAL = re.compile(r"[+-]?(?:[0-9]+\.?[0-9]*|\.[0-9]+)(?:[eE]([+-]?[0-9]{1,3}))?")
_INFINITE = re.compile(r"\+?inf(?:inity)?", re.IGNORECASE)
_LONGEST = 60
_XML = ("xmlns", "xml:", "xsi:")
Triple = tuple[Fraction, Fraction, Fraction]
ORIGIN: Triple = (Fraction(0), Fraction(0), Fraction(0))
_FORMS = {"xyz": '"X Y Z"', "rpy": '"ROLL PITCH YAW" in rad', "quat_xyzw": '"X Y Z W"'}


class UrdfNotes:
    """Collects the problems of one URDF file, and what it says that is not used."""

    def __init__(self, file: str) -> None:
        self.file = file
        self.problems: list[Problem] = []
        self.unused: dict[str, list[str]] = {}
        self.quaternions = False

    def fail(self, element: Element, key: str, value: str, rule: str, repair: str) -> None:
        shown = value if len(value) <= _LONGEST else value[: _LONGEST - 3] + "…"
        self.problems.append(Problem(self.file, element.line, key, printable(shown), rule, repair))

    def words(self, element: Element, place: str) -> None:
        """Look at the attributes of an element and at its children with theirs; see `words`."""
        self._look(element, element.attributes, ATTRIBUTES[element.tag], place)
        self._look(element, {child.tag: "" for child in element.children}, CHILDREN[element.tag], place)
        for child in element.children:
            if child.tag in ATTRIBUTES and child.tag not in CHILDREN:
                self._look(child, child.attributes, ATTRIBUTES[child.tag], place)

    def _look(self, element: Element, given: Mapping[str, str], known: Words, place: str) -> None:
        missing = [word for word in known.read if word not in given]
        for word, value in given.items():
            if word in known.read or word in known.idle or word.startswith(_XML):
                continue
            meant = "" if ":" in word else nearest(word, missing)
            if known.closed:
                rule = f"places or turns something in a way that <{element.tag}> of URDF does not have"
                self.fail(element, f"{place}: {word}", value, rule, meant or f"use {' or '.join(known.read)}")
            elif meant:
                self.fail(element, f"{place}: {word}", "", "means nothing in URDF", meant)
            else:
                self.unused.setdefault(f"{word} of <{element.tag}>", []).append(place)

    def told(self) -> list[str]:
        """What the file says and the arm does not use, as a sentence."""
        words = []
        for word, places in self.unused.items():
            more = f" and {len(places) - 1} more" if len(places) > 1 else ""
            words.append(f"{word} ({places[0]}{more})")
        return [f"Not used, as URDF gives it no meaning: {printable(', '.join(words))}"] if words else []

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

    def number(self, element: Element, attribute: str, place: str) -> Fraction:
        """One exact decimal; 0 is the answer when there is a problem."""
        text = self.text(element, attribute, place)
        value = self._decimal(element, f"{place}: {attribute}", text) if text else None
        return Fraction(0) if value is None else value

    def unsigned(self, element: Element, attribute: str, key: str, place: str) -> Fraction:
        """One exact decimal that is not negative."""
        value = self.number(element, attribute, f"{place}: {element.tag}")
        if value < 0:
            text = element.attributes[attribute]
            self.fail(element, f"{place}: {key}", text, "must not be negative", "correct the sign")
        return value

    def vector(self, element: Element, attribute: str, place: str, count: int = 3) -> tuple[Fraction, ...]:
        """So many exact decimals; zeros when there is a problem."""
        text, nothing = self.text(element, attribute, place), (Fraction(0),) * count
        words = text.split()
        if text and len(words) != count:
            repair = f"write {attribute}={_FORMS[attribute]}"
            rule = f"must be {'three' if count == 3 else 'four'} numbers"
            self.fail(element, f"{place}: {attribute}", text, rule, repair)
        if len(words) != count:
            return nothing
        return tuple(self._decimal(element, f"{place}: {attribute}", word) or Fraction(0) for word in words)

    def pose(self, element: Element | None, place: str) -> tuple[Triple, tuple[Fraction, ...]]:
        """The place of an ``<origin>``, and its turn: three angles, or the four parts of a quaternion.

        As urdfdom and Pinocchio read it: ``quat_xyzw`` from URDF 1.1 on, never beside ``rpy``, of any length.
        """
        given = {} if element is None else element.attributes
        if element is None or not given:
            return ORIGIN, ORIGIN
        place = f"{place}: origin"
        x, y, z = self.vector(element, "xyz", place) if "xyz" in given else ORIGIN
        turn: tuple[Fraction, ...] = self.vector(element, "rpy", place) if "rpy" in given else ORIGIN
        if "quat_xyzw" in given:
            before = len(self.problems)
            turn = self.vector(element, "quat_xyzw", place, 4)
            key, value = f"{place}: quat_xyzw", given["quat_xyzw"]
            if "rpy" in given:
                self.fail(element, key, value, "turns what rpy turns, too", "keep one of them")
            elif not self.quaternions:
                rule = "turns something from URDF 1.1 on, and this file is of version 1.0"
                self.fail(element, key, value, rule, 'write <robot version="1.1" …>, or rpy')
            elif not any(turn) and len(self.problems) == before:
                self.fail(element, key, value, "must not be zero", 'write quat_xyzw="0 0 0 1" for no turn')
        return (x, y, z), turn

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
_LONGEST_NAME = 64
_AXIS: Triple = (Fraction(1), Fraction(0), Fraction(0))
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
    return UrdfLink(name, inertial, value, com, turn, _inertia(tensor, place, notes))


def _inertia(tensor: Element | None, place: str, notes: UrdfNotes) -> tuple[Fraction, ...]:
    if tensor is None:
        return (Fraction(0),) * 6
    entries = {key: notes.number(tensor, key, f"{place}: inertia") for key in INERTIA}
    for key, other in MIRRORED.items():
        if key in tensor.attributes and notes.number(tensor, key, f"{place}: inertia") != entries[other]:
            value, rule = tensor.attributes[key], f"differs from {other}: no inertia has that"
            notes.fail(tensor, f"{place}: inertia: {key}", value, rule, "remove one of them")
    return tuple(entries.values())


def _read_joint(name: str, element: Element, notes: UrdfNotes) -> UrdfJoint:
    place = f"joint {name}"
    kind = notes.text(element, "type", place)
    if kind and kind not in KINDS:
        notes.fail(
            element, f"{place}: type", kind, "is no joint type of URDF", f"use one of {', '.join(KINDS)}"
        )
    notes.words(element, place)
    xyz, turn = notes.pose(notes.only(element, "origin", place), place)
    parent, child = (notes.only(element, tag, place, required=True) for tag in ("parent", "child"))
    axis, direction = notes.only(element, "axis", place), _AXIS
    if axis is not None:
        x, y, z = notes.vector(axis, "xyz", f"{place}: axis")
        direction = x, y, z
        if kind in (*MOVING, "prismatic") and not any(direction) and "xyz" in axis.attributes:
            text = axis.attributes["xyz"]
            notes.fail(axis, f"{place}: axis", text, "must not be zero", 'write xyz="0 0 1"')
    damping, friction = _dynamics(element, place, notes)
    return UrdfJoint(
        name,
        element,
        kind,
        "" if parent is None else notes.text(parent, "link", f"{place}: parent"),
        "" if child is None else notes.text(child, "link", f"{place}: child"),
        xyz,
        turn,
        direction,
        damping,
        friction,
        _effort(element, kind, place, notes),
    )


def _dynamics(element: Element, place: str, notes: UrdfNotes) -> tuple[Fraction | None, Fraction | None]:
    """Viscous and Coulomb friction, ``None`` where nothing is written."""
    dynamics = notes.only(element, "dynamics", place)
    given = {} if dynamics is None else dynamics.attributes
    damping, friction = (
        None if dynamics is None or key not in given else notes.unsigned(dynamics, key, key, place)
        for key in ("damping", "friction")
    )
    return damping, friction


def _effort(element: Element, kind: str, place: str, notes: UrdfNotes) -> Fraction | None:
    """The torque limit, ``None`` where the file knows none: nothing, 0 or a number without bounds."""
    limit = notes.only(element, "limit", place, required=kind == "revolute")
    if limit is None or kind not in MOVING:
        return None
    lower, upper = (_end(limit, key, place, notes) for key in ("lower", "upper"))
    if lower is not None and upper is not None and lower > upper:
        texts = f"{limit.attributes.get('lower', '0')} > {limit.attributes.get('upper', '0')}"
        notes.fail(limit, f"{place}: limit", texts, "lower is above upper", "exchange them")
    if kind == "continuous" and "effort" not in limit.attributes:
        return None
    if _unbounded(limit.attributes.get("effort", "")):
        return None
    return notes.unsigned(limit, "effort", "effort", place) or None


def _end(limit: Element, key: str, place: str, notes: UrdfNotes) -> Fraction | None:
    """An end of the range of a joint, 0 where none is written, ``None`` for an infinite one."""
    text = limit.attributes.get(key)
    if text is None:
        return Fraction(0)
    return None if _unbounded(text.strip().lstrip("-")) else notes.number(limit, key, f"{place}: limit")


def _unbounded(text: str) -> bool:
    """Whether a limit is infinite, or larger than any quantity of an arm, by which files say the same."""
    value = decimal(text.strip())
    return bool(_INFINITE.fullmatch(text.strip())) or (value is not None and value > LARGEST)
