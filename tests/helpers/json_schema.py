"""As much of JSON Schema, draft 4, as the schema of SARIF needs; a keyword it does not know is an error."""

from __future__ import annotations

import re
from collections.abc import Iterator
from typing import Any

_TYPES: dict[str, Any] = {
    "object": dict,
    "array": list,
    "string": str,
    "boolean": bool,
    "integer": int,
    "number": (int, float),
    "null": type(None),
}
_SAY_NOTHING = {"$schema", "id", "title", "description", "default", "definitions", "format"}


def faults(value: Any, schema: dict[str, Any], root: dict[str, Any], at: str = "$") -> Iterator[str]:
    """What is wrong with a value, a line each."""
    for keyword, wanted in schema.items():
        if keyword not in _SAY_NOTHING:
            yield from _RULES[keyword](value, wanted, schema, root, at)


def _is(value: Any, name: str) -> bool:
    return isinstance(value, _TYPES[name]) and not (isinstance(value, bool) and name != "boolean")


def _reference(value: Any, wanted: str, schema: Any, root: Any, at: str) -> Iterator[str]:
    target = root
    for part in wanted.removeprefix("#/").split("/"):
        target = target[part]
    yield from faults(value, target, root, at)


def _type(value: Any, wanted: Any, schema: Any, root: Any, at: str) -> Iterator[str]:
    names = wanted if isinstance(wanted, list) else [wanted]
    if not any(_is(value, name) for name in names):
        yield f"{at}: is not of type {wanted}"


def _properties(value: Any, wanted: dict[str, Any], schema: Any, root: Any, at: str) -> Iterator[str]:
    for key, inner in wanted.items():
        if isinstance(value, dict) and key in value:
            yield from faults(value[key], inner, root, f"{at}.{key}")


def _additional(value: Any, wanted: Any, schema: Any, root: Any, at: str) -> Iterator[str]:
    known = schema.get("properties", {})
    for key in [key for key in value if key not in known] if isinstance(value, dict) else []:
        if wanted is False:
            yield f"{at}: has an unknown key {key}"
        elif isinstance(wanted, dict):
            yield from faults(value[key], wanted, root, f"{at}.{key}")


def _required(value: Any, wanted: list[str], schema: Any, root: Any, at: str) -> Iterator[str]:
    yield from (f"{at}: lacks {key}" for key in wanted if isinstance(value, dict) and key not in value)


def _items(value: Any, wanted: dict[str, Any], schema: Any, root: Any, at: str) -> Iterator[str]:
    for i, item in enumerate(value if isinstance(value, list) else []):
        yield from faults(item, wanted, root, f"{at}[{i}]")


def _unique(value: Any, wanted: bool, schema: Any, root: Any, at: str) -> Iterator[str]:
    if wanted and isinstance(value, list) and any(item in value[:i] for i, item in enumerate(value)):
        yield f"{at}: has the same entry twice"


def _least_items(value: Any, wanted: int, schema: Any, root: Any, at: str) -> Iterator[str]:
    if isinstance(value, list) and len(value) < wanted:
        yield f"{at}: has fewer than {wanted} entries"


def _minimum(value: Any, wanted: float, schema: Any, root: Any, at: str) -> Iterator[str]:
    if _is(value, "number") and value < wanted:
        yield f"{at}: is below {wanted}"


def _maximum(value: Any, wanted: float, schema: Any, root: Any, at: str) -> Iterator[str]:
    if _is(value, "number") and value > wanted:
        yield f"{at}: is above {wanted}"


def _pattern(value: Any, wanted: str, schema: Any, root: Any, at: str) -> Iterator[str]:
    if isinstance(value, str) and not re.search(wanted, value):
        yield f"{at}: does not match {wanted}"


def _enum(value: Any, wanted: list[Any], schema: Any, root: Any, at: str) -> Iterator[str]:
    if value not in wanted:
        yield f"{at}: is none of {wanted}"


def _any_of(value: Any, wanted: list[Any], schema: Any, root: Any, at: str) -> Iterator[str]:
    if not any(not list(faults(value, choice, root, at)) for choice in wanted):
        yield f"{at}: fits none of {len(wanted)} schemas"


def _one_of(value: Any, wanted: list[Any], schema: Any, root: Any, at: str) -> Iterator[str]:
    fitting = sum(not list(faults(value, choice, root, at)) for choice in wanted)
    if fitting != 1:
        yield f"{at}: fits {fitting} of {len(wanted)} schemas"


_RULES = {
    "$ref": _reference,
    "type": _type,
    "properties": _properties,
    "additionalProperties": _additional,
    "required": _required,
    "items": _items,
    "uniqueItems": _unique,
    "minItems": _least_items,
    "minimum": _minimum,
    "maximum": _maximum,
    "pattern": _pattern,
    "enum": _enum,
    "anyOf": _any_of,
    "oneOf": _one_of,
}
