"""A place in a file, and the path of keys that leads to a value."""

from __future__ import annotations

from dataclasses import dataclass

KeyPath = tuple[str | int, ...]


@dataclass(frozen=True)
class Place:
    """Line and column, both counted from 1."""

    line: int
    column: int
