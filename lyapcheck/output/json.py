"""An answer as JSON: its schema, the versions behind it, then its data."""

from __future__ import annotations

from collections.abc import Collection
from importlib.metadata import version
from json import JSONEncoder
from typing import Any

from lyapcheck.output.answer import Answer

BEHIND = ("lyapcheck", "python-flint")
"""The packages whose versions stand in every answer."""
LONGEST = 400
"""Characters of a value that stands on one line."""
_encode = JSONEncoder(ensure_ascii=False, allow_nan=False).encode


def render(answer: Answer) -> str:
    """The whole answer; the same answer gives the same bytes."""
    versions = {name: version(name) for name in BEHIND}
    head = {"schema": answer.schema, "version": versions["lyapcheck"], "versions": versions}
    return f"{laid_out(head | answer.data())}\n"


def laid_out(value: Any, indent: str = "") -> str:
    """A value as JSON, a line a record: what holds no more than flat parts on a line of its own."""
    parts = _parts(value)
    if not any(_parts(inner) for part in parts for inner in _parts(part)):
        line = _encode(value)
        if len(line) <= LONGEST or not parts:
            return line
    inner = f"{indent}  "
    if isinstance(value, dict):
        lines = [f"{_encode(key)}: {laid_out(part, inner)}" for key, part in value.items()]
        first, last = "{", "}"
    else:
        lines = [laid_out(part, inner) for part in value]
        first, last = "[", "]"
    body = f",\n{inner}".join(lines)
    return f"{first}\n{inner}{body}\n{indent}{last}"


def _parts(value: Any) -> Collection[Any]:
    """What a value is made of; nothing for what is no dict and no list."""
    if isinstance(value, dict):
        return value.values()
    return value if isinstance(value, (list, tuple)) else ()
