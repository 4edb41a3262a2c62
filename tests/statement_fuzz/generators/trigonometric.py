"""Polynomials in sines and cosines against bounds."""

from __future__ import annotations

from fractions import Fraction
from random import Random

from tests.statement_fuzz.generators import Made, generates
from tests.statement_fuzz.generators.traps import disguised
from tests.statement_fuzz.generators.trees import Tree, add, div, mul, num, power, small_number, var
from tests.statement_fuzz.subject import TrigonometricBound, TrigonometricPositive

ANGLES = ("q1", "q2")


def polynomial(random: Random) -> Tree:
    """A sum of products of powers of sines and cosines."""
    parts = []
    for _ in range(random.randint(1, 3)):
        factors = [
            (random.choice(("sin", "cos")), var(random.choice(ANGLES))) for _ in range(random.randint(0, 2))
        ]
        parts.append(
            mul(num(small_number(random)), *(power(f, random.choice((1, 1, 2, 0))) for f in factors))
        )
    tree = add(*parts)
    if random.random() < 0.25:
        tree = disguised(random, tree, ["q1"])
    if random.random() < 0.1:
        tree = div(tree, num(random.choice((2, -3, "1/2", 0))))
    return tree


def _swing(tree: Tree) -> Fraction:
    """A bound by sizes, or anything."""
    kind, *rest = tree
    if kind == "num":
        return abs(Fraction(rest[0]))
    if kind == "add":
        return sum((_swing(part) for part in rest), Fraction(0))
    if kind == "mul":
        result = Fraction(1)
        for part in rest:
            result *= _swing(part)
        return result
    return Fraction(1)


@generates("TrigonometricBound", 5)
def bound(random: Random) -> Made:
    """|f_i| within bounds that suffice, or not quite."""
    entries = []
    for _ in range(random.randint(1, 2)):
        tree = polynomial(random)
        limit = _swing(tree) * random.choice(
            (1, 1, Fraction(999999, 1000000), Fraction(1, 2), Fraction(3, 4))
        )
        entries.append((tree, None if random.random() < 0.2 else limit))
    return Made(TrigonometricBound(tuple(entries)), "bounds of sines and cosines")


@generates("TrigonometricPositive", 4)
def positive(random: Random) -> Made:
    """f_i + c positive, with c that suffices, or not quite."""
    entries = []
    for _ in range(random.randint(1, 2)):
        tree = polynomial(random)
        c = _swing(tree) * random.choice((1, Fraction(1000001, 1000000), 2, Fraction(1, 2), 0))
        entries.append(add(tree, num(c)))
    return Made(TrigonometricPositive(tuple(entries)), "sines and cosines above 0")
