"""A place in a file, and the path of keys that leads to a value."""

from __future__ import annotations

from typing import NamedTuple

KeyPath = tuple[str | int, ...]


class Place(NamedTuple):
    """Line and column, both counted from 1."""

    line: int
    column: int
