"""Laws of functions, as pairs of expressions: those that hold everywhere, and those that hold somewhere."""

from __future__ import annotations

from tests.statement_fuzz.generators.trees import (
    ONE,
    TWO,
    ZERO,
    Tree,
    add,
    div,
    mul,
    neg,
    num,
    power,
    root,
    sub,
)

Law = tuple[Tree, Tree]


def everywhere(a: Tree, b: Tree) -> tuple[Law, ...]:
    """Laws that hold wherever a and b have values, and have values there."""
    return (
        (root(power(a, 2)), ("abs", a)),
        (add(power(("sin", a), 2), power(("cos", a), 2)), ONE),
        (("sin", mul(TWO, a)), mul(TWO, ("sin", a), ("cos", a))),
        (("sinh", mul(TWO, a)), mul(TWO, ("sinh", a), ("cosh", a))),
        (power(("cosh", a), 2), add(ONE, power(("sinh", a), 2))),
        (("tanh", a), div(("sinh", a), ("cosh", a))),
        (("h", 1, a), ("tanh", a)),
        (("exp", add(a, b)), mul(("exp", a), ("exp", b))),
        (("sin", neg(a)), neg(("sin", a))),
        (("atan", neg(a)), neg(("atan", a))),
        (("cos", neg(a)), ("cos", a)),
        (("abs", neg(a)), ("abs", a)),
        (("abs", mul(a, b)), mul(("abs", a), ("abs", b))),
        (("log", ("exp", a)), a),
        (("sin", add(a, b)), add(mul(("sin", a), ("cos", b)), mul(("cos", a), ("sin", b)))),
        (power(add(a, b), 2), add(power(a, 2), mul(TWO, a, b), power(b, 2))),
        (div(a, add(ONE, power(b, 2))), mul(a, div(ONE, add(ONE, power(b, 2))))),
    )


def somewhere(a: Tree, b: Tree, k: Tree) -> tuple[Law, ...]:
    """Laws with a side that may have no value, or another one; k is a number that is not 0."""
    return (
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
        (mul(ZERO, ("log", a)), ZERO),
        (root(div(a, b)), div(root(a), root(b))),
    )
