"""An answer as JSON: its schema, the versions behind it, then its data."""

from __future__ import annotations

from importlib.metadata import version
from json import JSONEncoder
from typing import Any

from lyapcheck.output.answer import Answer

BEHIND = ("lyapcheck", "python-flint")
"""The packages whose versions stand in every answer."""
LONGEST = 400
"""Characters of a value that stands on one line."""
NESTING = (dict, list, tuple)
"""What has parts."""
_encode = JSONEncoder(ensure_ascii=False, allow_nan=False).encode


def render(answer: Answer) -> str:
    """The whole answer; the same answer gives the same bytes."""
    versions = {name: version(name) for name in BEHIND}
    head = {"schema": answer.schema, "version": versions["lyapcheck"], "versions": versions}
    return f"{laid_out(head | answer.data())}\n"


def laid_out(value: Any) -> str:
    """A value as JSON, a line a record: what holds no more than flat parts on a line of its own."""
    text: list[str] = []
    _lay_out(value, "\n", text)
    return "".join(text)


def _lay_out(value: Any, line: str, text: list[str]) -> None:
    """Add a value to a text; ``line`` is a line end with the indent of what holds the value."""
    if not isinstance(value, NESTING):
        text.append(_encode(value))
        return
    parts = value.values() if isinstance(value, dict) else value
    nested = [part for part in parts if isinstance(part, NESTING)]
    if not any(_holds_parts(part) for part in nested):
        whole = _encode(value)
        if len(whole) <= LONGEST or not parts:
            text.append(whole)
            return
    inner = f"{line}  "
    heads = [f"{_encode(key)}: " for key in value] if isinstance(value, dict) else [""] * len(value)
    first, last = "{}" if isinstance(value, dict) else "[]"
    between = f"{first}{inner}"
    for head, part in zip(heads, parts, strict=True):
        text.append(between + head)
        _lay_out(part, inner, text)
        between = f",{inner}"
    text.append(line + last)


def _holds_parts(part: Any) -> bool:
    """Whether a part has parts that are not empty and no plain values."""
    return any(isinstance(x, NESTING) and x for x in (part.values() if isinstance(part, dict) else part))
