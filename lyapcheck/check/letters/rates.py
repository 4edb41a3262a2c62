"""The derivative by time of an expression in numbers, vectors and matrices, from those of its letters."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

from lyapcheck.check.expressions.expression import LEAVES, Tree, Unsupported

ZERO: Tree = ("num", "0")
NOTHING: Tree = ("sum",)
PRODUCTS = {"mul": "add", "dot": "add", "scale": "sum", "apply": "sum"}
"""The operations with a product rule, and the sum that it makes."""


def rate(tree: Tree, rates: Mapping[Tree, Tree]) -> Tree:
    """The derivative of an expression.

    Args:
        tree: numbers, vectors or matrices without a derivative in it.
        rates: the derivative of each letter in it, by the letter.

    Raises:
        Unsupported: a letter whose derivative is not given, a function, or diag of a vector that moves.

    Soundness: sums, products, quotients and powers are differentiated by their rules; dot, apply and scale
    are bilinear.
    """
    kind, *rest = tree
    if kind in ("var", "vec", "mat"):
        if tree not in rates:
            raise Unsupported(f"no derivative is given for {rest[0]}")
        return rates[tree]
    if kind == "diag":
        if rates.get(("vec", rest[0])) != NOTHING:
            raise Unsupported(f"diag({rest[0]}) is differentiated only where {rest[0]} is constant")
        return NOTHING
    return ZERO if kind in LEAVES else _by_rule(kind, rest, rates)


def _by_rule(kind: str, rest: list[Any], rates: Mapping[Tree, Tree]) -> Tree:
    """The rule of an operation with parts."""
    if kind in ("add", "sum", "neg", "transpose"):
        return (kind, *(rate(part, rates) for part in rest))
    if kind in PRODUCTS:
        each = ((kind, *rest[:k], rate(part, rates), *rest[k + 1 :]) for k, part in enumerate(rest))
        return (PRODUCTS[kind], *each)
    if kind == "pow":
        base, k = rest
        return ("mul", ("num", str(k)), ("pow", base, k - 1), rate(base, rates)) if k else ZERO
    if kind == "div":
        top, bottom = rest
        turned = ("add", ("mul", rate(top, rates), bottom), ("neg", ("mul", top, rate(bottom, rates))))
        return ("div", turned, ("pow", bottom, 2))
    raise Unsupported(f"{kind} is not differentiated by time")
