"""Rows of a report to plain data and back, by the types that their fields declare."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import asdict, is_dataclass, replace
from functools import cache
from types import NoneType, UnionType
from typing import Any, TypeVar, Union, get_args, get_origin, get_type_hints

T = TypeVar("T")
_hints: Any = cache(get_type_hints)


def plain(row: Any) -> dict[str, Any]:
    """The fields of a data class by their names, rows in it likewise; a promise is in words, not in data."""
    if not hasattr(row, "promise"):
        return asdict(row)
    data = asdict(replace(row, promise=None))
    del data["promise"]
    return data


def read(cls: type[T], data: Mapping[str, Any]) -> T:
    """What `plain` has made of a row, also after it was written as JSON.

    Raises:
        AttributeError, KeyError, TypeError, ValueError: it has another form.
    """
    hints: dict[str, Any] = _hints(cls)
    return cls(**{name: _value(hints[name], value) for name, value in data.items()})


def _value(hint: Any, value: Any) -> Any:
    origin, args = get_origin(hint), get_args(hint)
    if origin in (Union, UnionType) and NoneType in args:
        return None if value is None else _value(args[0], value)
    if origin is tuple:
        each = [args[0]] * len(value) if args[-1] is Ellipsis else args
        return tuple(_value(arg, part) for arg, part in zip(each, value, strict=True))
    if origin is Mapping:
        return {key: _value(args[1], part) for key, part in value.items()}
    if isinstance(hint, type) and is_dataclass(hint):
        return read(hint, value)
    return value
