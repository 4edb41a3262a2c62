"""Gain files as nearly everyone writes them, read without a TOML parser: a table a set, a line a key.

What is read here means the same in TOML. Whatever else a file holds, a mistake included, makes the reader
give up, and the file is read in full instead: this one only saves time, at the start of the program and for
files of thousands of sets.
"""

from __future__ import annotations

from fractions import Fraction

from lyapcheck.control.gains import FAMILIES, LARGEST_M, Bounds, GainFile, GainSet
from lyapcheck.files.decimals import exact_decimal
from lyapcheck.files.place import KeyPath, Place

TYPE_CHECKING = False
if TYPE_CHECKING:
    from typing import Any

_LARGEST_FILE = 20_000_000
_LONGEST = 100
_CONTROL = frozenset(map(chr, (*range(9), *range(10, 32), 127))) - {"\n"}
_KEYS: dict[str, dict[str, type]] = {
    "top": {"robot": str},
    "gains": {"name": str, "m": Fraction, "kp": tuple, "kv": tuple, "family": str, "angle": str},
    "bounds": {"viscous_min": Fraction, "torque": tuple, "gravity": tuple},
}


class _Odd(Exception):
    """The file is not plain."""


class Lines:
    """The places of the keys of a plain file, found when they are asked for."""

    def __init__(self, lines: list[str], heads: list[int], keys: list[dict[str, int]]) -> None:
        self.lines, self.heads, self.keys = lines, heads, keys
        self._last: tuple[int, list[Place]] = (-1, [])

    def __eq__(self, other: object) -> bool:
        return isinstance(other, Lines) and self.lines == other.lines

    def __hash__(self) -> int:
        return hash(tuple(self.lines))

    def place(self, path: KeyPath) -> Place | None:
        """Line and column of a key or number of a gain set, or of the set; ``None`` for anything else."""
        if len(path) < 2 or path[0] != "gains":
            return self._top(path)
        index = int(path[1])
        line = self.keys[index].get(str(path[2])) if len(path) > 2 else None
        if line is None:
            line = self.heads[index]
        elif len(path) > 3:
            if self._last[0] != line:
                self._last = line, _columns(line, self.lines[line])
            return self._last[1][int(path[3])]
        return Place(line + 1, _indent(self.lines[line]))

    def _top(self, path: KeyPath) -> Place | None:
        for number, text in enumerate(self.lines):
            if path and text.partition("=")[0].partition("#")[0].strip("[] \t") == path[0]:
                return Place(number + 1, _indent(text))
        return None


def _columns(line: int, text: str) -> list[Place]:
    """Where the numbers of a list begin."""
    places, at = [], text.index("[") + 1
    for item in text[at : text.index("]")].split(","):
        places.append(Place(line + 1, at + _indent(item)))
        at += len(item) + 1
    return places


def _indent(text: str) -> int:
    """The column where a line begins, from 1."""
    return len(text) - len(text.lstrip(" \t")) + 1


def read_plain(path: str) -> GainFile | None:
    """The gain sets of a plain file; ``None`` where the file is not plain, or cannot be read at all."""
    try:
        path.encode()
        with open(path, "rb") as stream:
            content = stream.read(_LARGEST_FILE + 1)
        if len(content) > _LARGEST_FILE:
            return None
        return _read(path, content.removeprefix(b"\xef\xbb\xbf").decode().replace("\r\n", "\n"))
    except (OSError, ValueError, _Odd):
        return None


