"""Expressions in vectors and matrices at rational entries; derivatives by dual numbers."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from fractions import Fraction
from typing import Any

from tests.statement_fuzz.oracle import functions
from tests.statement_fuzz.oracle.evaluate import Evaluation, Tree
from tests.statement_fuzz.oracle.numbers import Unsure, Value, divide, power

Letter = tuple[str, str]
Values = dict[Letter, Any]
"""Numbers, lists of entries and lists of rows, by letter."""


@dataclass(frozen=True)
class Dual:
    """A number that moves, with its speed."""

    value: Value
    speed: Value

    def __add__(self, other: Any) -> Dual:
        other = _dual(other)
        return Dual(self.value + other.value, self.speed + other.speed)

    __radd__ = __add__

    def __neg__(self) -> Dual:
        return Dual(-self.value, -self.speed)

    def __mul__(self, other: Any) -> Dual:
        other = _dual(other)
        return Dual(self.value * other.value, self.value * other.speed + self.speed * other.value)

    __rmul__ = __mul__

    def over(self, other: Dual) -> Dual:
        """The quotient."""
        value = divide(self.value, other.value)
        return Dual(value, divide(self.speed + -(value * other.speed), other.value))


def _moved(name: str, inner: Dual) -> Dual:
    """A function of a number that moves."""
    value = functions.apply(name, inner.value)
    slopes = {
        "log": lambda: divide(Fraction(1), inner.value),
        "exp": lambda: value,
        "sqrt": lambda: divide(Fraction(1, 2), value),
        "sin": lambda: functions.apply("cos", inner.value),
        "cos": lambda: -functions.apply("sin", inner.value),
    }
    if name not in slopes:
        raise Unsure
    return Dual(value, slopes[name]() * inner.speed)


def _dual(value: Any) -> Dual:
    return value if isinstance(value, Dual) else Dual(value, Fraction(0))


class Entries(Evaluation):
    """Expressions in numbers, vectors and matrices at values of the letters."""

    def __init__(self, values: Values, n: int, rates: Mapping[Letter, Tree]) -> None:
        super().__init__({name: value for (sort, name), value in values.items() if sort == "var"})
        self.values, self.n, self.rates = values, n, rates

    def _of(self, tree: Tree) -> Any:
        kind, *rest = tree
        if kind == "dot":
            x, y = self.vector(rest[0]), self.vector(rest[1])
            return sum((a * b for a, b in zip(x, y, strict=True)), Fraction(0))
        if kind == "rate":
            return _dual(self._moving().of(rest[0])).speed
        if kind in functions.BY_NAME and isinstance(inner := self.of(rest[0]), Dual):
            return _moved(kind, inner)
        return super()._of(tree)

    def power(self, base: Any, k: int) -> Any:
        if not isinstance(base, Dual):
            return power(base, k)
        result: Any = Fraction(1)
        for _ in range(k):
            result = result * base
        return result

    def _quotient(self, divisor: Tree, top: Any, bottom: Any) -> Any:
        if isinstance(top, Dual) or isinstance(bottom, Dual):
            return _dual(top).over(_dual(bottom))
        return super()._quotient(divisor, top, bottom)

    def _moving(self) -> Entries:
        """The same letters with their speeds."""
        moved = dict(self.values)
        for letter, speed in self.rates.items():
            if letter in moved:
                moved[letter] = _with(moved[letter], self.any(letter[0], speed))
        return Entries(moved, self.n, {})

    def any(self, sort: str, tree: Tree) -> Any:
        """An expression of a sort."""
        return {"var": self.of, "vec": self.vector, "mat": self.matrix}[sort](tree)

    def vector(self, tree: Tree) -> list[Any]:
        """The entries of a vector."""
        kind, *rest = tree
        if kind == "vec":
            return list(self.values["vec", rest[0]])
        if kind == "sum":
            parts = [self.vector(part) for part in rest]
            return [sum((part[i] for part in parts), Fraction(0)) for i in range(self.n)]
        if kind == "scale":
            factor = self.of(rest[0])
            return [factor * entry for entry in self.vector(rest[1])]
        x = self.vector(rest[1])
        return [
            sum((a * b for a, b in zip(row, x, strict=True)), Fraction(0)) for row in self.matrix(rest[0])
        ]

    def matrix(self, tree: Tree) -> list[list[Any]]:
        """The rows of a matrix."""
        kind, *rest = tree
        if kind == "mat":
            return [list(row) for row in self.values["mat", rest[0]]]
        if kind == "diag":
            x = self.values["vec", rest[0]]
            return [[x[i] if i == j else Fraction(0) for j in range(self.n)] for i in range(self.n)]
        if kind == "transpose":
            rows = self.matrix(rest[0])
            return [[rows[j][i] for j in range(self.n)] for i in range(self.n)]
        if kind == "sum":
            parts = [self.matrix(part) for part in rest]
            return [
                [sum((part[i][j] for part in parts), Fraction(0)) for j in range(self.n)]
                for i in range(self.n)
            ]
        factor = self.of(rest[0])
        return [[factor * entry for entry in row] for row in self.matrix(rest[1])]


def _with(value: Any, speed: Any) -> Any:
    if isinstance(value, list):
        return [_with(a, b) for a, b in zip(value, speed, strict=True)]
    return Dual(value, speed)
