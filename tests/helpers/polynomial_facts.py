"""Random facts about polynomials of 2 to 4 variables and degree up to 4, true or false by construction.

Squares plus a constant, or also with squares times a linear hypothesis. In true facts the constant is
positive, or perhaps 0 beside a hypothesis. In false ones all squares vanish at a point, and the constant is
negative, or 0 where > 0 is claimed.
"""

from collections import Counter
from fractions import Fraction
from itertools import combinations_with_replacement
from math import prod

from lyapcheck.claims import expr, implies, reals, var

CONSTANTS = tuple(map(Fraction, ("1/10", "1/2", "1", "3")))
TINY = tuple(map(Fraction, ("1/100", "1/10", "1")))


def fact(random, true):
    """A statement that is true, or false, by construction."""
    names = "xyzw"[: random.randint(2, 4)]
    n, strict = len(names), random.random() < 0.5
    z = [Fraction(random.randint(-4, 4), random.choice((1, 1, 2, 3))) for _ in names]
    goal, given, open_ = squares(random, n, 2, None if true else z), [], False
    if random.random() < 0.5:
        plane, open_ = polynomial(random, n, 1), random.random() < 0.3
        plane = plus(plane, random.choice((0, 1)) * abs(value(plane, z)) - value(plane, z))
        on_border = value(plane, z) == 0
        open_ = open_ and not on_border
        factor = squares(random, n, 1, None if true or on_border else z)
        goal = added(goal, times(factor, plane))
        given = [written(plane, names) > 0 if open_ else written(plane, names) >= 0]
    away = random.choice((0, *CONSTANTS) if given and not strict else CONSTANTS)
    if not true:
        away = -random.choice(TINY)
    if not true and strict and random.random() < 0.25:
        away = 0
    goal = written(plus(goal, away), names)
    return implies(reals(*names), given, goal > 0 if strict else goal >= 0)


def squares(random, n, degree, zero):
    """One to three squares of polynomials, which vanish at a point if one is given."""
    total = {}
    for _ in range(random.randint(1, 3)):
        one = polynomial(random, n, degree)
        if zero is not None:
            one = plus(one, -value(one, zero))
        total = added(total, times(one, one))
    return total


def polynomial(random, n, degree):
    """A few terms, at least one of which is not constant."""
    powers = [e for size in range(degree + 1) for e in combinations_with_replacement(range(n), size)]
    chosen = {random.choice(powers[1:]), *random.sample(powers, random.randint(0, min(4, n)))}
    numbers = (-3, -2, -1, 1, 2, 3, Fraction(1, 2))
    return {tuple(Counter(e)[i] for i in range(n)): Fraction(random.choice(numbers)) for e in sorted(chosen)}


def added(a, b):
    return {e: a.get(e, 0) + b.get(e, 0) for e in {**a, **b}}


def plus(a, constant):
    return added(a, {(0,) * len(next(iter(a))): Fraction(constant)})


def times(a, b):
    result = Counter()
    for e, c in a.items():
        for f, d in b.items():
            result[tuple(i + j for i, j in zip(e, f, strict=True))] += c * d
    return dict(result)


def value(a, point):
    return sum(c * prod(x**k for x, k in zip(point, e, strict=True)) for e, c in a.items())


def written(a, names):
    """As a script writes it, term by term."""
    letters = [var(name) for name in names]
    terms = [
        prod((x**k for x, k in zip(letters, e, strict=True) if k), start=expr(str(c)))
        for e, c in sorted(a.items())
        if c
    ]
    return sum(terms, start=expr(0))