def _read(path: str, content: str) -> GainFile:
    _require(_CONTROL.isdisjoint(content))
    lines = content.split("\n")
    top: dict[str, Any] = {}
    bounds: dict[str, Any] | None = None
    sets: list[dict[str, Any]] = []
    heads: list[int] = []
    keys: list[dict[str, int]] = []
    known, table, where, numbers = _KEYS["top"], top, dict[str, int](), dict[str, Fraction]()
    for number, line in enumerate(lines):
        text = line.strip(" \t")
        if not text or text[0] == "#":
            continue
        if text[0] == "[":
            head = text.partition("#")[0].rstrip(" \t")
            _require(head == "[[gains]]" or (head == "[bounds]" and bounds is None))
            table, where = {}, {}
            if head == "[bounds]":
                known, bounds = _KEYS["bounds"], table
                continue
            known = _KEYS["gains"]
            sets.append(table)
            heads.append(number)
            keys.append(where)
        else:
            key, equals, value = text.partition("=")
            key = key.rstrip(" \t")
            _require(bool(equals) and key in known and key not in table)
            table[key], where[key] = _value(value.lstrip(" \t"), known[key], numbers), number
    gains = tuple([_gain_set(table, index) for index, table in enumerate(sets)])
    _require(bool(gains) and len({gain_set.name for gain_set in gains}) == len(gains))
    n = gains[0].n
    _require({len(gain_set.kp) for gain_set in gains} == {n})
    return GainFile(path, _robot(top, path), gains, _bounds(bounds or {}, n), Lines(lines, heads, keys))


def _require(plain: bool) -> None:
    if not plain:
        raise _Odd


def _value(text: str, form: type, numbers: dict[str, Fraction]) -> object:
    """The value of the wanted form, with nothing but a comment after it."""
    if form is str:
        quote = text[:1]
        _require(quote in ('"', "'"))
        found, end, rest = text[1:].partition(quote)
        _require(bool(end) and (quote == "'" or "\\" not in found) and found.isprintable() and _nothing(rest))
        return found
    if form is tuple:
        inner, bracket, rest = text.partition("]")
        _require(text.startswith("[") and bool(bracket) and _nothing(rest))
        return tuple([numbers.get(item) or _exact(item, numbers) for item in inner[1:].split(",")])
    return _exact(text.partition("#")[0], numbers)


def _nothing(rest: str) -> bool:
    """Whether only blanks or a comment follow a value."""
    rest = rest.lstrip(" \t")
    return not rest or rest.startswith("#")


def _exact(token: str, numbers: dict[str, Fraction]) -> Fraction:
    """The value of a decimal without sign and exponent; a decimal that was met before is not read again."""
    text = token.strip(" \t")
    whole, point, places = text.partition(".")
    _require(whole.isdigit() and text.isascii() and len(text) <= _LONGEST)
    _require((whole == "0" or whole[0] != "0") and (places.isdigit() or not point))
    numbers[token] = exact_decimal(text) if point else Fraction(int(text))
    return numbers[token]


def _gain_set(table: dict[str, Any], index: int) -> GainSet:
    name, m, kp, kv = table.get("name", ""), table.get("m"), table.get("kp", ()), table.get("kv", ())
    family, angle = table.get("family", "hyperbolic"), table.get("angle", "rad")
    _require(bool(name.strip()) and len(kp) == len(kv) > 0 and all(kp) and all(kv) and family in FAMILIES)
    _require(angle == "rad" or (angle == "deg" and family == "linear"))
    if family != "hyperbolic":
        _require(m is None)
        return GainSet(name, None, kp, kv, family, angle, index)
    if type(m) is not Fraction or not 1 <= m <= LARGEST_M:  # a decimal point makes it no whole number
        raise _Odd
    return GainSet(name, int(m), kp, kv, family, angle, index)


def _bounds(table: dict[str, Any], n: int) -> Bounds:
    found = Bounds(table.get("viscous_min"), table.get("torque"), table.get("gravity"))
    _require(found.viscous_min != 0 and all(found.torque or (1,)))
    _require(all(values is None or len(values) == n for values in (found.torque, found.gravity)))
    return found


def _robot(top: dict[str, Any], path: str) -> str | None:
    robot = top.get("robot")
    if robot is None:
        return None
    _require(bool(robot.strip()))
    if robot.endswith((".toml", ".urdf")):
        from pathlib import Path

        from lyapcheck.control.reading import beside

        return beside(robot, Path(path))
    return str(robot)
