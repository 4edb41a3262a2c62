"""Rational values of numbers, vectors and matrices that meet what a statement gives."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from fractions import Fraction
from itertools import product
from random import Random
from typing import Any

from tests.statement_fuzz.oracle.evaluate import Tree, nodes
from tests.statement_fuzz.oracle.letters import Entries, Letter, Values

SIZES = (1, 2, 3)
TRIES = 6


def letters_of(*trees: Tree) -> set[Letter]:
    """The letters of expressions."""
    result = set()
    for node in nodes(*trees):
        if node[0] in ("var", "vec", "mat"):
            result.add((node[0], node[1]))
        elif node[0] == "diag":
            result.add(("vec", node[1]))
    return result


def all_letters(statement: Any) -> list[Letter]:
    """All letters of a statement."""
    trees = [statement.left, *(tree for pair in statement.rates for tree in pair)]
    trees += [known.equals for known in statement.given]
    result = letters_of(*trees)
    if type(statement).__name__ == "EveryN":
        result |= letters_of(statement.right)
    for known in statement.given:
        result |= {("mat", known.matrix), ("vec", known.vector)}
    return sorted(result)


def drawn(statement: Any, n: int, random: Random, style: int) -> Values:
    """Values of the letters: anything, zeros among them, equal vectors, or diagonal and unit matrices."""
    positive = set(getattr(statement, "positive", ()) or ())
    values: Values = {}
    for sort, name in all_letters(statement):
        if sort == "var":
            low = 1 if name in positive else -4
            values[sort, name] = Fraction(random.randint(low, 5), random.randint(1, 3))
            if style == 1 and name not in positive and random.random() < 0.5:
                values[sort, name] = Fraction(0)
        elif sort == "vec":
            values[sort, name] = [_entry(random, style) for _ in range(n)]
        else:
            rows = [[_entry(random, style) for _ in range(n)] for _ in range(n)]
            if name in statement.symmetric:
                rows = [[rows[min(i, j)][max(i, j)] for j in range(n)] for i in range(n)]
            values[sort, name] = rows
    if style == 2:
        vectors = [letter for letter in values if letter[0] == "vec"]
        for letter in vectors[1:]:
            values[letter] = list(values[vectors[0]])
    return values


def _entry(random: Random, style: int) -> Fraction:
    if style == 1 and random.random() < 0.6:
        return Fraction(0)
    return Fraction(random.randint(-5, 5), random.randint(1, 2))


def meets(statement: Any, at: Entries) -> bool:
    """Whether all that is given holds, and symmetric matrices keep being so."""
    for known in statement.given:
        left = at.vector(("apply", ("mat", known.matrix), ("vec", known.vector)))
        if left != at.vector(known.equals):
            return False
    for (_, name), value in statement.rates:
        if name in statement.symmetric:
            rows = at.matrix(value)
            if any(rows[i][j] != rows[j][i] for i in range(at.n) for j in range(i)):
                return False
    return True


def solved(statement: Any, values: Values, n: int) -> Values | None:
    """The values with each vector for which A x = b is given replaced by the solution."""
    rates = dict(statement.rates)
    for known in statement.given:
        rows = values["mat", known.matrix]
        x = solution(rows, Entries(values, n, rates).vector(known.equals))
        if x is None:
            return None
        values = {**values, ("vec", known.vector): x}
    return values


def solution(rows: list[list[Fraction]], right: list[Fraction]) -> list[Fraction] | None:
    """The solution of a linear system by elimination; ``None`` if the matrix is singular."""
    n = len(rows)
    table = [[*row, b] for row, b in zip(rows, right, strict=True)]
    for k in range(n):
        pivot = next((i for i in range(k, n) if table[i][k]), None)
        if pivot is None:
            return None
        table[k], table[pivot] = table[pivot], table[k]
        table[k] = [entry / table[k][k] for entry in table[k]]
        for i in range(n):
            if i != k:
                table[i] = [a - table[i][k] * b for a, b in zip(table[i], table[k], strict=True)]
    return [row[-1] for row in table]


def places(statement: Any, random: Random) -> Iterator[Entries]:
    for k, n in product(range(TRIES), SIZES):
        values = drawn(statement, n, random, k % 3)
        result = solved(statement, values, n)
        if result is not None:
            yield Entries(result, n, dict(statement.rates))


def shown_entries(at: Entries) -> str:
    """Values of the letters in words."""
    return f"n = {at.n}, " + ", ".join(f"{name} = {_text(value)}" for (_, name), value in at.values.items())


def _text(value: Any) -> str:
    return "[" + ", ".join(map(_text, value)) + "]" if isinstance(value, list) else str(value)


def read_letter(sort: str, name: str, n: int, point: Mapping[str, str], symmetric: bool) -> Any:
    """The value of a letter in a witness; an entry that it does not give does not matter and is 1."""
    if sort == "var":
        return Fraction(point.get(name, "1"))
    if sort == "vec":
        return [Fraction(point.get(f"{name}[{i + 1}]", "1")) for i in range(n)]

    def entry(i: int, j: int) -> Fraction:
        i, j = (min(i, j), max(i, j)) if symmetric else (i, j)
        return Fraction(point.get(f"{name}[{i + 1},{j + 1}]", "1"))

    return [[entry(i, j) for j in range(n)] for i in range(n)]
