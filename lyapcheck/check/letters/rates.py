"""The derivative by time of an expression in numbers, vectors and matrices, from those of its letters."""

from __future__ import annotations

from collections.abc import Mapping

from lyapcheck.check.expressions.expression import LEAVES, Tree, Unsupported, differentiated

ZERO: Tree = ("num", "0")
NOTHING: Tree = ("sum",)


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
