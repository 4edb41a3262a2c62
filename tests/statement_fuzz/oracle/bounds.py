"""Bounds for every n: letters scaled to the border of what the norms allow."""

from __future__ import annotations

from collections.abc import Mapping
from fractions import Fraction
from math import isqrt
from random import Random
from typing import Any

from mpmath import mp

from tests.statement_fuzz.oracle import exact, kinds
from tests.statement_fuzz.oracle.entries import (
    all_letters,
    letters_of,
    meets,
    read_letter,
    shown_entries,
    solved,
)
from tests.statement_fuzz.oracle.evaluate import Tree, names
from tests.statement_fuzz.oracle.letters import Entries, Letter, Values
from tests.statement_fuzz.oracle.numbers import DIGITS, Undefined, Unsure, Value, power, sign
from tests.statement_fuzz.oracle.region import Objection, holds


@kinds.objections_to("BoundEveryN")
def bound_every_n(statement: Any, random: Random) -> Objection | None:
    """Letters scaled to the border of what the norms allow, at which the left side exceeds the right."""
    with mp.workdps(DIGITS), exact.kept(False):
        for k in range(40):
            n = (1, 1, 2)[k % 3]
            result = _try_bound(statement, n, random)
            if result is not None:
                return result
    return None


def _try_bound(statement: Any, n: int, random: Random) -> Objection | None:
    values = _values(statement, n, random)
    at = Entries(values, n, dict(statement.rates))
    try:
        at = _at_the_border(statement, values, n)
        if at is None or holds("<=", at.of(statement.left), at.of(statement.right)):
            return None
    except Undefined as why:
        return Objection("undefined", f"{shown_entries(at or Entries(values, n, {}))} ({why})")
    except Unsure:
        return None
    return Objection("false", shown_entries(at))


def _values(statement: Any, n: int, random: Random) -> Values:
    """Values of all letters, and of the variables of all sizes, none of them negative."""
    sizes = [size for _, size in (*statement.norms, *statement.least)]
    variables = sorted(names(statement.right, *sizes))
    free = {name: Fraction(random.choice((0, 1, 1, 2, 5, 9)), random.choice((1, 2, 3))) for name in variables}
    values: Values = {}
    for sort, name in letters_of_bound(statement):
        values[sort, name] = _sharp(sort, name, n, random, name in statement.symmetric)
    values |= {("var", name): value for name, value in free.items()}
    return values


def letters_of_bound(statement: Any) -> list[Letter]:
    """All letters of a statement, those of its norms and sizes among them."""
    sizes = [size for _, size in (*statement.norms, *statement.least)]
    extra = [letter for letters, _ in statement.norms for letter in letters]
    result = letters_of(*extra, *(number for number, _ in statement.least), statement.right, *sizes)
    return sorted(set(all_letters(statement)) | result)


def _at_the_border(statement: Any, values: Values, n: int) -> Entries | None:
    """The letters as large as the norms allow; ``None`` where something that is given fails."""
    rates = dict(statement.rates)
    for letters, size in statement.norms:
        allowed = Entries(values, n, rates).of(size)
        if sign(allowed) < 0:
            return None
        values = _scaled(values, letters, allowed)
    moved = solved(statement, values, n)
    if moved is None:
        return None
    at = Entries(moved, n, rates)
    fits = meets(statement, at) and all(_within(at, *known) for known in statement.norms)
    least = fits and all(holds("<=", at.of(low), at.of(number)) for number, low in statement.least)
    return at if least else None


def _sharp(sort: str, name: str, n: int, random: Random, symmetric: bool) -> Any:
    """Numbers >= 0, vectors along an axis, and multiples of rotations or reflections: norms are rational."""
    side = Fraction(random.choice((1, -1)))
    if sort == "var":
        return Fraction(random.randint(0, 5))
    if sort == "vec":
        axis = random.randrange(n)
        return [side if k == axis else Fraction(0) for k in range(n)]
    return [[side]] if n == 1 else _isometry(random, side, symmetric)


def _isometry(random: Random, side: Fraction, symmetric: bool) -> list[list[Fraction]]:
    zero = Fraction(0)
    a, b = random.choice(((Fraction(3, 5), Fraction(4, 5)), (zero, Fraction(1))))
    reflection = [[a, b], [b, -a]]
    return random.choice(
        ([[side, zero], [zero, side]], reflection, reflection if symmetric else [[a, -b], [b, a]])
    )


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
    root = Fraction(isqrt(square.numerator), isqrt(square.denominator))
    if root * root != square:
        raise Unsure
    return root


def _letter_value(values: Values, letter: Tree) -> Any:
    if letter[0] == "diag":
        x = values["vec", letter[1]]
        return [max((abs(a) for a in x), default=Fraction(0))]
    return values[letter[0], letter[1]]


def _scaled(values: Values, letters: Any, allowed: Value) -> Values:
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


@kinds.judges("BoundEveryN")
def entries_break(statement: Any, witness: Mapping[str, Any]) -> bool | None:
    """Whether entries break a bound while the norms hold; ``None`` for matrices whose norm is not plain."""
    point = dict(witness["point"])
    n = int(point.pop("n"))
    letters = letters_of_bound(statement)
    values = {
        (sort, name): read_letter(sort, name, n, point, name in statement.symmetric) for sort, name in letters
    }
    at = Entries(values, n, dict(statement.rates))
    if any(value < 0 for (sort, _), value in values.items() if sort == "var"):
        return False
    try:
        with mp.workdps(DIGITS):
            least = all(holds("<=", at.of(low), at.of(number)) for number, low in statement.least)
            if not meets(statement, at) or not least:
                return False
            norms = [_certainly_within(at, *known) for known in statement.norms]
            if holds("<=", at.of(statement.left), at.of(statement.right)):
                return False
            return True if all(norms) else None
    except Undefined:
        return False
    except Unsure:
        return None


def _certainly_within(at: Entries, letters: Any, size: Tree) -> bool:
    """Whether a product of norms is within a bound, with Frobenius norms for those of matrices."""
    squares = Fraction(1)
    for letter in letters:
        if letter[0] == "diag":
            squares *= max((a * a for a in at.values["vec", letter[1]]), default=Fraction(0))
        else:
            squares *= sum((a * a for a in _flat(at.values[letter[0], letter[1]])), Fraction(0))
    allowed = at.of(size)
    return sign(allowed) >= 0 and holds("<=", squares, power(allowed, 2))


def _flat(value: Any) -> list[Fraction]:
    return [a for part in value for a in _flat(part)] if isinstance(value, list) else [value]
