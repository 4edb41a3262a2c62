"""Numbers, vectors and matrices at one n, entry by entry: ordinary expressions in w[1], M[1,2], …"""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from fractions import Fraction
from functools import cached_property

from flint import ctx, fmpq

from lyapcheck.check.expressions.expression import (
    ExactAlgebra,
    Tree,
    Unsupported,
    ball,
    derivative,
    evaluate,
    variables,
)
from lyapcheck.check.numbers.polynomials import ball_of, rational, signum

ZERO: Tree = ("num", "0")
BITS = 256
Vector = list[Tree]
Matrix = list[Vector]


class Entries:
    """Expressions at one n >= 1; a symmetric matrix has the variables of its upper half."""

    def __init__(self, n: int, symmetric: Iterable[str], rates: Mapping[Tree, Tree]) -> None:
        self.joints, self.symmetric, self.rates = range(n), frozenset(symmetric), rates

    def number(self, tree: Tree) -> Tree:
        """A number as an ordinary expression."""
        kind, *rest = tree
        if kind == "dot":
            x, y = self.vector(rest[0]), self.vector(rest[1])
            return _sum([("mul", a, b) for a, b in zip(x, y, strict=True)])
        if kind == "rate":
            inner = self.number(rest[0])
            names = sorted(variables(inner))
            for name in names:
                if name not in self.moving:
                    raise Unsupported(f"no derivative is given for {name}")
            return _sum([("mul", derivative(inner, name), self.moving[name]) for name in names])
        return tuple(self.number(part) if isinstance(part, tuple) else part for part in tree)

    def differentiated(self, tree: Tree) -> list[Tree]:
        """What stands under d/dt; where it has no value, its rate has none."""
        if tree[0] == "rate":
            return [self.number(tree[1])]
        return [
            result for part in tree[1:] if isinstance(part, tuple) for result in self.differentiated(part)
        ]

    def vector(self, tree: Tree) -> Vector:
        """The entries of a vector."""
        kind, *rest = tree
        if kind == "vec":
            return [("var", f"{rest[0]}[{i + 1}]") for i in self.joints]
        if kind == "sum":
            parts = [self.vector(part) for part in rest]
            return [_sum([part[i] for part in parts]) for i in self.joints]
        if kind == "scale":
            factor = self.number(rest[0])
            return [("mul", factor, entry) for entry in self.vector(rest[1])]
        rows, x = self.matrix(rest[0]), self.vector(rest[1])
        return [_sum([("mul", a, b) for a, b in zip(row, x, strict=True)]) for row in rows]

    def matrix(self, tree: Tree) -> Matrix:
        """The rows of a matrix."""
        kind, *rest = tree
        if kind == "mat":
            return [[("var", self._name(rest[0], i, j)) for j in self.joints] for i in self.joints]
        if kind == "diag":
            x = self.vector(("vec", rest[0]))
            return [[x[i] if i == j else ZERO for j in self.joints] for i in self.joints]
        if kind == "transpose":
            return [list(column) for column in zip(*self.matrix(rest[0]), strict=True)]
        if kind == "sum":
            parts = [self.matrix(part) for part in rest]
            return [[_sum([part[i][j] for part in parts]) for j in self.joints] for i in self.joints]
        factor = self.number(rest[0])
        return [[("mul", factor, entry) for entry in row] for row in self.matrix(rest[1])]

    def names(self, letter: Tree) -> list[str]:
        """The variables of a letter: one for a number, one an entry of a vector or a matrix."""
        if letter[0] == "var":
            return [letter[1]]
        if letter[0] == "mat":
            return [entry[1] for row in self.matrix(letter) for entry in row]
        return [entry[1] for entry in self.vector(("vec", letter[1]))]

    def _name(self, name: str, i: int, j: int) -> str:
        if name in self.symmetric:
            i, j = min(i, j), max(i, j)
        return f"{name}[{i + 1},{j + 1}]"

    @cached_property
    def moving(self) -> dict[str, Tree]:
        """The derivative of each variable that has one."""
        result: dict[str, Tree] = {}
        for (kind, name), value in self.rates.items():
            if kind == "var":
                result[name] = self.number(value)
            elif kind == "vec":
                result |= {f"{name}[{i + 1}]": entry for i, entry in enumerate(self.vector(value))}
            else:
                rows = self.matrix(value)
                result |= {self._name(name, i, j): rows[i][j] for i in self.joints for j in self.joints}
        return result


def exact(tree: Tree, point: Mapping[str, Fraction]) -> fmpq:
    """The value of an ordinary expression at a rational point; ``Unsupported`` where it is not rational."""
    return evaluate(tree, {name: rational(value) for name, value in point.items()}, ExactAlgebra())


def compared(left: Tree, right: Tree, point: Mapping[str, Fraction]) -> int | None:
    """The sign of right − left at a point: exactly in ℚ, else by balls; ``None`` where these do not tell."""
    gap: Tree = ("add", right, ("neg", left))
    try:
        value = exact(gap, point)
    except Unsupported:
        with ctx.workprec(BITS):
            value = ball(gap, {name: ball_of(x) for name, x in point.items()})
            return 1 if value > 0 else -1 if value < 0 else None
    return signum(value)


def _sum(parts: list[Tree]) -> Tree:
    return ("add", *parts) if parts else ZERO
