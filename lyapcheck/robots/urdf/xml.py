"""XML as URDF needs it: elements, attributes and line numbers, and nothing that a hostile file could use.

Declarations of a document type are refused, and entities that it could declare elsewhere, so that nothing can
be expanded or fetched. Encodings are those that the file declares, UTF-8 if none.
"""

from __future__ import annotations

import re
from dataclasses import dataclass, field
from xml.parsers import expat

from lyapcheck.errors import InputError, Problem
from lyapcheck.files.fields import RETYPE, UNPRINTABLE
from lyapcheck.output.escapes import printable

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

    @property
    def text(self) -> str:
        """What stands between its tags, which no number of a link or joint does."""
        return "".join(self.texts)

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
    try:
        if encoding.upper() in ("UTF-8", "UTF8"):
            text.decode("utf-16" if text.startswith((b"\xff\xfe", b"\xfe\xff")) else "utf-8")
        return _Builder(shown, text, skipped).run()
    except UnicodeDecodeError:
        repair = "save it as UTF-8, or declare its encoding in <?xml … ?>"
        raise refused(shown, None, "is not UTF-8 text", repair) from None
    except LookupError:
        repair = "save it as UTF-8, and declare that"
        raise refused(shown, 1, f"is in an encoding that is not known, {encoding}", repair) from None
    except expat.ExpatError as error:
        what = expat.ErrorString(error.code)
        rule, repair = f"is not XML: {what}", "correct the syntax near this line"
        raise refused(shown, error.lineno + skipped, rule, repair) from None


class _Builder:
    """Builds the tree while expat walks over the text."""

    def __init__(self, shown: str, text: bytes, skipped: int) -> None:
        self.shown, self.text, self.skipped = shown, text, skipped
        self.parser = expat.ParserCreate()
        self.parser.StartElementHandler = self._start
        self.parser.EndElementHandler = self._end
        self.parser.CharacterDataHandler = self._text
        self.parser.StartDoctypeDeclHandler = self._doctype
        for declared in ("Entity", "Element", "Attlist", "Notation"):
            setattr(self.parser, f"{declared}DeclHandler", self._declared)
        self.open: list[Element] = []
        self.root: Element | None = None
        self.count = 0

    @property
    def line(self) -> int:
        return self.parser.CurrentLineNumber + self.skipped

    def run(self) -> Element:
        self.parser.Parse(self.text, True)
        assert self.root is not None
        return self.root

    def _start(self, tag: str, attributes: dict[str, str]) -> None:
        element = Element(tag, attributes, self.line)
        self.count += 1
        if self.count > _MOST_ELEMENTS:
            self._refuse(f"has more than {_MOST_ELEMENTS} elements", "give one robot only")
        if len(self.open) >= _MOST_DEPTH:
            self._refuse(f"is nested more than {_MOST_DEPTH} deep", "write plain URDF")
        if any(len(text) > _LONGEST for item in attributes.items() for text in item):
            self._refuse(f"has an attribute of more than {_LONGEST} characters", "shorten it")
        for key, text in (("tag", tag), *attributes.items()):
            if not (key + text).isprintable():
                place = f"<{printable(tag)}> {printable(key)}"
                raise InputError(
                    Problem(self.shown, self.line, place, printable(text)[:_SHOWN], UNPRINTABLE, RETYPE)
                )
        if self.open:
            self.open[-1].children.append(element)
        else:
            self.root = element
        self.open.append(element)

    def _end(self, tag: str) -> None:
        self.open.pop()

    def _text(self, text: str) -> None:
        if self.open and len(self.open[-1].texts) < _MOST_DEPTH:
            self.open[-1].texts.append(text[:_SHOWN])

    def _doctype(self, name: str, system: str | None, public: str | None, inside: bool) -> None:
        # what is declared elsewhere is never fetched, and expat drops its entities without a word
        if (system or public) and _ENTITY.search(self.text.replace(b"\0", b"")):
            self._declared()

    def _declared(self, *declared: object) -> None:
        self._refuse("declares a document type or an entity", "remove it: URDF needs neither")

    def _refuse(self, rule: str, repair: str) -> None:
        raise refused(self.shown, self.line, rule, repair)


def refused(shown: str, line: int | None, rule: str, repair: str) -> InputError:
    """The error for a file that is of no use as a whole."""
    return InputError(Problem(shown, line, "file", "", rule, repair))


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
