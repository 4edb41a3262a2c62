"""Where each key of a TOML text stands: ``tomllib`` gives values, not places.

The text is one that ``tomllib`` has already accepted, so this reader need not find mistakes; it only walks
over tokens and keeps count of lines and columns.
"""

from __future__ import annotations

import re
import tomllib
from collections.abc import Iterator
from dataclasses import dataclass

from lyapcheck.files.place import KeyPath, Place

_TOKEN = re.compile(
    r"""(?P<skip>[ \t\r]+|\#[^\n]*)
      | (?P<text>\"{3}(?:\\.|[^\\])*?\"{3,5}|'{3}.*?'{3,5}|"(?:\\.|[^"\\\n])*"|'[^'\n]*')
      | (?P<mark>[\[\]{}=,\n])
      | (?P<bare>[^\s\[\]{}=,\#"']+)""",
    re.DOTALL | re.VERBOSE,
)


@dataclass(frozen=True)
class _Token:
    kind: str
    text: str
    place: Place


def places(text: str) -> dict[KeyPath, Place]:
    """The place of every key, table and array element of a valid TOML text."""
    return _Walk(list(_tokens(text))).run()


def _tokens(text: str) -> Iterator[_Token]:
    line, start = 1, 0
    for match in _TOKEN.finditer(text):
        if match.lastgroup != "skip":
            yield _Token(match.lastgroup or "", match[0], Place(line, match.start() - start + 1))
        breaks = match[0].count("\n")
        if breaks:
            line, start = line + breaks, match.start() + match[0].rindex("\n") + 1


def _unquoted(key: str) -> str:
    """What a quoted key says."""
    return str(tomllib.loads(f"key = {key}")["key"]) if "\\" in key else key[1:-1]


class _Walk:
    """One pass over the tokens of a document."""

    def __init__(self, tokens: list[_Token]) -> None:
        self.tokens, self.at = tokens, 0
        self.found: dict[KeyPath, Place] = {}
        self.entries: dict[KeyPath, int] = {}

    def run(self) -> dict[KeyPath, Place]:
        table: KeyPath = ()
        while self.at < len(self.tokens):
            if self._is("\n"):
                self.at += 1
            elif self._is("["):
                table = self._header()
            else:
                self._pair(table)
        return self.found

    def _is(self, mark: str, ahead: int = 0) -> bool:
        index = self.at + ahead
        return (
            index < len(self.tokens) and self.tokens[index].kind == "mark" and self.tokens[index].text == mark
        )

    def _header(self) -> KeyPath:
        place, array = self.tokens[self.at].place, self._is("[", 1)
        self.at += 2 if array else 1
        keys = self._keys("]")
        self.at += 2 if array else 1
        path: KeyPath = ()
        for depth, key in enumerate(keys, 1):
            path = (*path, key)
            if array and depth == len(keys):
                self.entries[path] = self.entries.get(path, -1) + 1
                self.found.setdefault(path, place)
            if path in self.entries:
                path = (*path, self.entries[path])
        self.found.setdefault(path, place)
        return path

    def _keys(self, end: str) -> list[str]:
        """The parts of a dotted key up to a mark."""
        keys: list[str] = []
        while not self._is(end):
            token = self.tokens[self.at]
            keys += (
                [_unquoted(token.text)]
                if token.kind == "text"
                else [part for part in token.text.split(".") if part]
            )
            self.at += 1
        return keys

    def _pair(self, table: KeyPath) -> None:
        place = self.tokens[self.at].place
        path: KeyPath = table
        for key in self._keys("="):
            path = (*path, key)
            self.found.setdefault(path, place)
        self.at += 1
        self._value(path)

    def _value(self, path: KeyPath) -> None:
        if self._is("["):
            self._list(path)
        elif self._is("{"):
            self._inline(path)
        else:
            self.at += 1
            while self.at < len(self.tokens) and self.tokens[self.at].kind == "bare":
                self.at += 1  # a date and its time are two bare words

    def _list(self, path: KeyPath) -> None:
        self.at += 1
        index = 0
        while not self._is("]"):
            if self._is("\n") or self._is(","):
                self.at += 1
                continue
            self.found[(*path, index)] = self.tokens[self.at].place
            self._value((*path, index))
            index += 1
        self.at += 1

    def _inline(self, path: KeyPath) -> None:
        self.at += 1
        while not self._is("}"):
            if self._is(",") or self._is("\n"):
                self.at += 1
            else:
                self._pair(path)
        self.at += 1
