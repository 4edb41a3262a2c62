"""A TOML file, read exactly, with the place of each key: ``tomllib`` gives values, not places."""

from __future__ import annotations

import re
import sys
import tomllib
from bisect import bisect_right
from collections.abc import Mapping
from dataclasses import dataclass
from functools import cached_property
from pathlib import Path
from typing import Any, NamedTuple

from lyapcheck.errors import InputError, Problem, file_error
from lyapcheck.files.decimals import written
from lyapcheck.files.reader import TOML, Bound, read_text, sayable

# --- A place in a file, and the path of keys that leads to a value.


KeyPath = tuple[str | int, ...]


class Place(NamedTuple):
    """Line and column, both counted from 1."""

    line: int
    column: int


_TOKEN = re.compile(
    r"""(?:[ \t\r]+|\#[^\n]*)*
      (?:([\[\]{}=,\n])
      |([^\s\[\]{}=,\#"']+)
      |(\"{3}(?:\\.|[^\\])*?\"{3,5}|'{3}.*?'{3,5}|"(?:\\.|[^"\\\n])*"|'[^'\n]*')
      |\Z)""",
    re.DOTALL | re.VERBOSE,
)
"""A mark, a bare word or a quoted text, after blanks and comments; nothing at the end."""
BARE, QUOTED = 2, 3


def places(text: str) -> dict[KeyPath, int]:
    """The offset of every key, table and array element in a valid TOML text."""
    return _Walk(text).run()


class _Walk:
    """One pass over the tokens of a document."""

    def __init__(self, text: str) -> None:
        matches = [match for match in _TOKEN.finditer(text) if match.lastindex]
        self.kinds = [match.lastindex for match in matches]
        self.tokens = [match[match.lastindex or 0] for match in matches]
        self.offsets = [match.start(match.lastindex or 0) for match in matches]
        self.tokens.append("")  # so that one may look ahead at the end
        self.at = 0
        self.found: dict[KeyPath, int] = {}
        self.entries: dict[KeyPath, int] = {}

    def run(self) -> dict[KeyPath, int]:
        table: KeyPath = ()
        while token := self.tokens[self.at]:
            if token == "\n":
                self.at += 1
            elif token == "[":
                offset, array = self.offsets[self.at], self.tokens[self.at + 1] == "["
                self.at += 2 if array else 1
                keys = self._keys("]")
                self.at += 2 if array else 1
                table = ()
                for depth, key in enumerate(keys, 1):
                    table = (*table, key)
                    if array and depth == len(keys):
                        self.entries[table] = self.entries.get(table, -1) + 1
                        self.found.setdefault(table, offset)
                    if table in self.entries:
                        table = (*table, self.entries[table])
                self.found.setdefault(table, offset)
            else:
                self._pair(table)
        return self.found

    def _keys(self, end: str) -> list[str]:
        keys: list[str] = []
        while (token := self.tokens[self.at]) != end:
            if self.kinds[self.at] != QUOTED:
                keys += [part for part in token.split(".") if part]
            else:
                keys.append(tomllib.loads(f"key = {token}")["key"] if "\\" in token else token[1:-1])
            self.at += 1
        return keys

    def _pair(self, table: KeyPath) -> None:
        offset = self.offsets[self.at]
        path: KeyPath = table
        for key in self._keys("="):
            path = (*path, key)
            self.found.setdefault(path, offset)
        self.at += 1
        self._value(path)

    def _value(self, path: KeyPath) -> None:
        first = self.tokens[self.at]
        self.at += 1
        if first == "[":
            index = 0
            while (token := self.tokens[self.at]) != "]":
                if token in ("\n", ","):
                    self.at += 1
                    continue
                self.found[(*path, index)] = self.offsets[self.at]
                self._value((*path, index))
                index += 1
            self.at += 1
        elif first == "{":
            while (token := self.tokens[self.at]) != "}":
                if token in (",", "\n"):
                    self.at += 1
                else:
                    self._pair(path)
            self.at += 1
        else:
            while self.tokens[self.at] and self.kinds[self.at] == BARE:
                self.at += 1  # a date and its time are two bare words


@dataclass(frozen=True)
class TomlFile:
    """A TOML file: its data, floats as exact ``Written`` rationals, and the place of each key."""

    name: str
    text: str
    data: dict[str, Any]

    @cached_property
    def _offsets(self) -> dict[KeyPath, int]:
        try:
            return places(self.text)
        except RecursionError:  # nested almost as deeply as is allowed: messages go without lines
            return {}

    @cached_property
    def _lines(self) -> list[int]:
        return [0, *(match.end() for match in re.finditer("\n", self.text))]

    def place(self, path: KeyPath) -> Place | None:
        """Where a key stands, or the nearest table or list around it that stands in the file."""
        while (offset := self._offsets.get(path)) is None:
            if not path:
                return None
            path = path[:-1]
        line = bisect_right(self._lines, offset)
        return Place(line, offset - self._lines[line - 1] + 1)

    def line(self, path: KeyPath) -> int | None:
        place = self.place(path)
        return None if place is None else place.line


