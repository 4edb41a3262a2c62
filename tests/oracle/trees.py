"""Expressions at a point, and at many points in floating point: where to look, never what is so."""

from fractions import Fraction
from functools import lru_cache
from math import prod

import numpy as np

from tests.oracle.numbers import Unsure, apply, constant, divide, family, lifted, member, pi, power, sign

LEAVES = ("num", "var", "pi", "gamma", "rho", "L")
MEMBERS = ("h", "dh", "potential")
ARITHMETIC = {"add": sum, "mul": prod, "neg": lambda parts: -parts[0]}
ALIAS = {"asin": "arcsin", "acos": "arccos", "atan": "arctan"}


class Evaluation:
    """Values at one point; a part that stands in several places is worked out once.

    ``divisors`` lists the sign of each divisor that was met, by its tree.
    """

    def __init__(self, point):
        self.point, self.known, self.divisors = point, {}, {}

    def of(self, tree):
        """The value of an expression; raises ``Undefined`` or ``Unsure``."""
        if id(tree) not in self.known:
            self.known[id(tree)] = tree, self.node(*tree)
        return self.known[id(tree)][1]

    def node(self, kind, *rest):
        """The value of one operation."""
        if kind in LEAVES:
            return self.point[rest[0]] if kind == "var" else leaf(kind, *rest)
        if kind in MEMBERS:
            return member(kind, rest[0], self.of(rest[1]))
        if kind == "pow":
            return self.power(self.of(rest[0]), rest[1])
        parts = self.parts(rest)
        if kind in ARITHMETIC:
            return ARITHMETIC[kind](parts)
        if kind == "div":
            return self.quotient(rest[1], *parts)
        if kind == "tan":
            self.divisors["cos", rest[0]] = sign(apply("cos", parts[0]))
        return self.applied(kind, parts[0])

    def parts(self, trees):
        """All values: one that does not exist makes it undefined, even beside one that is not known."""
        result, unsure = [], False
        for tree in trees:
            try:
                result.append(self.of(tree))
            except Unsure:
                unsure = True
        if unsure:
            raise Unsure
        return result

    def applied(self, name, x):
        """A function of a number."""
        return apply(name, x)

    def power(self, base, k):
        """A natural power."""
        return power(base, k)

    def quotient(self, divisor, top, bottom):
        """A quotient by the value of a divisor."""
        self.divisors[divisor] = sign(bottom)
        return divide(top, bottom)


def leaf(kind, which=None):
    """A number that is written, or has a name."""
    if kind == "num":
        return Fraction(which)
    return pi() if kind == "pi" else constant(kind, which)


def names(*trees):
    """The variables of expressions."""
    return {node[1] for node in nodes(*trees) if node[0] == "var"}


def nodes(*trees):
    """All nodes of expressions, a shared one once."""
    waiting, seen = list(trees), {id(tree) for tree in trees}
    while waiting:
        node = waiting.pop()
        yield node
        for part in node[1:]:
            if isinstance(part, tuple) and id(part) not in seen:
                seen.add(id(part))
                waiting.append(part)


def floats(tree, points, known):
    """An expression at many points in doubles; NaN or infinite where it is undefined."""
    if id(tree) not in known:
        known[id(tree)] = _floats(tree, points, known)
    return known[id(tree)]


def _floats(tree, points, known):
    kind, *rest = tree
    if kind == "var":
        return points[rest[0]]
    if kind in LEAVES:
        return _number(*tree)
    if kind in MEMBERS:
        return family(kind, rest[0], floats(rest[1], points, known), np)
    if kind == "pow":
        base = floats(rest[0], points, known)
        return base ** np.float64(rest[1]) if rest[1] else base * 0 + 1
    parts = [floats(part, points, known) for part in rest]
    if kind in ARITHMETIC:
        return ARITHMETIC[kind](parts)
    return np.divide(*parts) if kind == "div" else getattr(np, ALIAS.get(kind, kind))(parts[0])


@lru_cache(maxsize=4096)
def _number(kind, which=None):
    try:
        value = leaf(kind, which)
        return np.float64(float(value if isinstance(value, Fraction) else lifted(value).low))
    except OverflowError:
        return np.float64("inf") * (1 if Fraction(which) > 0 else -1)
    except Unsure:
        return np.float64("nan")
