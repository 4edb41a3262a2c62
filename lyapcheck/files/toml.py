"""A TOML file, read exactly."""

from __future__ import annotations

import re
import sys
import tomllib
from bisect import bisect_right
from dataclasses import dataclass
from functools import cached_property
from pathlib import Path
from typing import Any

from lyapcheck.errors import InputError, Problem, file_error
from lyapcheck.files.decimals import written
from lyapcheck.files.place import KeyPath, Place
from lyapcheck.files.places import places

LARGEST_FILE = 20_000_000
"""Bytes; a file of ten thousand gain sets has about two million."""


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
        """The offset of each line."""
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
        """The line of a key, counted from 1."""
        place = self.place(path)
        return None if place is None else place.line


def open_document(path: Path, shown: str | None = None) -> TomlFile:
    """Read a TOML file; ``shown`` is the name that messages use, as the user wrote it.

    Raises:
        InputError: no such file, not a file, too large, not UTF-8, or not TOML (with the line).
    """
    name = _sayable(str(path) if shown is None else shown)
    text = _text(path, name)
    try:
        return TomlFile(name, text, tomllib.loads(text, parse_float=written))
    except tomllib.TOMLDecodeError as error:
        raise _syntax(name, str(error), text) from None
    except RecursionError:
        raise file_error(name, "is nested too deeply", "write plain tables and lists") from None
    except ValueError:
        raise _too_long(name, text) from None


def _text(path: Path, name: str) -> str:
    try:
        if path.is_dir():
            raise file_error(name, "is a folder", "name a file in it")
        if path.stat().st_size > LARGEST_FILE:
            raise file_error(name, f"is larger than {LARGEST_FILE} bytes", "split it into several files")
        return path.read_text(encoding="utf-8-sig")
    except UnicodeDecodeError:
        raise file_error(name, "is not UTF-8 text", "save it as UTF-8") from None
    except (OSError, ValueError) as error:
        reason = error.strerror if isinstance(error, OSError) and error.strerror else str(error)
        raise file_error(name, f"cannot be read ({reason})", "check the path") from None


def _sayable(name: str) -> str:
    """A file name that can be written out, whatever bytes it has on disk."""
    return name.encode("utf-8", "backslashreplace").decode("utf-8")


def _too_long(name: str, text: str) -> InputError:
    """An integer that Python refuses to read, because that takes a time quadratic in its digits."""
    result = re.search(rf"[\d_]{{{sys.get_int_max_str_digits()}}}", text)
    line = text.count("\n", 0, result.start()) + 1 if result else None
    rule = "is an integer of absurd length"
    return InputError(Problem(name, line, "number", "", rule, "write a number of physical size"))


def _syntax(name: str, message: str, text: str) -> InputError:
    result = re.search(r"\(at line (\d+), column (\d+)\)", message)
    what = re.sub(r" \(at .*\)$", "", message)
    if text.lstrip().startswith("<"):
        return file_error(
            name, "is XML, not TOML", 'give a TOML file, which may name a URDF file: robot = "arm.urdf"'
        )
    line = int(result[1]) if result else _last_assignment(text)
    if what == "Unclosed array" and result is not None:
        before = text.splitlines()[: int(result[1])]
        if "[" not in before[-1][: int(result[2])]:  # it is the next key that does not fit into the array
            line = _last_assignment("\n".join(before[:-1]))
    return InputError(Problem(name, line, "TOML", "", what, "correct the syntax on this line"))


def _last_assignment(text: str) -> int | None:
    """The last line that begins a value, which is where an end that is missing at the end was opened."""
    lines = [
        number for number, line in enumerate(text.splitlines(), 1) if re.match(r"\s*[\w\"'.-]+\s*=", line)
    ]
    return lines[-1] if lines else None
