"""Identities: expanded polynomials, laws of functions where they hold and where they do not, disguises."""

from __future__ import annotations

from collections import Counter
from dataclasses import fields, replace
from fractions import Fraction
from random import Random

from tests.statement_fuzz.generators import FALSE, TRUE, Made, generates
from tests.statement_fuzz.generators.traps import disguised, hidden_zero
from tests.statement_fuzz.generators.trees import (
    ONE,
    TWO,
    Tree,
    add,
    div,
    mul,
    neg,
    nonzero,
    num,
    power,
    root,
    rough,
    small_number,
    smooth,
    sub,
    var,
)
from tests.statement_fuzz.subject import Identity, Variable

NAMES = ["x", "y", "v"]


@generates("Identity", 26)
def make(random: Random) -> Made:
    """One identity."""
    kind = random.random()
    if kind < 0.35:
        return _polynomial(random)
    if kind < 0.75:
        return _law(random)
    if kind < 0.9:
        a = smooth(random, NAMES[: random.randint(1, 3)], 2)
        return Made(_identity(random, disguised(random, a, NAMES[:2]), a), "a disguised expression")
    a = rough(random, NAMES[:2], 3)
    return Made(
        _identity(random, a, rough(random, NAMES[:2], 2) if random.random() < 0.5 else a), "random sides"
    )


def _identity(random: Random, left: Tree, right: Tree) -> Identity:
    """An identity, sometimes with ranges of its variables, where the kind knows them."""
    if random.random() < 0.5:
        left, right = right, left
    if "variables" in {field.name for field in fields(Identity)} and random.random() < 0.5:
        found = [
            Variable(name, Fraction(random.choice((0, 0, 1, -1))), random.random() < 0.6) for name in NAMES
        ]
        from tests.statement_fuzz.oracle.evaluate import names

        used = names(left, right)
        return replace(Identity(left, right), variables=tuple(v for v in found if v.name in used))  # type: ignore[call-arg]
    return Identity(left, right)


Poly = Counter[tuple[int, int]]


def _polynomial(random: Random) -> Made:
    """A product of sums, expanded; sometimes with one coefficient changed."""
    factors = [
        [
            (random.randint(0, 2), random.randint(0, 2), Fraction(random.randint(-3, 3)))
            for _ in range(random.randint(1, 3))
        ]
        for _ in range(random.randint(2, 3))
    ]
    left = mul(*(add(*(_term(c, i, j) for i, j, c in factor)) for factor in factors))
    product: dict[tuple[int, int], Fraction] = {(0, 0): Fraction(1)}
    for factor in factors:
        fresh: dict[tuple[int, int], Fraction] = {}
        for (i, j), c in product.items():
            for k, l, d in factor:
                fresh[i + k, j + l] = fresh.get((i + k, j + l), Fraction(0)) + c * d
        product = fresh
    truth = TRUE
    if random.random() < 0.5:
        key = random.choice(list(product))
        product[key] += random.choice((Fraction(1), Fraction(-1), Fraction(1, 10**6), Fraction(1, 10**30)))
        truth = FALSE
    right = add(*(_term(c, i, j) for (i, j), c in product.items()))
    return Made(Identity(left, right), "an expanded polynomial", truth)


def _term(c: Fraction, i: int, j: int) -> Tree:
    return mul(num(c), power(var("x"), i), power(var("y"), j))


def _law(random: Random) -> Made:
    """A law of functions; the oracle judges those that hold only where both sides are defined."""
    a = var("x") if random.random() < 0.6 else smooth(random, ["x"], 1)
    b = var("y") if random.random() < 0.6 else num(nonzero(random))
    k = num(random.choice((2, 3, -1, "1/2")))
    everywhere = [
        (root(power(a, 2)), ("abs", a)),
        (("sin", mul(TWO, a)), mul(TWO, ("sin", a), ("cos", a))),
        (power(("cosh", a), 2), add(ONE, power(("sinh", a), 2))),
        (("tanh", a), div(("sinh", a), ("cosh", a))),
        (("h", 1, a), ("tanh", a)),
        (("exp", add(a, b)), mul(("exp", a), ("exp", b))),
        (("atan", neg(a)), neg(("atan", a))),
        (("cos", neg(a)), ("cos", a)),
        (("abs", mul(a, b)), mul(("abs", a), ("abs", b))),
        (("log", ("exp", a)), a),
        (("sin", add(a, b)), add(mul(("sin", a), ("cos", b)), mul(("cos", a), ("sin", b)))),
        (hidden_zero(random, ["x"]), num(0)),
        (power(add(a, b), 2), add(power(a, 2), mul(TWO, a, b), power(b, 2))),
        (div(a, add(ONE, power(b, 2))), mul(a, div(ONE, add(ONE, power(b, 2))))),
    ]
    partly = [
        (power(root(a), 2), a),
        (mul(root(a), root(b)), root(mul(a, b))),
        (("exp", ("log", a)), a),
        (("log", mul(a, b)), add(("log", a), ("log", b))),
        (("log", power(a, 2)), mul(TWO, ("log", a))),
        (div(a, a), ONE),
        (div(ONE, div(ONE, a)), a),
        (("tan", a), div(("sin", a), ("cos", a))),
        (mul(("tan", a), ("cos", a)), ("sin", a)),
        (("sin", ("asin", a)), a),
        (("asin", ("sin", a)), a),
        (root(power(a, 2)), a),
        (sub(("log", a), ("log", a)), num(0)),
        (power(("log", a), 0), ONE),
        (power(a, 0), ONE),
        (div(sub(power(a, 2), power(b, 2)), sub(a, b)), add(a, b)),
        (add(("asin", a), ("acos", a)), div(("pi",), TWO)),
        (mul(k, div(a, k)), a),
        (div(power(a, 3), a), power(a, 2)),
        (("abs", a), a),
        (("atan", ("tan", a)), a),
        (add(div(a, b), div(b, a)), div(add(power(a, 2), power(b, 2)), mul(a, b))),
        (div(div(a, b), div(a, b)), ONE),
        (mul(num(0), ("log", a)), num(0)),
        (root(div(a, b)), div(root(a), root(b))),
    ]
    if random.random() < 0.4:
        left, right = random.choice(everywhere)
        if random.random() < 0.4:
            return Made(
                _identity(random, left, add(right, num(random.choice((1, "1/1000000"))))), "a law, off", FALSE
            )
        return Made(_identity(random, left, right), "a law that holds", TRUE)
    left, right = random.choice(partly)
    if random.random() < 0.15:
        right = mul(right, num(small_number(random)))
    return Made(_identity(random, left, right), "a law that holds somewhere")
