"""Reading one table of an arm file: each getter returns a checked value or notes what is wrong with it."""

from __future__ import annotations

from collections.abc import Callable
from enum import Enum
from fractions import Fraction
from typing import Any

from lyapcheck.errors import Problem
from lyapcheck.robots.number import Number, decimal_text

KeyPath = tuple[str | int, ...]


class Sign(Enum):
    """Which values a number may have over its whole range."""

    ANY = "any number"
    NONNEGATIVE = "zero or positive"
    POSITIVE = "positive"

    def allows(self, low: Fraction) -> bool:
        """Whether a number whose smallest value is ``low`` is of this sign."""
        return self is Sign.ANY or low > 0 or (self is Sign.NONNEGATIVE and low == 0)


class Notes:
    """Collects the problems of one file, so that all of them are told at once."""

    def __init__(self, file: str, line: Callable[[KeyPath], int | None]) -> None:
        self.file = file
        self.problems: list[Problem] = []
        self._line = line

    def fail(self, path: KeyPath, value: object, rule: str, repair: str) -> None:
        """Note one problem at a key."""
        shown = "" if value is None else _shown(value)
        self.problems.append(Problem(self.file, self._line(path), _key(path), shown, rule, repair))


class Fields:
    """The keys of one table; ``close`` notes those that nobody asked for."""

    def __init__(self, data: dict[str, Any], path: KeyPath, notes: Notes, source: str = "") -> None:
        self.data, self.path, self.notes, self.source = data, path, notes, source
        self._asked: list[str] = []

    def fail(self, key: str, rule: str, repair: str) -> None:
        """Note a problem with one key of this table."""
        self.notes.fail((*self.path, key), self.data.get(key), rule, repair)

    def raw(self, key: str, required: bool = False) -> Any:
        """The value as read, ``None`` when absent."""
        self._asked.append(key)
        if required and key not in self.data:
            self.fail(key, "is missing", f"add {key} to this table")
        return self.data.get(key)

    def text(self, key: str, required: bool = False) -> str:
        """A string, empty when absent."""
        value = self.raw(key, required)
        if value is None:
            return ""
        if not isinstance(value, str) or not value.strip():
            self.fail(key, "must be a non-empty text", f'write {key} = "…"')
            return ""
        return value

    def texts(self, key: str) -> tuple[str, ...]:
        """A list of strings, empty when absent."""
        value = self.raw(key)
        if value is None:
            return ()
        if not isinstance(value, list) or not all(isinstance(item, str) for item in value):
            self.fail(key, "must be a list of texts", f'write {key} = ["…", "…"]')
            return ()
        return tuple(value)

    def count(self, key: str) -> int | None:
        """A positive integer, ``None`` when absent."""
        value = self.raw(key)
        if value is None:
            return None
        if not isinstance(value, int) or isinstance(value, bool) or value < 1:
            self.fail(key, "must be a positive integer", f"write {key} as a whole number of counts per turn")
            return None
        return value

    def number(self, key: str, unit: str, sign: Sign = Sign.ANY, required: bool = False) -> Number | None:
        """A decimal, or a table of a value with its provenance; ``None`` when absent or bad."""
        value = self.raw(key, required)
        number = None if value is None else self._number((*self.path, key), value, unit)
        if number is not None and not sign.allows(number.bounds[0]):
            self.fail(key, f"must be {sign.value}", "correct the value, or the low end of its range")
            return None
        return number

    def vector(self, key: str, unit: str, length: int = 3) -> list[Number] | None:
        """A list of numbers of that length, required; ``None`` when bad."""
        value = self.raw(key, required=True)
        if value is None:
            return None
        if not isinstance(value, list) or len(value) != length:
            self.fail(
                key, f"must be a list of {length} numbers", f"write {key} = [{', '.join(['0'] * length)}]"
            )
            return None
        items = [self._number((*self.path, key, i), item, unit) for i, item in enumerate(value)]
        return [item for item in items if item is not None] if None not in items else None

    def table(self, key: str) -> Fields | None:
        """A table, ``None`` when absent or bad."""
        value = self.raw(key)
        if value is None:
            return None
        if not isinstance(value, dict):
            self.fail(key, "must be a table", f"write it as [{_key((*self.path, key))}]")
            return None
        return Fields(value, (*self.path, key), self.notes, self.source)

    def tables(self, key: str) -> list[Fields] | None:
        """An array of tables, ``None`` when absent or bad."""
        value = self.raw(key)
        if value is None:
            return None
        if not isinstance(value, list) or not value or not all(isinstance(item, dict) for item in value):
            self.fail(key, "must be an array of tables", f"write each entry as [[{key}]]")
            return None
        return [Fields(item, (*self.path, key, i), self.notes, self.source) for i, item in enumerate(value)]

    def close(self) -> None:
        """Note every key of the table that is not known."""
        for key in self.data:
            if key not in self._asked:
                known = ", ".join(sorted(set(self._asked)))
                self.fail(key, "is not a known key here", f"remove it, or use one of: {known}")

    def _number(self, path: KeyPath, value: object, unit: str) -> Number | None:
        if not isinstance(value, dict):
            exact = self.decimal(path, value)
            return None if exact is None else Number(exact, unit, self.source)
        inner = Fields(value, path, self.notes, self.source)
        number = inner._described(unit)
        inner.close()
        return number

    def _described(self, unit: str) -> Number | None:
        """The number that this table of value, unit, source … describes."""
        value, low, high = (self._decimal(key, required=key == "value") for key in ("value", "low", "high"))
        given, source, note = self.text("unit"), self.text("source"), self.text("note")
        if unit and given and given != unit:
            self.fail("unit", f"must be {unit}", f"convert the value to {unit}")
        assumed = self._flag("assumed")
        if assumed and not (note or source):
            self.fail("assumed", "an assumption needs its reason", 'add note = "why this value"')
        self._check_range(value, low, high)
        if value is None:
            return None
        return Number(
            value, given or unit, source or ("" if assumed else self.source), assumed, low, high, note
        )

    def _check_range(self, value: Fraction | None, low: Fraction | None, high: Fraction | None) -> None:
        if ("low" in self.data) != ("high" in self.data):
            present = "low" if "low" in self.data else "high"
            self.fail(present, "a range needs both ends", "give both low and high")
        if value is not None and low is not None and high is not None and not low <= value <= high:
            ends = f"[{decimal_text(low)}, {decimal_text(high)}]"
            self.fail("value", f"must lie in its range {ends}", "correct value, low or high")

    def _flag(self, key: str) -> bool:
        value = self.raw(key)
        if value is not None and not isinstance(value, bool):
            self.fail(key, "must be true or false", f"write {key} = true")
        return value is True

    def _decimal(self, key: str, required: bool) -> Fraction | None:
        value = self.raw(key, required)
        return None if value is None else self.decimal((*self.path, key), value)

    def decimal(self, path: KeyPath, value: object) -> Fraction | None:
        """An exact number, ``None`` when the value is none."""
        if isinstance(value, int | Fraction) and not isinstance(value, bool):
            return Fraction(value)
        self.notes.fail(path, value, "must be a finite decimal number", "write a plain decimal like 0.091")
        return None


def _key(path: KeyPath) -> str:
    """The path as written in TOML, list entries counted from 1: links[2].mass."""
    text = ""
    for part in path:
        text += f"[{part + 1}]" if isinstance(part, int) else f".{part}"
    return text.lstrip(".")


def _shown(value: object) -> str:
    text = str(value)
    return text if len(text) <= 60 else text[:57] + "…"
