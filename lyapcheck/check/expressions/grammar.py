"""Whether an expression is one: known operations, declared variables, sizes within reach."""

from __future__ import annotations

import re
from collections.abc import Callable, Iterable
from math import gcd
from typing import Any

from lyapcheck.check.expressions.expression import CONSTANTS, FAMILY, FUNCTIONS, LEAVES, variables
from lyapcheck.check.refusal import Refused, require

MAX_DEPTH = 300
MAX_DIGITS = 4000
MAX_NAME = 200
MAX_M = 10_000
MAX_EXPONENT = 50_000
MAX_SIZE = 1_000_000
RATIONAL = re.compile(r"0|-?[1-9][0-9]*(/[1-9][0-9]*)?")
NAME = re.compile(r"[A-Za-zα-θκ-μξπ-τφ-ωΓΔΘΛΞΠΣΦΨΩ_][A-Za-zα-θκ-μξπ-τφ-ωΓΔΘΛΞΠΣΦΨΩ0-9₀-₉_]*′*")
"""Latin and Greek letters, without those that look like Latin ones (ι, ν, ο, υ and most capitals): no name
can pass for another, or for part of a statement."""
CONSTANT_NAME = re.compile(r"π.*|[γρ]_?[0-9₀-₉].*|[LhU](_[0-9₀-₉]|[₀-₉]).*")
"""What the text of an expression writes for constants and functions of the family, or looks like it."""
Parts = list[Any]


class Remembered:
    """Expressions without variables that passed a check, which need not be looked at again as same objects.

    They are immutable, and kept here, so that their ids stay their own.
    """

    MOST = 256

    def __init__(self) -> None:
        self._kept: dict[int, Any] = {}

    def __contains__(self, tree: Any) -> bool:
        return id(tree) in self._kept

    def add(self, tree: Any) -> None:
        if len(self._kept) >= self.MOST:
            self._kept.clear()
        self._kept[id(tree)] = tree


_WELL_FORMED = Remembered()


def require_expressions(trees: Iterable[Any], names: Iterable[str] | None = None) -> None:
    """Refuse expressions that are malformed or have variables beyond ``names`` (``None``: any are)."""
    names = None if names is None else set(names)
    for name in names or ():
        require(
            is_name(name), "variable", name, "is not a name of Latin or Greek letters, digits and underscores"
        )
    for tree in trees:
        if tree in _WELL_FORMED:
            continue
        require_tree(tree, MAX_DEPTH)
        if tree[0] in LEAVES and tree[0] != "var":
            continue  # short by its shape, and without variables
        size = written_out(tree, {})
        require(
            size <= MAX_SIZE,
            "expression",
            tree[0],
            f"has more than {MAX_SIZE} parts with its powers written out",
        )
        used = variables(tree)
        if names is not None:
            for name in sorted(used - names):
                raise Refused("variable", name, "is not declared by the statement")
        if not used and len(tree) > 2:
            _WELL_FORMED.add(tree)


def require_tree(tree: Any, depth: int, seen: dict[int, int] | None = None) -> None:
    """Refuse an expression with an unknown operation, a wrong number of parts or too many levels.

    ``seen`` has nodes that were looked at, by id, with the levels that were left to them.
    """
    if not isinstance(tree, tuple) or not tree:
        raise Refused("expression", tree, "is not an operation with its parts")
    seen = {} if seen is None else seen
    if seen.get(id(tree), 0) >= depth > 0:
        return
    seen[id(tree)] = depth
    operation, *parts = tree
    if depth <= 0:
        raise Refused("expression", operation, f"is nested deeper than {MAX_DEPTH} levels")
    shape = SHAPES.get(operation) if isinstance(operation, str) else None
    if shape is None or shape(parts) is not True:
        raise Refused("expression", tree, "is not an operation that the checker knows")
    for part in parts:
        if isinstance(part, tuple):
            require_tree(part, depth - 1, seen)


def written_out(tree: Any, known: dict[int, int]) -> int:
    """The numbers, names and functions in an expression whose powers are written as products.

    It bounds the degree, and with it the digits, of all that an expression expands to. ``known`` has the
    sizes of parts by their ids, which are their own as long as the expression exists.
    """
    if id(tree) not in known:
        operation, *parts = tree
        inner = 0
        for part in parts:
            inner += written_out(part, known) if isinstance(part, tuple) else 0
        times = parts[1] if operation == "pow" else 4 * parts[0] if operation in FAMILY else 1
        number = len(parts[0]) // 10 if operation == "num" else 0
        known[id(tree)] = 1 + number + inner * times
    return known[id(tree)]


def is_name(name: str) -> bool:
    """Whether text names a variable, and does not read as a constant."""
    plain = len(name) <= MAX_NAME and NAME.fullmatch(name) is not None
    return plain and CONSTANT_NAME.fullmatch(name) is None and name not in {"ln", *FUNCTIONS}


def is_rational_text(value: Any) -> bool:
    """Whether a value is an integer or a quotient of integers in lowest terms as text, of bearable length."""
    rational = isinstance(value, str) and len(value) <= MAX_DIGITS and RATIONAL.fullmatch(value) is not None
    if not rational:
        return False
    top, _, bottom = value.partition("/")
    return not bottom or (bottom != "1" and gcd(int(top), int(bottom)) == 1)


def _types(*wanted: type) -> Callable[[Parts], bool]:
    return lambda parts: [type(part) for part in parts] == list(wanted)


def _member(parts: Parts) -> bool:
    return type(parts[0]) is int and 1 <= parts[0] <= MAX_M


SHAPES: dict[str, Callable[[Parts], bool]] = {
    "num": lambda parts: len(parts) == 1 and is_rational_text(parts[0]),
    "var": lambda parts: _types(str)(parts) and is_name(parts[0]),
    "pi": _types(),
    "neg": _types(tuple),
    "div": _types(tuple, tuple),
    "pow": lambda parts: _types(tuple, int)(parts) and 0 <= parts[1] <= MAX_EXPONENT,
    **dict.fromkeys(("add", "mul"), lambda parts: {type(part) for part in parts} == {tuple}),
    **dict.fromkeys(FUNCTIONS, _types(tuple)),
    **dict.fromkeys(CONSTANTS, lambda parts: len(parts) == 1 and _member(parts)),
    **dict.fromkeys(FAMILY, lambda parts: _types(int, tuple)(parts) and _member(parts)),
}
"""For each operation, whether its parts have the right number, types and sizes."""
