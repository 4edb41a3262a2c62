"""An answer as JSON: its schema, the versions behind it, then its data."""

from __future__ import annotations

import math
from collections.abc import Iterable
from functools import lru_cache
from importlib.metadata import version
from itertools import repeat
from json import JSONEncoder
from typing import Any

from lyapcheck.output.answer import Answer

BEHIND = ("lyapcheck", "python-flint")
"""The packages whose versions stand in every answer."""
LONGEST = 400
"""Characters of a value that stands on one line."""
NESTING = (dict, list, tuple)
"""What has parts."""
_encode = JSONEncoder(ensure_ascii=False, allow_nan=False, check_circular=False).encode


def render(answer: Answer) -> str:
    """The whole answer; the same answer gives the same bytes."""
    versions = {name: version(name) for name in BEHIND}
    head = {"schema": answer.schema, "version": versions["lyapcheck"], "versions": versions}
    data = head | answer.data()
    if answer.problems:
        data["problems"] = [problem.data() for problem in answer.problems]
    try:
        text = laid_out(data)
    except ValueError:  # JSON has no infinity, and no name for what is no number
        text = laid_out(finite(data))
    return f"{text}\n"


def finite(value: Any) -> Any:
    """The same with ``None`` for each number that is none or infinite."""
    if isinstance(value, dict):
        return {key: finite(part) for key, part in value.items()}
    if isinstance(value, (list, tuple)):
        return [finite(part) for part in value]
    return None if isinstance(value, float) and not math.isfinite(value) else value


def laid_out(value: Any) -> str:
    """A value as JSON, a line a record: what holds no more than flat parts on a line of its own."""
    if not isinstance(value, NESTING):
        return _encode(value)
    text: list[str] = []
    _lay_out(value, "\n", text)
    return "".join(text)


def _lay_out(value: Any, line: str, text: list[str]) -> None:
    """Add a value with parts to a text; ``line`` is a line end with the indent of what holds the value."""
    parts = value.values() if isinstance(value, dict) else value
    if _shallow(parts):
        whole = _encode(value)
        if len(whole) <= LONGEST or not parts:
            text.append(whole)
            return
    inner = f"{line}  "
    heads = map(_head, value) if isinstance(value, dict) else repeat("", len(value))
    first, last = "{}" if isinstance(value, dict) else "[]"
    between = f"{first}{inner}"
    for head, part in zip(heads, parts, strict=True):
        if isinstance(part, NESTING):
            text.append(between + head)
            _lay_out(part, inner, text)
        else:
            text.append(between + head + _encode(part))
        between = f",{inner}"
    text.append(line + last)


def _shallow(parts: Iterable[Any]) -> bool:
    """Whether no part of a part has parts."""
    for part in parts:
        if not isinstance(part, str) and isinstance(part, NESTING):  # the former is quick to tell, and usual
            for inner in part.values() if isinstance(part, dict) else part:
                if isinstance(inner, NESTING) and inner:
                    return False
    return True


@lru_cache(maxsize=256)  # ten thousand records have the same keys
def _head(key: str) -> str:
    return f"{_encode(key)}: "
