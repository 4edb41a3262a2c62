"""Printed numbers against formulas: right, off by a unit, and with parts that are undefined."""

from __future__ import annotations

from decimal import Decimal
from random import Random

from mpmath import mp

from tests.statement_fuzz.generators import Made, generates
from tests.statement_fuzz.generators.traps import disguised
from tests.statement_fuzz.generators.trees import ONE, Tree, add, div, mul, num, power, root, sub, var
from tests.statement_fuzz.oracle.evaluate import Evaluation
from tests.statement_fuzz.oracle.numbers import Undefined, Unsure, lifted
from tests.statement_fuzz.subject import Agrees

A, B = var("a"), var("b")


@generates("Agrees", 8)
def make(random: Random) -> Made:
    """A formula with its inputs and its result as printed."""
    formula: Tree = random.choice(
        (
            mul(A, B),
            div(A, B),
            add(A, mul(num(2), B)),
            mul(root(A), B),
            div(power(A, 2), add(ONE, B)),
            sub(A, B),
            div(ONE, sub(A, B)),
            mul(("gamma", 2), A, B),
            ("sin", mul(A, B)),
            ("log", div(A, B)),
            mul(A, ("tanh", B)),
        )
    )
    inputs = [(name, f"{random.uniform(0.05, 4):.{random.choice((0, 1, 2, 4))}f}") for name in "ab"]
    printed = _result(random, formula, dict(inputs))
    if random.random() < 0.35:
        formula = disguised(random, formula, ["a", "b"])
    return Made(Agrees(formula, tuple(inputs), printed, random.choice((None, "a"))), "printed numbers")


def _result(random: Random, formula: Tree, inputs: dict[str, str]) -> str:
    from fractions import Fraction

    places = random.choice((1, 2, 3, 5))
    try:
        with mp.workdps(60):
            value = lifted(Evaluation({name: Fraction(text) for name, text in inputs.items()}).of(formula))
        outcome = Decimal(f"{float(value.low):.{places}f}")
    except (Undefined, Unsure, OverflowError):
        outcome = Decimal(f"{random.uniform(0, 5):.{places}f}")
    step = random.choice((0, 0, 0, 1, -1, 3, 40))
    result = outcome + step * Decimal(1).scaleb(-places)
    return f"{result:.{places}e}" if random.random() < 0.1 else str(result)
