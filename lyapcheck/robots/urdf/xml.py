"""XML as URDF needs it: elements, attributes and line numbers, and what each word means to an arm.

Nothing is read that a hostile file could use. Declarations of a document type are refused, and entities that
it could declare elsewhere, so that nothing can be expanded or fetched. Encodings are those that the file
declares, UTF-8 if none.
"""

from __future__ import annotations

import re
from collections.abc import Mapping
from dataclasses import dataclass, field
from fractions import Fraction
from xml.parsers import expat

from lyapcheck.errors import InputError, Problem, nearest
from lyapcheck.files.fields import RETYPE, UNPRINTABLE
from lyapcheck.output.escapes import printable
from lyapcheck.robots.fields import LARGEST, decimal

_MOST_ELEMENTS = 100_000
_MOST_DEPTH = 40
_LONGEST = 10_000
_SHOWN = 60
_DECLARED = re.compile(rb"\A\s*<\?xml[^>]*encoding\s*=\s*[\"']([A-Za-z0-9._-]+)")
_ENTITY = re.compile(rb"&(?!(?:lt|gt|amp|quot|apos|#[0-9a-fA-Fx]+);)")


@dataclass(frozen=True)
class Element:
    """One tag with its attributes, its children and the line where it starts."""

    tag: str
    attributes: dict[str, str]
    line: int
    children: list[Element] = field(default_factory=list)
    texts: list[str] = field(default_factory=list)

    def all(self, tag: str) -> list[Element]:
        return [child for child in self.children if child.tag == tag]


def parse_xml(data: bytes, shown: str) -> Element:
    """The root element of an XML text; ``shown`` is the name of its file in messages.

    Raises:
        InputError: it is not in its encoding, not XML, declares a document type, or has more elements, deeper
            nesting or longer attributes than any robot needs.
    """
    # a declaration after white space, which XML forbids and others read
    text = data.removeprefix(b"\xef\xbb\xbf").lstrip()
    skipped = data.count(b"\n", 0, len(data) - len(text))
    declared = _DECLARED.match(text)
    encoding = declared[1].decode() if declared else "UTF-8"

    def refused(line: int | None, rule: str, repair: str) -> InputError:
        return InputError(Problem(shown, line, "file", "", rule, repair))

    try:
        if encoding.upper() in ("UTF-8", "UTF8"):
            text.decode("utf-16" if text.startswith((b"\xff\xfe", b"\xfe\xff")) else "utf-8")
        builder = _Builder(shown, text, skipped)
        builder.parser.Parse(text, True)
    except UnicodeDecodeError:
        repair = "save it as UTF-8, or declare its encoding in <?xml … ?>"
        raise refused(None, "is not UTF-8 text", repair) from None
    except LookupError:
        repair = "save it as UTF-8, and declare that"
        raise refused(1, f"is in an encoding that is not known, {encoding}", repair) from None
    except expat.ExpatError as error:
        rule, repair = f"is not XML: {expat.ErrorString(error.code)}", "correct the syntax near this line"
        raise refused(error.lineno + skipped, rule, repair) from None
    return builder.roots[0]


class _Builder:
    """Builds the tree while expat walks over the text."""

    def __init__(self, shown: str, text: bytes, skipped: int) -> None:
        self.shown, self.text, self.skipped = shown, text, skipped
        self.parser = expat.ParserCreate()
        self.parser.StartElementHandler = self._start
        self.parser.EndElementHandler = lambda _: self.open.pop()
        self.parser.CharacterDataHandler = self._text
        self.parser.StartDoctypeDeclHandler = self._doctype
        for declared in ("Entity", "Element", "Attlist", "Notation"):
            setattr(self.parser, f"{declared}DeclHandler", self._declared)
        self.open: list[Element] = []
        self.roots: list[Element] = []
        self.count = 0

    def _start(self, tag: str, attributes: dict[str, str]) -> None:
        self.count += 1
        for refused, rule, repair in (
            (self.count > _MOST_ELEMENTS, f"has more than {_MOST_ELEMENTS} elements", "give one robot only"),
            (len(self.open) >= _MOST_DEPTH, f"is nested more than {_MOST_DEPTH} deep", "write plain URDF"),
            (
                any(len(text) > _LONGEST for item in attributes.items() for text in item),
                f"has an attribute of more than {_LONGEST} characters",
                "shorten it",
            ),
        ):
            if refused:
                self._refuse("file", "", rule, repair)
        for key, text in (("tag", tag), *attributes.items()):
            if not (key + text).isprintable():
                place = f"<{printable(tag)}> {printable(key)}"
                self._refuse(place, printable(text)[:_SHOWN], UNPRINTABLE, RETYPE)
        element = Element(tag, attributes, self.parser.CurrentLineNumber + self.skipped)
        (self.open[-1].children if self.open else self.roots).append(element)
        self.open.append(element)

    def _text(self, text: str) -> None:
        if self.open and len(self.open[-1].texts) < _MOST_DEPTH:
            self.open[-1].texts.append(text[:_SHOWN])

    def _doctype(self, name: str, system: str | None, public: str | None, inside: bool) -> None:
        # what is declared elsewhere is never fetched, and expat drops its entities without a word
        if (system or public) and _ENTITY.search(self.text.replace(b"\0", b"")):
            self._declared()

    def _declared(self, *declared: object) -> None:
        self._refuse("file", "", "declares a document type or an entity", "remove it: URDF needs neither")

    def _refuse(self, key: str, value: str, rule: str, repair: str) -> None:
        line = self.parser.CurrentLineNumber + self.skipped
        raise InputError(Problem(self.shown, line, key, value, rule, repair))


# --- Which words an arm is made of, which have no influence on it, and which are told.
#
# Whatever is neither read nor known to be without influence on M, C, g, friction and limits is told as not
# used; where it would place or turn something, the file is refused.


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


# --- Reading the attributes of URDF elements: exact decimals, and every problem at once.


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
        shown = value if len(value) <= _SHOWN else value[: _SHOWN - 3] + "…"
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
        text = self.text(element, attribute, place)
        words = text.split()
        if len(words) != count:
            if text:
                rule, repair = f"must be {'three' if count == 3 else 'four'} numbers", _FORMS[attribute]
                self.fail(element, f"{place}: {attribute}", text, rule, f"write {attribute}={repair}")
            return (Fraction(0),) * count
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
