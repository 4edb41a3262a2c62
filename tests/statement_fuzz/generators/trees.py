"""Expressions to build statements from, and words for what is built."""

from __future__ import annotations

from fractions import Fraction
from random import Random
from typing import Any

from tests.statement_fuzz.subject import Relation

Tree = tuple[Any, ...]

SMOOTH = ("sin", "cos", "exp", "sinh", "cosh", "tanh", "atan")
PARTIAL = ("sqrt", "log", "tan", "asin", "acos")


def num(value: Fraction | int | str) -> Tree:
    """A number."""
    return ("num", str(Fraction(value)))


def var(name: str) -> Tree:
    """A variable."""
    return ("var", name)


def add(*parts: Tree) -> Tree:
    """A sum."""
    return ("add", *parts) if len(parts) > 1 else parts[0]


def mul(*parts: Tree) -> Tree:
    """A product."""
    return ("mul", *parts) if len(parts) > 1 else parts[0]


def neg(a: Tree) -> Tree:
    """The negative."""
    return ("neg", a)


def sub(a: Tree, b: Tree) -> Tree:
    """A difference, as scripts write it."""
    return ("add", a, ("neg", b))


def div(a: Tree, b: Tree) -> Tree:
    """A quotient."""
    return ("div", a, b)


def power(a: Tree, k: int) -> Tree:
    """A power."""
    return ("pow", a, k)


def root(a: Tree) -> Tree:
    """A square root."""
    return ("sqrt", a)


ZERO, ONE, TWO = num(0), num(1), num(2)


def le(a: Tree, b: Tree) -> Relation:
    """a <= b."""
    return Relation(a, "<=", b)


def lt(a: Tree, b: Tree) -> Relation:
    """a < b."""
    return Relation(a, "<", b)


def relation(random: Random, a: Tree, b: Tree) -> Relation:
    """a <= b or a < b."""
    return Relation(a, random.choice(("<=", "<")), b)


def small_number(random: Random) -> Fraction:
    """What users write: small integers and short fractions, now and then a huge or tiny number."""
    kind = random.random()
    if kind < 0.6:
        return Fraction(random.randint(-6, 6))
    if kind < 0.95:
        return Fraction(random.randint(-20, 20), random.choice((2, 3, 4, 5, 10, 100)))
    return Fraction(random.choice((1, -1)) * 10 ** random.choice((6, 9, 30))) ** random.choice((1, -1))


def nonzero(random: Random) -> Fraction:
    """The same, not 0."""
    value = small_number(random)
    return value if value else Fraction(1)


def positive(random: Random) -> Fraction:
    """The same, above 0."""
    return abs(nonzero(random))


def smooth(random: Random, names: list[str], depth: int = 2) -> Tree:
    """An expression that is defined everywhere."""
    if depth == 0 or random.random() < 0.15:
        if not names or random.random() < 0.35:
            return constant(random) if random.random() < 0.3 else num(small_number(random))
        return var(random.choice(names))
    a, b = smooth(random, names, depth - 1), smooth(random, names, depth - 1)
    shapes: tuple[Tree, ...] = (
        *((kind, a, b) for kind in ("add", "add", "mul", "mul")),
        neg(a),
        power(a, random.choice((0, 1, 2, 2, 3, 4))),
        (random.choice((*SMOOTH, "abs")), a),
        div(a, add(power(b, 2), num(positive(random)))),
        (random.choice(("h", "dh", "potential")), random.choice((1, 2, 3)), a),
    )
    return random.choice(shapes)


def constant(random: Random) -> Tree:
    """A number with a name."""
    return random.choice(
        (
            ("pi",),
            ("gamma", random.randint(1, 4)),
            ("rho", random.randint(1, 3)),
            ("L", random.randint(1, 3)),
            root(num(random.choice((2, 3, 5, 6, 8, 12, Fraction(1, 2), Fraction(4, 9))))),
            ("exp", num(random.choice((1, 2, -1)))),
            ("log", num(random.choice((2, 3, 4)))),
        )
    )


def rough(random: Random, names: list[str], depth: int = 2) -> Tree:
    """An expression that may be undefined somewhere."""
    if depth == 0:
        return smooth(random, names, 1)
    kind = random.choice(("smooth", "partial", "div", "add", "mul", "double", "power 0"))
    a = rough(random, names, depth - 1)
    if kind == "smooth":
        return smooth(random, names, depth)
    if kind == "partial":
        return (random.choice(PARTIAL), a)
    if kind == "double":
        return div(ONE, div(ONE, a))
    if kind == "power 0":
        return power(a, random.choice((0, 0, 2)))
    b = rough(random, names, depth - 1)
    return div(a, b) if kind == "div" else (kind, a, b)
