"""Expressions at a point."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Iterator, Mapping
from fractions import Fraction
from typing import Any

from tests.statement_fuzz.oracle import family, functions
from tests.statement_fuzz.oracle.numbers import Unsure, Value, divide, power, sign

Tree = tuple[Any, ...]
Signs = dict[Tree, int]
LEAVES = ("num", "var", "pi", "gamma", "rho", "L")


class Evaluation:
    """Values at one point; a part that stands in several places is worked out once.

    ``divisors`` lists the sign of each divisor that was met, by its tree.
    """

    def __init__(self, point: Mapping[str, Any]) -> None:
        self.point, self.known, self.divisors = point, {}, {}
        self.known: dict[int, tuple[Tree, Any]]
        self.divisors: Signs

    def of(self, tree: Tree) -> Any:
        """The value of an expression.

        Raises:
            Undefined: some part of it certainly has none.
            Unsure: that, or the value, is not known.
        """
        if id(tree) not in self.known:
            self.known[id(tree)] = tree, self._of(tree)
        return self.known[id(tree)][1]

    def _of(self, tree: Tree) -> Any:
        kind, *rest = tree
        if kind in LEAVES:
            return self._leaf(kind, rest)
        if kind in ("h", "dh", "potential"):
            return family.member(kind, rest[0], self.of(rest[1]))
        if kind == "pow":
            return self.power(self.of(rest[0]), rest[1])
        return self._combined(kind, rest)

    def _leaf(self, kind: str, rest: list[Any]) -> Any:
        if kind == "num":
            return Fraction(rest[0])
        if kind == "var":
            return self.point[rest[0]]
        return functions.pi() if kind == "pi" else family.constant(kind, rest[0])

    def _combined(self, kind: str, rest: list[Any]) -> Any:
        parts = self.parts(rest)
        if kind == "div":
            return self._quotient(rest[1], *parts)
        if kind == "tan":
            self.divisors["cos", rest[0]] = sign(functions.apply("cos", parts[0]))
        return ARITHMETIC[kind](parts) if kind in ARITHMETIC else functions.apply(kind, parts[0])

    def parts(self, trees: Iterable[Tree]) -> list[Any]:
        """All values: one that does not exist makes it undefined, even beside one that is not known."""
        unsure: Unsure | None = None
        result = []
        for tree in trees:
            try:
                result.append(self.of(tree))
            except Unsure as problem:
                unsure = problem
        if unsure is not None:
            raise unsure
        return result

    def power(self, base: Any, k: int) -> Any:
        """``base`` to a natural power."""
        return power(base, k)

    def _quotient(self, divisor: Tree, top: Value, bottom: Value) -> Value:
        self.divisors[divisor] = sign(bottom)
        return divide(top, bottom)


def _product(parts: list[Value]) -> Value:
    result = parts[0]
    for part in parts[1:]:
        result = result * part
    return result


ARITHMETIC: dict[str, Callable[[list[Value]], Value]] = {
    "add": lambda parts: sum(parts[1:], parts[0]),
    "mul": _product,
    "neg": lambda parts: -parts[0],
}


def names(*trees: Any) -> set[str]:
    """The variables of expressions."""
    return {node[1] for node in nodes(*trees) if node[0] == "var"}


def nodes(*trees: Any) -> Iterator[Any]:
    """All nodes of expressions, a shared one once."""
    waiting, seen = list(trees), {id(tree) for tree in trees}
    while waiting:
        node = waiting.pop()
        yield node
        for part in node[1:]:
            if isinstance(part, tuple) and id(part) not in seen:
                seen.add(id(part))
                waiting.append(part)
