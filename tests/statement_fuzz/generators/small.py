"""Relations for every small enough ε."""

from __future__ import annotations

from random import Random

from tests.statement_fuzz.generators import Made, generates
from tests.statement_fuzz.generators.implications import KINDS
from tests.statement_fuzz.generators.traps import disguised
from tests.statement_fuzz.generators.trees import (
    ONE,
    ZERO,
    Tree,
    add,
    constant,
    div,
    le,
    lt,
    mul,
    num,
    power,
    relation,
    small_number,
    var,
)
from tests.statement_fuzz.subject import ForSmall, Variable


def _of_small(random: Random, generators: list[Tree]) -> Tree:
    """A function of ε, t or of what they divide: it may tend to 0, to 1 or to infinity."""
    a = random.choice(generators[:1] + generators[3:])
    inner = random.choice(
        (a, div(ONE, a), div(ONE, power(a, 2)), div(A, a), add(ONE, a), div(ONE, power(a, 4)))
    )
    return (random.choice(("exp", "log", "sqrt", "abs", "sin", "tanh", "cosh")), inner)


E, T, A, B = var("eps"), var("t"), var("a"), var("b")


@generates("ForSmall", 7)
def make(random: Random) -> Made:
    """A polynomial in ε, t and others against 0 or another."""
    bounded = ("t",) if random.random() < 0.5 else ()
    generators = [E, A, B, *([T] if bounded else [])]

    def monomial() -> tuple:  # type: ignore[type-arg]
        c = num(small_number(random)) if random.random() < 0.85 else constant(random)
        return mul(c, *(power(random.choice(generators), random.randint(0, 2)) for _ in range(2)))

    left, right = (
        add(*(monomial() for _ in range(2))),
        add(*(monomial() for _ in range(random.randint(1, 3)))),
    )
    if random.random() < 0.4:
        left = ZERO
    if random.random() < 0.2:
        right = div(right, random.choice((E, A, add(A, E), power(E, 2))))
    if random.random() < 0.25:
        left = add(left, mul(random.choice((E, A, power(E, 2))), _of_small(random, generators)))
    if random.random() < 0.2:
        right = disguised(random, right, ["a", "eps"])
    kind = random.choice(("positive", "positive", "weak", "real"))
    own = tuple(Variable(name, *KINDS[kind]) for name in "ab")
    given = random.choice(((), (lt(A, B),), (le(A, B),), (lt(ZERO, A),), (lt(A, B), lt(B, A))))
    return Made(ForSmall("eps", own, given, relation(random, left, right), bounded), "a small parameter")
