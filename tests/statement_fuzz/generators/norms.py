"""Bounds of ‖(f(x_1), …, f(x_n))‖, and several statements together."""

from __future__ import annotations

from random import Random

from tests.statement_fuzz.generators import GENERATORS, Made, generates
from tests.statement_fuzz.generators.traps import disguised, undefined_number
from tests.statement_fuzz.generators.trees import (
    ONE,
    add,
    constant,
    div,
    le,
    lt,
    mul,
    num,
    power,
    root,
    rough,
    smooth,
    var,
)
from tests.statement_fuzz.subject import AllOf, Constant, NormBound

X = var("x")


@generates("NormBound", 2)
def bound(random: Random) -> Made:
    """A bound of a vector of equal functions."""
    n, k = random.choice((1, 1, 2, 3, 4)), random.choice((0, 1))
    f = random.choice(
        (
            ("tanh", X),
            ("h", random.choice((1, 2, 3)), X),
            ("dh", random.choice((1, 2)), X),
            ("sin", X),
            ("atan", X),
            div(X, add(ONE, power(X, 2))),
            X,
            power(X, 0),
            smooth(random, ["x"], 2),
        )
    )
    if random.random() < 0.3:
        f = disguised(random, f, ["x"])
    c = random.choice(
        (
            num(1),
            num(2),
            root(num(n)),
            mul(root(num(n)), constant(random)),
            num("999999/1000000"),
            ("gamma", 2),
        )
    )
    if random.random() < 0.3:
        c = random.choice((undefined_number(random), mul(c, num("1000001/1000000")), num(-1), num(0)))
    return Made(NormBound(f, n, c, k), "a norm")


@generates("AllOf", 3)
def together(random: Random) -> Made:
    """Several statements of other kinds."""
    names = ["Identity", "ForAll", "Constant", "Implies"]
    parts = []
    for k in range(random.randint(1, 3)):
        parts.append((f"part {k}", GENERATORS[random.choice(names)][1](random).statement))
    if random.random() < 0.2:
        parts.append(("numbers", Constant(random.choice((lt, le))(ONE, rough(random, [], 2)))))
    return Made(AllOf(tuple(parts)), "all of several")
