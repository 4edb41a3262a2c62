"""XML as URDF needs it: elements, attributes and line numbers, and nothing that a hostile file could use.

Document types and entities are refused outright, so that nothing can be expanded or fetched; text between
tags means nothing in URDF and is dropped.
"""

from __future__ import annotations

import re
from dataclasses import dataclass, field
from pathlib import Path
from xml.parsers import expat

from lyapcheck.errors import InputError, Problem
from lyapcheck.files.fields import RETYPE, UNPRINTABLE
from lyapcheck.files.reader import URDF, not_utf8, read_bytes
from lyapcheck.output.escapes import printable

_MOST_ELEMENTS = 100_000
_MOST_DEPTH = 40
_LONGEST = 10_000
_SHOWN = 60
_DECLARATION = re.compile(rb"\A(?:\xef\xbb\xbf)?\s+<\?xml[^>]*>")
"""A declaration after white space, which XML forbids and others read; what it says is not needed."""
_NO_BREAK = re.compile(rb"[^\n]")


@dataclass(frozen=True)
class Element:
    """One tag with its attributes, its children and the line where it starts."""

    tag: str
    attributes: dict[str, str]
    line: int
    children: list[Element] = field(default_factory=list)

    def all(self, tag: str) -> list[Element]:
        """The children with that tag, in order."""
        return [child for child in self.children if child.tag == tag]


def read_xml(path: Path, shown: str) -> Element:
    """The root element of an XML file; ``shown`` is the name of the file in messages.

    Raises:
        InputError: it cannot be read, is too large, not UTF-8, not XML, has a document type or entities, or
            more elements, deeper nesting or longer attributes than any robot needs.
    """
    return parse_xml(read_bytes(path, URDF, shown), shown)


def parse_xml(data: bytes, shown: str) -> Element:
    """The root element of an XML text; see ``read_xml``."""
    try:
        data.decode("utf-8-sig")
    except UnicodeDecodeError:
        raise not_utf8(shown) from None
    try:
        return _Builder(shown).run(_DECLARATION.sub(lambda result: _NO_BREAK.sub(b" ", result[0]), data, 1))
    except expat.ExpatError as error:
        what = expat.ErrorString(error.code)
        raise refused(
            shown, error.lineno, f"is not XML: {what}", "correct the syntax near this line"
        ) from None


class _Builder:
    """Builds the tree while expat walks over the text."""

    def __init__(self, shown: str) -> None:
        self.shown = shown
        self.parser = expat.ParserCreate("utf-8")
        self.parser.StartElementHandler = self._start
        self.parser.EndElementHandler = self._end
        self.parser.StartDoctypeDeclHandler = self._doctype
        self.parser.EntityDeclHandler = self._doctype
        self.open: list[Element] = []
        self.root: Element | None = None
        self.count = 0

    def run(self, data: bytes) -> Element:
        self.parser.Parse(data, True)
        assert self.root is not None
        return self.root

    def _start(self, tag: str, attributes: dict[str, str]) -> None:
        element = Element(tag, attributes, self.parser.CurrentLineNumber)
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
                line = self.parser.CurrentLineNumber
                raise InputError(
                    Problem(self.shown, line, place, printable(text)[:_SHOWN], UNPRINTABLE, RETYPE)
                )
        if self.open:
            self.open[-1].children.append(element)
        else:
            self.root = element
        self.open.append(element)

    def _end(self, tag: str) -> None:
        self.open.pop()

    def _doctype(self, *declared: object) -> None:
        self._refuse("declares a document type or an entity", "remove it: URDF needs neither")

    def _refuse(self, rule: str, repair: str) -> None:
        raise refused(self.shown, self.parser.CurrentLineNumber, rule, repair)


def refused(shown: str, line: int | None, rule: str, repair: str) -> InputError:
    """The error for a file that is of no use as a whole."""
    return InputError(Problem(shown, line, "file", "", rule, repair))
