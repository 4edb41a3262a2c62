"""Relations between numbers: near and far, equal in disguise, and between what is no number."""

from __future__ import annotations

from fractions import Fraction
from random import Random

from mpmath import mp

from tests.statement_fuzz.generators import FALSE, NEITHER, TRUE, UNPROVABLE, Made, generates
from tests.statement_fuzz.generators.traps import disguised, hidden_zero, undefined_number
from tests.statement_fuzz.generators.trees import (
    Tree,
    add,
    constant,
    div,
    mul,
    neg,
    nonzero,
    num,
    relation,
    rough,
    small_number,
    smooth,
    sub,
)
from tests.statement_fuzz.oracle import exact
from tests.statement_fuzz.oracle.evaluate import Evaluation
from tests.statement_fuzz.oracle.numbers import Undefined, Unsure, lifted
from tests.statement_fuzz.subject import Constant

LARGEST = 10**20


@generates("Constant", 28)
def make(random: Random) -> Made:
    """One relation between numbers."""
    kind = random.random()
    if kind < 0.25:
        return _undefined(random)
    if kind < 0.45:
        return _equal(random)
    if kind < 0.85:
        return _near(random)
    return Made(Constant(relation(random, rough(random, [], 3), rough(random, [], 2))), "random numbers")


def _undefined(random: Random) -> Made:
    bad = undefined_number(random)
    other = num(small_number(random)) if random.random() < 0.6 else smooth(random, [], 1)
    sides = [disguise(random, bad), other]
    random.shuffle(sides)
    return Made(Constant(relation(random, *sides)), "an undefined number", NEITHER)


def disguise(random: Random, bad: Tree) -> Tree:
    """An expression that contains a number that is none."""
    plain = num(nonzero(random))
    return random.choice(
        (
            bad,
            neg(bad),
            add(plain, bad),
            mul(plain, bad),
            mul(num(0), bad),
            div(bad, bad),
            sub(bad, bad),
            ("pow", bad, random.choice((0, 1, 2))),
            div(plain, bad),
            add(plain, mul(num(0), bad)),
            (random.choice(("abs", "sin", "cos", "tanh", "atan", "exp")), bad),
        )
    )


def _equal(random: Random) -> Made:
    """Equal numbers: <= holds and < does not."""
    zero = hidden_zero(random, [])
    a = smooth(random, [], 1)
    left, right = random.choice(
        ((add(a, zero), a), (a, add(zero, a)), (zero, num(0)), (num(0), mul(num(-3), zero)))
    )
    result = relation(random, left, right)
    return Made(Constant(result), "equal numbers", FALSE if result.operator == "<" else TRUE)


def _near(random: Random) -> Made:
    """A number against a decimal beside it."""
    tree = random.choice((lambda: smooth(random, [], 2), lambda: mul(constant(random), constant(random))))()
    try:
        with exact.kept(False), mp.workdps(60):
            value = lifted(Evaluation({}).of(tree))
            digits = random.choice((2, 6, 12, 30))
            too_wide = (value.high - value.low) * 10 ** (digits + 1) > 1
            if not -LARGEST < value.low < LARGEST or too_wide:
                raise Unsure
            near = Fraction(int(mp.floor(value.low * 10**digits)), 10**digits)
    except (Undefined, Unsure):
        return Made(Constant(relation(random, tree, num(1))), "random numbers")
    unit = Fraction(1, 10**digits)
    above = random.random() < 0.5
    bound = near + 2 * unit if above else near - unit
    left, right = tree, num(bound)
    if random.random() < 0.5:
        left, right, above = right, left, not above
    truth = TRUE if above else FALSE
    if random.random() < 0.2:
        return Made(
            Constant(relation(random, disguised(random, left, []), right)),
            "disguised numbers",
            UNPROVABLE if truth == FALSE else None,
        )
    return Made(Constant(relation(random, left, right)), "a decimal beside a number", truth)
