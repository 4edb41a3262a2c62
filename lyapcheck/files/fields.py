"""Reading one table of a file: each getter returns a checked value, or notes what is wrong."""

from __future__ import annotations

import re
from collections.abc import Callable, Sequence
from datetime import date, time
from fractions import Fraction
from hashlib import sha256
from typing import Any, Self
from urllib.parse import quote

from lyapcheck.errors import Problem, near, nearest
from lyapcheck.files.decimals import RANGE, NotFinite, of_physical_size
from lyapcheck.files.toml import KeyPath
from lyapcheck.output.escapes import printable

# --- What text in a file must be, and the repair where it is not.


UNPRINTABLE = "must be one line of text that prints"
"""What a name or note breaks that holds a line end, a control character, or one that turns the writing."""
RETYPE = "type it anew, without what is shown as an escape"


_NUMBER = re.compile(r"[+-]?[0-9._]+([eE][+-]?[0-9]+)?")


class Notes:
    """Collects the problems of one file, so that all of them are reported at once."""

    def __init__(self, file: str, line: Callable[[KeyPath], int | None]) -> None:
        self.file = file
        self.problems: list[Problem] = []
        self.line = line

    def fail(self, path: KeyPath, value: object, rule: str, repair: str) -> None:
        shown = "" if value is None else _shown(value)
        self.problems.append(Problem(self.file, self.line(path), key_text(path), shown, rule, repair))


class Fields:
    """The keys of one table; ``close`` notes those that nobody asked for."""

    def __init__(self, data: dict[str, Any], path: KeyPath, notes: Notes) -> None:
        self.data, self.path, self.notes = data, path, notes
        self._asked: list[str] = []

    def fail(self, key: str, rule: str, repair: str) -> None:
        self.notes.fail((*self.path, key), self.data.get(key), rule, repair)

    def raw(self, key: str, required: bool = False) -> Any:
        self._asked.append(key)
        if required and key not in self.data:
            self.fail(key, "is missing", f"add {key} to this table")
        return self.data.get(key)

    def text(self, key: str, required: bool = False) -> str:
        value = self.raw(key, required)
        if value is None:
            return ""
        if not isinstance(value, str) or not value.strip():
            self.fail(key, "must be a non-empty text", f'write {key} = "…"')
            return ""
        if not value.isprintable():
            self.fail(key, UNPRINTABLE, RETYPE)
            return ""
        return value

    def choice(self, key: str, options: Sequence[str], default: str) -> str:
        value = self.text(key)
        if value and value not in options:
            meant = near(value, options) or default
            self.fail(key, f"must be one of {', '.join(options)}", f'write {key} = "{meant}"')
            return default
        return value or default

    def integer(self, key: str, low: int, high: int, required: bool = False) -> int | None:
        """A whole number between two bounds, ``None`` when absent or bad."""
        value = self.raw(key, required)
        if value is None:
            return None
        if not isinstance(value, int) or isinstance(value, bool) or not low <= value <= high:
            quotes = ", without quotes" if isinstance(value, str) else ""
            whole = isinstance(value, Fraction) and value.denominator == 1 and low <= value <= high
            best = int(value) if whole else low
            self.fail(key, f"must be a whole number from {low} to {high}", f"write {key} = {best}{quotes}")
            return None
        return value

    def number(self, key: str, positive: bool = True) -> Fraction | None:
        value = self.raw(key)
        return None if value is None else self._number((*self.path, key), value, positive)

    def numbers(self, key: str, required: bool = False, positive: bool = True) -> tuple[Fraction, ...] | None:
        """A non-empty list of exact numbers, ``None`` when absent or bad."""
        value = self.raw(key, required)
        if value is None:
            return None
        if not isinstance(value, list) or not value:
            one = _shown(value) if value and _no_number(value) == "" else "1.0"
            repair = f"write {key} = [{one}, {one}] for two joints, and so on"
            self.fail(key, "must be a list of numbers, one a joint", repair)
            return None
        items = [self._number((*self.path, key, i), item, positive) for i, item in enumerate(value)]
        kept = tuple(item for item in items if item is not None)
        return kept if len(kept) == len(items) else None

    def table(self, key: str) -> Self | None:
        value = self.raw(key)
        if value is None:
            return None
        if not isinstance(value, dict):
            self.fail(key, "must be a table", f"write it as [{key_text((*self.path, key))}]")
            return None
        return type(self)(value, (*self.path, key), self.notes)

    def tables(self, key: str, required: bool = False) -> list[Self]:
        value = self.raw(key)
        if value is None:
            if required:
                self.fail(key, "is missing", f"write each entry as [[{key}]]")
            return []
        if not isinstance(value, list) or not value or not all(isinstance(item, dict) for item in value):
            self.fail(key, "must be an array of tables", f"write each entry as [[{key}]]")
            return []
        return [type(self)(item, (*self.path, key, i), self.notes) for i, item in enumerate(value)]

    def close(self) -> None:
        """Note every key of the table that is not known."""
        known = sorted(set(self._asked))
        for key in self.data:
            if key not in known:
                repair = nearest(key, known, f"remove it, or use one of: {', '.join(known)}")
                self.fail(key, "is not a known key here", repair)

    def _number(self, path: KeyPath, value: object, positive: bool) -> Fraction | None:
        rule = _no_number(value)
        if rule or not isinstance(value, int | Fraction):
            self.notes.fail(path, value, rule, "write a plain decimal like 0.223")
            return None
        sign = value.numerator  # comparing fractions takes longer
        if sign < 0 or (positive and sign == 0):
            name = self.data.get("name")
            where = f" in {name}" if isinstance(name, str) else ""
            rule = f"must be positive{where}" if positive else f"must not be negative{where}"
            self.notes.fail(path, value, rule, "correct the sign or the value")
            return None
        return value if isinstance(value, Fraction) else Fraction(value)


