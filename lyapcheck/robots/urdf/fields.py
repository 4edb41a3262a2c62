"""Reading the attributes of URDF elements: exact decimals, and every problem at once."""

from __future__ import annotations

import re
from collections.abc import Mapping, Sequence
from fractions import Fraction

from lyapcheck.errors import Problem, nearest
from lyapcheck.output.escapes import printable
from lyapcheck.robots.fields import LARGEST
from lyapcheck.robots.urdf.xml import Element

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
