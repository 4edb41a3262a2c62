"""A shorter statement with the same fault."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import fields, is_dataclass, replace
from typing import Any

from tests.statement_fuzz.generators import Made
from tests.statement_fuzz.judge import Judged, judge
from tests.statement_fuzz.subject import FAMILY, FUNCTIONS

OPERATIONS = frozenset(
    ("num", "var", "pi", "gamma", "rho", "L", "add", "mul", "neg", "div", "pow", *FUNCTIONS, *FAMILY)
)
NUMBERS = (("num", "0"), ("num", "1"), ("num", "2"))
ROUNDS = 40


def shrunk(judged: Judged, seed: int = 0) -> Judged:
    """The same sort of fault in a statement that no single step makes shorter."""
    for _ in range(ROUNDS):
        smaller = _step(judged, seed)
        if smaller is None:
            break
        judged = smaller
    return judged


def _step(judged: Judged, seed: int) -> Judged | None:
    size = _size(judged.made.statement)
    for statement in variants(judged.made.statement):
        if _size(statement) >= size:
            continue
        result = judge(Made(statement, judged.made.family), seed)
        if result.signature == judged.signature:
            return result
    return None


def _size(value: Any) -> int:
    if is_dataclass(value):
        return 1 + sum(_size(getattr(value, f.name)) for f in fields(value))
    if isinstance(value, tuple):
        return 1 + sum(map(_size, value))
    return len(str(value))


def variants(value: Any) -> Iterator[Any]:
    """The value with one expression replaced by a part of it or a number, or one entry of a list left out."""
    if is_dataclass(value) and not isinstance(value, type):
        for f in fields(value):
            for other in variants(getattr(value, f.name)):
                try:
                    yield replace(value, **{f.name: other})
                except (ValueError, TypeError):
                    continue
    elif isinstance(value, tuple):
        yield from _of_tuple(value)


def _of_tuple(value: tuple[Any, ...]) -> Iterator[Any]:
    is_tree = bool(value) and isinstance(value[0], str) and value[0] in OPERATIONS
    if is_tree:
        parts = [part for part in value[1:] if isinstance(part, tuple)]
        yield from parts
        if value[0] != "num":
            yield from NUMBERS
        elif value not in NUMBERS:
            yield from (NUMBERS[1], ("num", "-1"))
        if value[0] in ("add", "mul") and len(parts) > 2:
            yield from ((value[0], *parts[:k], *parts[k + 1 :]) for k in range(len(parts)))
    elif value and not isinstance(value[0], str):
        yield from ((*value[:k], *value[k + 1 :]) for k in range(len(value)))
    for k, part in enumerate(value):
        for other in variants(part):
            yield (*value[:k], other, *value[k + 1 :])
