"""Where each key of a TOML text stands: ``tomllib`` gives values, not places.

The text is one that ``tomllib`` has already accepted, so this reader need not find mistakes; it only walks
over tokens and keeps their offsets.
"""

from __future__ import annotations

import re
import tomllib
from typing import NamedTuple

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


def _unquoted(key: str) -> str:
    return str(tomllib.loads(f"key = {key}")["key"]) if "\\" in key else key[1:-1]


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
                table = self._header()
            else:
                self._pair(table)
        return self.found

    def _header(self) -> KeyPath:
        offset, array = self.offsets[self.at], self.tokens[self.at + 1] == "["
        self.at += 2 if array else 1
        keys = self._keys("]")
        self.at += 2 if array else 1
        path: KeyPath = ()
        for depth, key in enumerate(keys, 1):
            path = (*path, key)
            if array and depth == len(keys):
                self.entries[path] = self.entries.get(path, -1) + 1
                self.found.setdefault(path, offset)
            if path in self.entries:
                path = (*path, self.entries[path])
        self.found.setdefault(path, offset)
        return path

    def _keys(self, end: str) -> list[str]:
        keys: list[str] = []
        while (token := self.tokens[self.at]) != end:
            quoted = self.kinds[self.at] == QUOTED
            keys += [_unquoted(token)] if quoted else [part for part in token.split(".") if part]
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
        if first == "[":
            self._list(path)
        elif first == "{":
            self._inline(path)
        else:
            self.at += 1
            while self.tokens[self.at] and self.kinds[self.at] == BARE:
                self.at += 1  # a date and its time are two bare words

    def _list(self, path: KeyPath) -> None:
        self.at += 1
        index = 0
        while (token := self.tokens[self.at]) != "]":
            if token in ("\n", ","):
                self.at += 1
                continue
            self.found[(*path, index)] = self.offsets[self.at]
            self._value((*path, index))
            index += 1
        self.at += 1

    def _inline(self, path: KeyPath) -> None:
        self.at += 1
        while (token := self.tokens[self.at]) != "}":
            if token in (",", "\n"):
                self.at += 1
            else:
                self._pair(path)
        self.at += 1