def _no_number(value: object) -> str:
    """The rule that a value breaks by not being a number of physical size; empty where it is one."""
    if isinstance(value, bool) or not isinstance(value, int | Fraction):
        return value.rule if isinstance(value, NotFinite) else NotFinite("").rule
    return "" if of_physical_size(value) else RANGE


def key_text(path: KeyPath) -> str:
    """The path as a reader names it, list entries counted from 1: ``gains[2].kp[1]``."""
    text = ""
    for part in path:
        text += f"[{part + 1}]" if isinstance(part, int) else f".{printable(part)}"
    return text.lstrip(".")


def _shown(value: object) -> str:
    try:
        text = printable(value if isinstance(value, str) else _in_toml(value))
    except (
        ValueError,
        OverflowError,
        RecursionError,
    ):  # an integer of thousands of digits, lists a hundred deep
        return "…"
    if isinstance(value, str) and _NUMBER.fullmatch(value):
        return f'"{value}"'  # the quotes are what is wrong with it
    return text if len(text) <= 60 else text[:57] + "…"


def _in_toml(value: object) -> str:
    """A value as a file has it."""
    if isinstance(value, bool):
        return str(value).lower()
    if isinstance(value, str):
        return f'"{value}"'
    if isinstance(value, dict) and value:
        return f"{{ {', '.join(f'{key} = {_in_toml(one)}' for key, one in value.items())} }}"
    if isinstance(value, list):
        return f"[{', '.join(map(_in_toml, value))}]"
    if isinstance(value, Fraction):  # of an option, read before
        return repr(float(value))
    return str(value) if isinstance(value, date | time) else repr(value)


# --- Names of users as names of files.


LONGEST = 100
"""Characters of a file's name that a user's name may take; file systems stop at 255 for the whole."""


def file_stem(name: str) -> str:
    """A name as the start of a file's name, with what some file system refuses escaped as in an address.

    A long name is cut, and set apart from others by the start of its SHA-256.
    """
    stem = quote(name, safe="")
    if stem.startswith("."):
        stem = f"%2E{stem[1:]}"
    return stem if len(stem) <= LONGEST else f"{stem[:LONGEST]}-{sha256(name.encode()).hexdigest()[:12]}"
