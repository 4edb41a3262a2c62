"""Properties of the loop and of V: with a fitting h, one that does not fit, or a part of another one."""

from __future__ import annotations

import runpy
from dataclasses import replace
from fractions import Fraction
from functools import lru_cache
from random import Random
from typing import Any

from tests.statement_fuzz.generators import Made, generates
from tests.statement_fuzz.generators.stability import PROOFS
from tests.statement_fuzz.generators.traps import disguised
from tests.statement_fuzz.generators.trees import (
    ONE,
    TWO,
    Tree,
    add,
    div,
    mul,
    neg,
    num,
    power,
    root,
    sub,
    var,
)
from tests.statement_fuzz.subject import Property

X = var("x")
SQUARE = add(ONE, power(X, 2))
Trio = tuple[Tree, Tree, Tree]
"""h, h' and U."""

FITTING: tuple[Trio, ...] = (
    (("tanh", X), sub(ONE, power(("tanh", X), 2)), ("log", ("cosh", X))),
    *((("h", m, X), ("dh", m, X), ("potential", m, X)) for m in (1, 2, 3)),
    (("atan", X), div(ONE, SQUARE), sub(mul(X, ("atan", X)), div(("log", SQUARE), TWO))),
    (div(X, root(SQUARE)), div(ONE, mul(SQUARE, root(SQUARE))), sub(root(SQUARE), ONE)),
)
OTHERS: tuple[Trio, ...] = (
    (("sin", X), ("cos", X), sub(ONE, ("cos", X))),
    (X, ONE, div(power(X, 2), TWO)),
    (div(X, SQUARE), div(sub(ONE, power(X, 2)), power(SQUARE, 2)), div(("log", SQUARE), TWO)),
    (
        div(X, power(SQUARE, 2)),
        div(sub(ONE, mul(num(3), power(X, 2))), power(SQUARE, 3)),
        div(sub(ONE, div(ONE, SQUARE)), TWO),
    ),
    (mul(X, ("abs", X)), mul(TWO, ("abs", X)), div(power(("abs", X), 3), num(3))),
    (add(X, div(("abs", X), TWO)), add(ONE, div(("abs", X), mul(TWO, X))), add(power(X, 2), X)),
    (("abs", X), div(X, ("abs", X)), div(mul(X, ("abs", X)), TWO)),
    (power(X, 2), mul(TWO, X), div(power(X, 3), num(3))),
    (sub(("tanh", X), div(X, num(9))), sub(num("8/9"), power(("tanh", X), 2)), sub(("log", ("cosh", X)), X)),
    (neg(("tanh", X)), sub(power(("tanh", X), 2), ONE), neg(("log", ("cosh", X)))),
)
PROPERTIES = (
    "the origin is the only equilibrium",
    "the origin is an equilibrium",
    "V is positive definite",
    "V is decrescent",
    "V is radially unbounded",
    "V is continuously differentiable",
)
NUMBERS = {"gamma": Fraction(8, 5), "rho": Fraction(3), "secant": Fraction(1), "low": Fraction(1, 2)}
"""Bounds that all that fit have."""


@lru_cache(maxsize=1)
def arguments() -> dict[str, Any]:
    """Of (6) at rest, of (6) and of (21), each with tanh and for any ε₀."""
    rest, every = (runpy.run_path(str(PROOFS / f"{n}.py")) for n in ("kelly_santibanez", "every_function"))
    tanh = every["MEMBERS"]["tanh"]
    return {
        "rest": rest["regulator"](tanh, friction="positive")[2].argument,
        "strict": every["regulator"](tanh, "any").argument,
        "uniform": every["tracking"](tanh, "any").argument,
    }


def property_of(name: str, trio: Trio, desired: bool = False) -> Any:
    """A property of a loop with h, h' and U."""
    kind = "rest" if "only" in name else "uniform" if desired or name.endswith("decrescent") else "strict"
    argument = arguments()[kind]
    h, slope, potential = trio
    functions = tuple(
        replace(f, member=replace(f.member, value=h, slope=slope, potential=potential, **NUMBERS))
        for f in argument.system.functions
    )
    return Property(name, replace(argument, system=replace(argument.system, functions=functions)))


@generates("Property", 0.6)
def of_a_loop(random: Random) -> Made:
    """A property of a loop with some h; one of its parts may be off."""
    fits = random.random() < 0.6
    h, slope, potential = random.choice(FITTING if fits else OTHERS)
    kind = random.random()
    tiny = num(random.choice((1, Fraction(1, 1000), Fraction(1, 10**6), Fraction(-1, 1000))))
    if kind < 0.12:
        potential = add(potential, tiny)
    elif kind < 0.24:
        h = add(h, tiny)
    elif kind < 0.32:
        slope = mul(slope, add(ONE, tiny))
    elif kind < 0.4:
        potential = random.choice(FITTING)[2]
    elif kind < 0.48:
        h = disguised(random, h, ["x"])
    made = property_of(random.choice(PROPERTIES), (h, slope, potential), random.random() < 0.3)
    return Made(made, "a property of a loop" if fits else "a property that h does not have perhaps")