def open_document(path: Path, shown: str | None = None, bound: Bound = TOML) -> TomlFile:
    """Read a TOML file; ``shown`` is the name that messages use, as the user wrote it.

    Raises:
        InputError: no such file, not a file, too large, not UTF-8, or not TOML (with the line).
    """
    name = sayable(str(path) if shown is None else shown)
    text = read_text(path, bound, name)
    try:
        return TomlFile(name, text, tomllib.loads(text, parse_float=written))
    except tomllib.TOMLDecodeError as error:
        raise _syntax(name, str(error), text) from None
    except RecursionError:
        raise file_error(name, "is nested too deeply", "write plain tables and lists") from None
    except ValueError:  # an integer that Python refuses to read, in a time quadratic in its digits
        result = re.search(rf"[\d_]{{{sys.get_int_max_str_digits()}}}", text)
        line = text.count("\n", 0, result.start()) + 1 if result else None
        rule, repair = "is an integer of absurd length", "write a number of physical size"
        raise InputError(Problem(name, line, "number", "", rule, repair)) from None


def quoted(text: str) -> str:
    """A TOML basic string; JSON escapes the same characters the same way."""
    import json

    return json.dumps(text, ensure_ascii=False)


def key_of(name: str) -> str:
    """A name as a key of a TOML table."""
    return name if re.fullmatch(r"[A-Za-z0-9_-]+", name) else quoted(name)


def _syntax(name: str, message: str, text: str) -> InputError:
    result = re.search(r"\(at line (\d+), column (\d+)\)", message)
    what = re.sub(r" \(at .*\)$", "", message)
    if text.lstrip().startswith("<"):
        return file_error(
            name, "is XML, not TOML", 'give a TOML file, which may name a URDF file: robot = "arm.urdf"'
        )
    other = other_format(name, text)
    if other:
        bring = f"lyapcheck init --from {name} --arm ARM" if other != "MATLAB" else "lyapcheck init"
        return file_error(name, f"is {other}, not TOML", f"bring its gains over: {bring} writes a gain file")
    line = int(result[1]) if result else _last_assignment(text)
    if what == "Unclosed array" and result is not None:
        before = text.splitlines()[: int(result[1])]
        if "[" not in before[-1][: int(result[2])]:  # it is the next key that does not fit into the array
            line = _last_assignment("\n".join(before[:-1]))
    return InputError(Problem(name, line, "TOML", "", what, "correct the syntax on this line"))


def other_format(name: str, text: str) -> str:
    """YAML, JSON, CSV or MATLAB, by the name of a file or what is in it; empty where it is none of these."""
    suffix = "mat" if text.startswith("MATLAB 5.0") else name.rpartition(".")[2].lower()
    if suffix in _SUFFIXES:
        return _SUFFIXES[suffix]
    lines = [line for line in map(str.strip, text.splitlines()) if line and not line.startswith(("#", "%"))]
    if not lines:
        return ""
    if lines[0].startswith("{") or re.match(r'\[\s*($|\{|")', lines[0]):
        return "JSON" if text.rstrip().endswith(("}", "]")) else ""
    if any("=" in line for line in lines):
        matlab = re.compile(r".*(;$|=\s*diag\b|=\s*\[[^,\]]*\s[^,]*\])")
        return "MATLAB" if any(map(matlab.match, lines)) else ""
    if re.match(r"[\w./-]+:(\s|$)|- ", lines[0]):
        return "YAML"
    return "CSV" if re.match(r"[^,;]+[,;\t]", lines[0]) else ""


_SUFFIXES = {
    "yaml": "YAML",
    "yml": "YAML",
    "json": "JSON",
    "csv": "CSV",
    "tsv": "CSV",
    "m": "MATLAB",
    "mat": "MATLAB",
}


def _last_assignment(text: str) -> int | None:
    """The last line that begins a value, which is where an end that is missing at the end was opened."""
    lines = [
        number for number, line in enumerate(text.splitlines(), 1) if re.match(r"\s*[\w\"'.-]+\s*=", line)
    ]
    return lines[-1] if lines else None


# --- Which of the files that lyapcheck reads a document is, by keys that no other has.


ARM, GAINS, PLAN = "an arm file", "a gain file", "the plan of a sweep"
MARKS = {PLAN: ("questions",), ARM: ("links", "urdf", "model"), GAINS: ("gains",)}
REPAIRS = {
    ARM: "give the arm file; a gain file names it by robot = …",
    GAINS: "give the gain file; lyapcheck init starts one",
    PLAN: "give the plan; lyapcheck sweep --help says what it has",
}


def require_kind(file: str, data: Mapping[str, object], wanted: str) -> None:
    """Refuse a file that is of another kind by its keys; one of several kinds is left to its reader.

    Raises:
        InputError: it has the keys of another kind, and none of its own.
    """
    kinds = [kind for kind, keys in MARKS.items() if any(key in data for key in keys)]
    if kinds and wanted not in kinds:
        raise InputError(Problem(file, None, "file", "", f"is {kinds[0]}, not {wanted}", REPAIRS[wanted]))
