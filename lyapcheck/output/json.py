"""An answer as JSON: its schema, the versions behind it, then its data; short values on one line."""

from __future__ import annotations

from importlib.metadata import version
from json import JSONEncoder
from typing import Any

from lyapcheck.output.answer import Answer

BEHIND = ("lyapcheck", "python-flint")
"""The packages whose versions stand in every answer."""
SHORT = 100
_encode = JSONEncoder(ensure_ascii=False, allow_nan=False).encode


def render(answer: Answer) -> str:
    """The whole answer; the same answer gives the same bytes."""
    versions = {name: version(name) for name in BEHIND}
    head = {"schema": answer.schema, "version": versions["lyapcheck"], "versions": versions}
    return f"{laid_out(head | answer.data())}\n"


def laid_out(value: Any, indent: str = "") -> str:
    """A value as JSON; one that does not fit on a line with its parts below each other."""
    line = _encode(value)
    if not isinstance(value, (dict, list, tuple)) or not value or len(indent) + len(line) <= SHORT:
        return line
    inner = f"{indent}  "
    if isinstance(value, dict):
        parts = [f"{_encode(key)}: {laid_out(part, inner)}" for key, part in value.items()]
        first, last = "{", "}"
    else:
        parts = [laid_out(part, inner) for part in value]
        first, last = "[", "]"
    body = f",\n{inner}".join(parts)
    return f"{first}\n{inner}{body}\n{indent}{last}"
