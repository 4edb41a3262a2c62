"""A place in a file, and the path of keys that leads to a value."""

from __future__ import annotations

from lyapcheck.records import Record

KeyPath = tuple[str | int, ...]


class Place(Record):
    """Line and column, both counted from 1."""

    line: int
    column: int
