"""Identities between vectors and matrices that hold for every n.

Beside the expressions of ``check.expressions``, there are vectors of Rⁿ and n × n matrices:

    vectors    ("vec", "w")  ("sum", x, y, ...)  ("scale", s, x)  ("apply", A, x)
    matrices   ("mat", "M")  ("diag", "w")  ("transpose", A)  ("sum", A, B, ...)  ("scale", s, A)
    numbers    ("dot", x, y)  ("rate", s)   and the operations of ``check.expressions``

``sum`` of nothing is 0, ``diag`` is the diagonal matrix of a vector, ``rate`` the derivative by time.

- ``rates``: the product rule, with the derivative of each letter given;
- ``words``: numbers as expressions in words xᵀ A B … y, each in a normal form;
- ``entries``: the same at one n, entry by entry, without the above; counterexamples are replayed there.

References: ``geddes1992algorithms``, chapter 3.
"""

from __future__ import annotations

import re
from collections.abc import Mapping
from typing import Any

from lyapcheck.check.expressions.expression import LEAVES, Tree, Unsupported, differentiated
from lyapcheck.check.expressions.grammar import MAX_DEPTH, MAX_NAME, SHAPES, is_name
from lyapcheck.check.refusal import require

NAME = re.compile(r"[A-Za-z][A-Za-z0-9_]*")
DIMENSION = "n"
"""What the text of a statement for every n calls the dimension: no letter has that name."""
LETTERS = {"number": "var", "vector": "vec", "matrix": "mat"}
"""The operation that makes a letter of each sort."""
PARTS: dict[tuple[str, str], tuple[str, ...]] = {
    ("number", "dot"): ("vector", "vector"),
    ("number", "rate"): ("number",),
    ("vector", "scale"): ("number", "vector"),
    ("vector", "apply"): ("matrix", "vector"),
    ("matrix", "scale"): ("number", "matrix"),
    ("matrix", "transpose"): ("matrix",),
}
"""The sorts of the parts of an operation that makes a vector, a matrix or a number of them."""


def require_sort(tree: Any, sort: str, rate: bool = False, depth: int = MAX_DEPTH) -> None:
    """Refuse an expression that is not a ``number``, a ``vector`` or a ``matrix``, as ``sort`` says.

    With ``rate`` derivatives may occur; never one inside another.
    """
    plain = isinstance(tree, tuple) and len(tree) > 0 and isinstance(tree[0], str)
    require(plain, "expression", tree, "is not an operation with its parts")
    require(depth > 0, "expression", tree[0], f"is nested deeper than {MAX_DEPTH} levels")
    operation, *parts = tree
    if operation == LETTERS[sort] or (sort, operation) == ("matrix", "diag"):
        known = len(parts) == 1 and isinstance(parts[0], str) and len(parts[0]) <= MAX_NAME
        plain = known and NAME.fullmatch(parts[0]) is not None and is_name(parts[0])
        require(plain, "letter", parts, "is not a name")
        require(parts[0] != DIMENSION, "letter", parts[0], "is the dimension, over which the statement runs")
        return
    require(operation != "rate" or rate, "rate", tree, "may not occur here")
    for part, wanted in zip(parts, _sorts(operation, parts, sort), strict=True):
        if isinstance(part, tuple):
            require_sort(part, wanted, rate and operation != "rate", depth - 1)


def _sorts(operation: str, parts: list[Any], sort: str) -> tuple[str, ...]:
    """The sorts of the parts of an operation; refused if it makes nothing of this sort from so many."""
    result = PARTS.get((sort, operation))
    if operation == "sum" and sort != "number":
        result = (sort,) * len(parts)
    if result is not None:
        fits = len(result) == len(parts) and all(isinstance(part, tuple) for part in parts)
        require(fits, operation, parts, f"needs {len(result)} expressions")
        return result
    shape = SHAPES.get(operation) if sort == "number" else None
    require(shape is not None and shape(parts), "expression", operation, f"does not make a {sort} of these")
    return (sort,) * len(parts)


def letters(tree: Tree) -> set[Tree]:
    """The letters of an expression as expressions; a diagonal matrix has the letter of its vector."""
    if tree[0] in ("var", "vec", "mat"):
        return {tree}
    if tree[0] == "diag":
        return {("vec", tree[1])}
    return set().union(*(letters(part) for part in tree[1:] if isinstance(part, tuple)))


# --- The derivative by time of an expression in numbers, vectors and matrices, from those of its letters.

ZERO: Tree = ("num", "0")
NOTHING: Tree = ("sum",)


def rate(tree: Tree, rates: Mapping[Tree, Tree]) -> Tree:
    """The derivative of an expression without derivatives in it, from those of its letters.

    ``Unsupported``: a letter whose derivative is not given, a function, or diag of a vector that moves.

    Soundness: sums, products, quotients and powers are differentiated by their rules; dot, apply and scale
    are bilinear.
    """

    def other(tree: Tree) -> Tree:
        kind, *rest = tree
        if kind in ("var", "vec", "mat"):
            if tree not in rates:
                raise Unsupported(f"no derivative is given for {rest[0]}")
            return rates[tree]
        if kind == "diag":
            if rates.get(("vec", rest[0])) != NOTHING:
                raise Unsupported(f"diag({rest[0]}) is differentiated only where {rest[0]} is constant")
            return NOTHING
        if kind not in LEAVES:
            raise Unsupported(f"{kind} is not differentiated by time")
        return ZERO

    return differentiated(tree, other)
