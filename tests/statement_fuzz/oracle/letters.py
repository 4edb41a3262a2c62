"""Statements about vectors and matrices: rational entries at n = 1, 2, 3, derivatives by dual numbers."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from fractions import Fraction
from itertools import product
from random import Random
from typing import Any

from mpmath import mp

from tests.statement_fuzz.oracle import exact, functions, kinds
from tests.statement_fuzz.oracle.evaluate import Evaluation, Tree, names, nodes
from tests.statement_fuzz.oracle.numbers import DIGITS, Undefined, Unsure, Value, divide, power, sign
from tests.statement_fuzz.oracle.region import Objection, holds

SIZES = (1, 2, 3)
TRIES = 6
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


# Points ---------------------------------------------------------------------------------------------------


def letters_of(*trees: Tree) -> set[Letter]:
    """The letters of expressions."""
    found = set()
    for node in nodes(*trees):
        if node[0] in ("var", "vec", "mat"):
            found.add((node[0], node[1]))
        elif node[0] == "diag":
            found.add(("vec", node[1]))
    return found


def all_letters(statement: Any) -> list[Letter]:
    """All letters of a statement."""
    trees = [statement.left, *(tree for pair in statement.rates for tree in pair)]
    trees += [known.equals for known in statement.given]
    found = letters_of(*trees)
    if type(statement).__name__ == "EveryN":
        found |= letters_of(statement.right)
    for known in statement.given:
        found |= {("mat", known.matrix), ("vec", known.vector)}
    return sorted(found)


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


def _places(statement: Any, random: Random) -> Iterator[Entries]:
    for k, n in product(range(TRIES), SIZES):
        values = drawn(statement, n, random, k % 3)
        found = solved(statement, values, n)
        if found is not None:
            yield Entries(found, n, dict(statement.rates))


# The kinds --------------------------------------------------------------------------------------------------


@kinds.objections_to("EveryN")
def every_n(statement: Any, random: Random) -> Objection | None:
    """Entries at which the sides differ, or one of them is undefined."""
    with mp.workdps(DIGITS):
        for at in _places(statement, random):
            try:
                if not meets(statement, at):
                    continue
                equal = holds("=", at.of(statement.left), at.of(statement.right))
            except Undefined as why:
                return Objection("undefined", f"{_shown(at)} ({why})")
            except Unsure:
                continue
            if not equal:
                return Objection("false", _shown(at))
    return None


def _shown(at: Entries) -> str:
    return f"n = {at.n}, " + ", ".join(f"{name} = {_text(value)}" for (_, name), value in at.values.items())


def _text(value: Any) -> str:
    return "[" + ", ".join(map(_text, value)) + "]" if isinstance(value, list) else str(value)


@kinds.judges("EveryN")
def entries_refute(statement: Any, witness: Mapping[str, Any]) -> bool | None:
    """Whether entries refute an identity."""
    point = dict(witness["point"])
    n = int(point.pop("n"))
    values: Values = {}
    for sort, name in all_letters(statement):
        values[sort, name] = _read(sort, name, n, point, name in statement.symmetric)
    at = Entries(values, n, dict(statement.rates))
    try:
        positive = getattr(statement, "positive", ()) or ()
        ranges = all(values.get(("var", name), 1) > 0 for name in positive)
        return (
            ranges and meets(statement, at) and not holds("=", at.of(statement.left), at.of(statement.right))
        )
    except Undefined:
        return False
    except Unsure:
        return None


def _read(sort: str, name: str, n: int, point: Mapping[str, str], symmetric: bool) -> Any:
    """The value of a letter; an entry that the witness does not give does not matter and is 1."""
    if sort == "var":
        return Fraction(point.get(name, "1"))
    if sort == "vec":
        return [Fraction(point.get(f"{name}[{i + 1}]", "1")) for i in range(n)]

    def entry(i: int, j: int) -> Fraction:
        i, j = (min(i, j), max(i, j)) if symmetric else (i, j)
        return Fraction(point.get(f"{name}[{i + 1},{j + 1}]", "1"))

    return [[entry(i, j) for j in range(n)] for i in range(n)]


@kinds.objections_to("BoundEveryN")
def bound_every_n(statement: Any, random: Random) -> Objection | None:
    """Letters scaled to the border of what the norms allow, at which the left side exceeds the right."""
    with mp.workdps(DIGITS), exact.kept(False):
        for k in range(40):
            n = (1, 1, 2)[k % 3]
            found = _try_bound(statement, n, random)
            if found is not None:
                return found
    return None


def _try_bound(statement: Any, n: int, random: Random) -> Objection | None:
    sizes = [size for _, size in (*statement.norms, *statement.least)]
    variables = sorted(names(statement.right, *sizes))
    free = {name: Fraction(random.choice((0, 1, 1, 2, 5, 9)), random.choice((1, 2, 3))) for name in variables}
    extra = [letter for letters, _ in statement.norms for letter in letters]
    values: Values = {}
    for sort, name in sorted(
        set(all_letters(statement)) | letters_of(*extra, *(a for a, _ in statement.least))
    ):
        values[sort, name] = _sharp(sort, name, n, random, name in statement.symmetric)
    values |= {("var", name): value for name, value in free.items()}
    at = Entries(values, n, dict(statement.rates))
    try:
        for letters, size in statement.norms:
            allowed = at.of(size)
            if sign(allowed) < 0:
                return None
            values = _scaled(values, letters, allowed, n)
            at = Entries(values, n, dict(statement.rates))
        moved = solved(statement, values, n)
        if moved is None:
            return None
        at = Entries(moved, n, dict(statement.rates))
        fits = meets(statement, at) and all(_within(at, *known) for known in statement.norms)
        if not fits or not all(holds("<=", at.of(low), at.of(number)) for number, low in statement.least):
            return None
        if holds("<=", at.of(statement.left), at.of(statement.right)):
            return None
    except Undefined as why:
        return Objection("undefined", f"{_shown(at)} ({why})")
    except Unsure:
        return None
    return Objection("false", _shown(at))


def _sharp(sort: str, name: str, n: int, random: Random, symmetric: bool) -> Any:
    """Numbers >= 0, vectors along an axis, and multiples of rotations or reflections: norms are rational."""
    s = Fraction(random.choice((1, -1)))
    if sort == "var":
        return Fraction(random.randint(0, 5))
    if sort == "vec":
        return [s, Fraction(0)][:n] if n < 2 or random.random() < 0.5 else [Fraction(0), s]
    if n == 1:
        return [[s]]
    kind = random.randrange(3)
    if kind == 0:
        return [[s, Fraction(0)], [Fraction(0), s]]
    a, b = random.choice(((Fraction(3, 5), Fraction(4, 5)), (Fraction(0), Fraction(1))))
    return [[a, b], [b, -a]] if symmetric or kind == 1 else [[a, -b], [b, a]]


def norm(value: Any) -> Fraction:
    """The size of what :func:`_sharp` makes: a number, a vector along an axis, a multiple of an isometry."""
    if not isinstance(value, list):
        return abs(value)
    if not isinstance(value[0], list):
        square = sum((a * a for a in value), Fraction(0))
    else:
        square = sum((a * a for a in value[0]), Fraction(0))
        if any(sum((a * a for a in row), Fraction(0)) != square for row in value):
            raise Unsure
        if len(value) > 1 and sum(a * b for a, b in zip(*value, strict=True)):
            raise Unsure
    root = Fraction(_isqrt(square.numerator), _isqrt(square.denominator))
    if root * root != square:
        raise Unsure
    return root


def _isqrt(value: int) -> int:
    from math import isqrt

    return isqrt(value)


def _letter_value(values: Values, letter: Tree) -> Any:
    if letter[0] == "diag":
        x = values["vec", letter[1]]
        return [max((abs(a) for a in x), default=Fraction(0))]
    return values[letter[0], letter[1]]


def _scaled(values: Values, letters: Any, allowed: Value, n: int) -> Values:
    """The first letter made as large as a bound on a product allows, unless the product is within it."""
    total = Fraction(1)
    for letter in letters:
        total *= norm(_letter_value(values, letter))
    if not letters or not isinstance(allowed, Fraction) or total == 0:
        return values
    first = letters[0]
    key = ("vec", first[1]) if first[0] == "diag" else (first[0], first[1])
    return {**values, key: _times(values[key], allowed / total)}


def _times(value: Any, factor: Fraction) -> Any:
    return [_times(part, factor) for part in value] if isinstance(value, list) else value * factor


def _within(at: Entries, letters: Any, size: Tree) -> bool:
    total = Fraction(1)
    for letter in letters:
        total *= norm(_letter_value(at.values, letter))
    return holds("<=", total, at.of(size))
