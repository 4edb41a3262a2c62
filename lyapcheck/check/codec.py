"""Statements and proofs from JSON; reading is strict and builds nothing but plain data.

Fields are read by the types that the data classes declare: a key too many or too few, a number of another
type, a fraction that is not in lowest terms or an unknown kind or rule is refused. Fractions are text.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import fields, is_dataclass
from fractions import Fraction
from functools import cache, lru_cache
from inspect import isabstract
from types import NoneType, UnionType
from typing import Any, TypeVar, Union, get_args, get_origin, get_type_hints
from unicodedata import category, is_normalized

from lyapcheck.check import kinds
from lyapcheck.check.expressions.expression import Tree
from lyapcheck.check.expressions.grammar import MAX_DEPTH, is_rational_text
from lyapcheck.check.refusal import Refused, require
from lyapcheck.check.statement import Piece, Proof, Statement

# --- Kinds of statement and rules that were removed, each with the last version that reads them.

LAST_READ_BY = {
    "ComesToRest": "0.1.0",
    "DecreasingNearby": "0.1.0",
    "Settling": "0.1.0",
    "StaysWithin": "0.1.0",
    "TrigonometricBound": "0.2.0",
    "TrigonometricPositive": "0.2.0",
    "V decreasing at corners": "0.1.0",
    "Fourier sums": "0.2.0",
    "dominant diagonal": "0.1.0",
    "energy along the links": "0.1.0",
    "falling energy": "0.1.0",
    "falling levels": "0.1.0",
    "falling levels in phases": "0.1.0",
    "forms of the motion": "0.1.0",
    "larger K_v": "0.2.0",
    "products of rates": "0.1.0",
    "slower and nearer": "0.1.0",
    "witness of an entry": "0.2.0",
}
"""Names of kinds and of rules, one a line."""


kinds.load()
T = TypeVar("T")
KINDS = __name__.rpartition(".")[0]
"""The package under which every class that may be read is defined."""
TAGS: dict[type, str] = {Statement: "kind", Proof: "rule", Piece: "rule"}
"""The classes that are written with the name of the member, and under which key."""


def name_of(cls: type) -> str:
    """The name under which a kind or a rule is written."""
    return str(getattr(cls, "rule", cls.__name__))


def from_json(cls: type[T], data: Any, where: str) -> T:
    """Data of a declared type from JSON values; refused unless they have exactly the form of that type."""
    result: T = _read(cls, data, where)
    return result


def _read(hint: Any, data: Any, where: str) -> Any:
    if hint == Tree:
        return _tree(data, where, MAX_DEPTH, {})
    reader = READERS.get(get_origin(hint) or hint)
    if reader is not None:
        return reader(hint, data, where)
    if is_dataclass(hint):
        cls: Any = hint
        base = next((base for base in TAGS if issubclass(cls, base)), None)
        if base is None:
            return _dataclass(cls, data, where)
        result = _tagged(base, data, where)
        require(isinstance(result, cls), where, data[TAGS[base]], f"must be {name_of(cls)}")
        return result
    require(type(data) is hint, where, data, f"must be of type {hint.__name__}")
    if hint is str:
        require(is_text(data), where, data, "is not plain Unicode text in NFC")
    return data


def is_text(value: Any) -> bool:
    """Whether a value is text of signs and spaces in the composed form of Unicode (NFC).

    No control characters, nor what turns the direction of writing, nor halves of surrogate pairs; so texts
    that differ look different, but for letters that look alike.
    """
    if not isinstance(value, str):
        return False
    printable = value.isprintable() or all(c.isprintable() or category(c) == "Zs" for c in value)
    return printable and is_normalized("NFC", value)


def _optional(hint: Any, data: Any, where: str) -> Any:
    inner = [arg for arg in get_args(hint) if arg is not NoneType]
    return None if data is None else _read(inner[0], data, where)


def _tuple(hint: Any, data: Any, where: str) -> tuple[Any, ...]:
    args = get_args(hint)
    require(isinstance(data, list), where, data, "must be a list")
    if args[-1] is Ellipsis:
        return tuple(_read(args[0], part, f"{where}[{k}]") for k, part in enumerate(data))
    require(len(data) == len(args), where, data, f"must have {len(args)} entries")
    pairs = zip(args, data, strict=True)
    return tuple(_read(arg, part, f"{where}[{k}]") for k, (arg, part) in enumerate(pairs))


def _fraction(hint: Any, data: Any, where: str) -> Fraction:
    require(is_rational_text(data), where, data, "must be a rational number in lowest terms as text")
    return Fraction(data)


def _tree(data: Any, where: str, depth: int, known: dict[tuple[Any, ...], Any]) -> Any:
    """Lists to tuples, equal ones to one object; what they mean is for ``grammar`` to see.

    ``known`` keeps all objects that it hands out, so that the identities in its keys stay their own.
    """
    require(depth > 0, where, "", f"is nested deeper than {MAX_DEPTH} levels")
    if isinstance(data, list):
        parts = tuple(_tree(part, where, depth - 1, known) for part in data)
        return known.setdefault(tuple(map(id, parts)), parts)
    require(type(data) is int or is_text(data), where, data, "is not part of an expression")
    return known.setdefault((type(data), data), data)


def _tagged(base: type, data: Any, where: str) -> Any:
    key = TAGS[base]
    require(isinstance(data, dict) and key in data, where, data, f"must be an object with a {key!r}")
    require(type(data[key]) is str, f"{where}.{key}", data[key], "must be text")
    cls: Any = members(base).get(data[key])
    if cls is None and data[key] in LAST_READ_BY:
        last = LAST_READ_BY[data[key]]
        rule = f"was removed after lyapcheck {last}; lyapcheck {last} reads it"
        raise Refused(f"{where}.{key}", data[key], rule)
    if cls is None:
        raise Refused(f"{where}.{key}", data[key], f"is not a {key} that the checker knows")
    return _dataclass(cls, {name: value for name, value in data.items() if name != key}, where)


@cache
def members(base: type) -> dict[str, Any]:
    """The kinds of statement, rules or pieces of the checker by name; not what others derive."""
    result: dict[str, Any] = {}
    waiting: list[Any] = base.__subclasses__()
    while waiting:
        cls = waiting.pop()
        waiting += cls.__subclasses__()
        if cls.__module__.startswith(f"{KINDS}.") and not isabstract(cls):
            result[name_of(cls)] = cls
    return result


READERS: dict[Any, Callable[[Any, Any, str], Any]] = {
    Union: _optional,
    UnionType: _optional,
    tuple: _tuple,
    Fraction: _fraction,
    **dict.fromkeys(TAGS, _tagged),
}


def _dataclass(cls: Any, data: Any, where: str) -> Any:
    require(isinstance(data, dict), where, data, "must be an object")
    usual = left_out(cls)
    hints = {name: hint for name, hint in _hints(cls).items() if name in data or name not in usual}
    require_keys(data, set(hints), where)
    values = {name: _read(hint, data[name], f"{where}.{name}") for name, hint in hints.items()}
    for name in usual.keys() & values.keys():
        require(values[name] != usual[name], f"{where}.{name}", usual[name], "must be left out")
    try:
        return cls(**values)
    except ValueError as error:
        raise Refused(where, "", str(error)) from error


@lru_cache(maxsize=128)
def _hints(cls: Any) -> dict[str, Any]:
    hints = get_type_hints(cls)
    return {field.name: hints[field.name] for field in fields(cls)}


@lru_cache(maxsize=128)
def left_out(cls: Any) -> dict[str, Any]:
    """Fields that are not written where they have their usual value; older certificates have none."""
    return {field.name: field.default for field in fields(cls) if field.metadata.get("left_out")}


def require_keys(data: dict[str, Any], wanted: set[str], where: str) -> None:
    """Refuse an object that does not have exactly the wanted keys."""
    for label, names in (("lacks", wanted - set(data)), ("does not know", set(data) - wanted)):
        require(not names, where, ", ".join(sorted(names)), f"the checker {label} these keys")
