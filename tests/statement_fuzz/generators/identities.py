"""Identities: expanded polynomials, laws of functions where they hold and where they do not, disguises."""

from dataclasses import replace
from fractions import Fraction

from lyapcheck.claims import Identity, Variable
from tests.oracle.trees import names
from tests.statement_fuzz.generators import FALSE, TRUE, Made, generates
from tests.statement_fuzz.generators.expressions import (
    ZERO,
    add,
    disguised,
    everywhere,
    hidden_zero,
    mul,
    nonzero,
    num,
    power,
    rough,
    small_number,
    smooth,
    somewhere,
    var,
)

NAMES = ["x", "y", "v"]


@generates("Identity", 26)
def identities(random):
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


def _identity(random, left, right):
    """An identity, sometimes with ranges of its variables, where the kind knows them."""
    if random.random() < 0.5:
        left, right = right, left
    if random.random() < 0.5:
        result = [
            Variable(name, Fraction(random.choice((0, 0, 1, -1))), random.random() < 0.6) for name in NAMES
        ]
        used = names(left, right)
        return replace(Identity(left, right), variables=tuple(v for v in result if v.name in used))
    return Identity(left, right)


def _polynomial(random):
    """A product of sums, expanded; sometimes with one coefficient changed."""
    factors = [
        [
            (random.randint(0, 2), random.randint(0, 2), Fraction(random.randint(-3, 3)))
            for _ in range(random.randint(1, 3))
        ]
        for _ in range(random.randint(2, 3))
    ]
    left = mul(*(add(*(_term(c, i, j) for i, j, c in factor)) for factor in factors))
    product = {(0, 0): Fraction(1)}
    for factor in factors:
        fresh = {}
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


def _term(c, i, j):
    return mul(num(c), power(var("x"), i), power(var("y"), j))


def _law(random):
    """A law of functions; the oracle judges those that hold only where both sides are defined."""
    a = var("x") if random.random() < 0.6 else smooth(random, ["x"], 1)
    b = var("y") if random.random() < 0.6 else num(nonzero(random))
    k = num(random.choice((2, 3, -1, "1/2")))
    if random.random() < 0.4:
        left, right = random.choice((*everywhere(a, b), (hidden_zero(random, ["x"]), ZERO)))
        if random.random() < 0.4:
            return Made(
                _identity(random, left, add(right, num(random.choice((1, "1/1000000"))))), "a law, off", FALSE
            )
        return Made(_identity(random, left, right), "a law that holds", TRUE)
    left, right = random.choice(somewhere(a, b, k))
    if random.random() < 0.15:
        right = mul(right, num(small_number(random)))
    return Made(_identity(random, left, right), "a law that holds somewhere")
