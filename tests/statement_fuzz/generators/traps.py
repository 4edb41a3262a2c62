"""Parts that are undefined somewhere, and ways to hide them where their value does not matter."""

from __future__ import annotations

from fractions import Fraction
from random import Random

from tests.statement_fuzz.generators.laws import everywhere
from tests.statement_fuzz.generators.trees import (
    ONE,
    TWO,
    ZERO,
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


def hidden_zero(random: Random, names: list[str]) -> Tree:
    """An expression that is 0 at every point, though it may take a law to see it."""
    return random.choice(_VANISHING)(random, names)


def _some(random: Random, names: list[str]) -> Tree:
    """A number or a plain expression, defined everywhere."""
    return smooth(random, names, 1) if names else num(random.choice((1, 2, 3, Fraction(1, 2), -2)))


def _same(random: Random, names: list[str]) -> Tree:
    a = _some(random, names)
    return sub(a, a)


def _square_of_root(random: Random, names: list[str]) -> Tree:
    c = num(random.choice((2, 3, 5, Fraction(1, 2), Fraction(7, 3))))
    return sub(power(root(c), 2), c)


def _product_of_roots(random: Random, names: list[str]) -> Tree:
    a, b = random.choice(((2, 3), (2, 8), (3, 12), (5, 7)))
    return sub(mul(root(num(a)), root(num(b))), root(num(a * b)))


def _nested_root(random: Random, names: list[str]) -> Tree:
    inner = add(ONE, root(TWO))
    return sub(mul(power(root(inner), 2), root(TWO)), add(root(TWO), TWO))


def _denested(random: Random, names: list[str]) -> Tree:
    return sub(root(add(num(4), mul(TWO, root(num(3))))), add(ONE, root(num(3))))


def _scaled_root(random: Random, names: list[str]) -> Tree:
    k = random.choice((2, 3, 10))
    return sub(root(num(2 * k * k)), mul(num(k), root(TWO)))


def _law(random: Random, names: list[str]) -> Tree:
    return sub(*random.choice(everywhere(_some(random, names), _some(random, names))))


def _logarithms(random: Random, names: list[str]) -> Tree:
    return random.choice(
        (sub(("log", num(4)), mul(TWO, ("log", TWO))), sub(("exp", ("log", num(3))), num(3)), ("log", ONE))
    )


def _arcs(random: Random, names: list[str]) -> Tree:
    return random.choice(
        (
            sub(mul(num(4), ("atan", ONE)), ("pi",)),
            sub(mul(TWO, ("asin", ONE)), ("pi",)),
            add(("asin", num("1/3")), ("acos", num("1/3")), neg(div(("pi",), TWO))),
            ("sin", ("pi",)),
            ("cos", div(("pi",), TWO)),
            add(ONE, ("cos", ("pi",))),
        )
    )


def _family(random: Random, names: list[str]) -> Tree:
    m = random.choice((1, 2, 3))
    return random.choice(
        (("h", m, ZERO), ("potential", m, ZERO), sub(("gamma", 1), ONE), sub(("L", 1), ("rho", 1)))
    )


def _product(random: Random, names: list[str]) -> Tree:
    a, b = _some(random, names), _some(random, names)
    return random.choice((mul(ZERO, a), sub(mul(a, b), mul(b, a))))


_VANISHING = (
    *(_same, _square_of_root, _product_of_roots, _nested_root, _denested, _scaled_root, _logarithms, _arcs),
    *(_law, _law, _law, _law, _family, _product),
)


def undefined_number(random: Random) -> Tree:
    """A number that is none: a quotient by 0, the root or the logarithm of what it does not exist for."""
    zero = hidden_zero(random, [])
    return random.choice(
        (
            div(num(small_number(random)), zero),
            div(zero, zero),
            div(hidden_zero(random, []), zero),
            root(num(-abs(nonzero(random)))),
            root(sub(zero, ONE)),
            ("log", zero),
            ("log", num(-abs(nonzero(random)))),
            ("log", neg(ONE)),
            ("asin", num(random.choice((2, -3, "1000001/1000000")))),
            ("acos", TWO),
            ("tan", div(("pi",), TWO)),
            div(ONE, div(ONE, zero)),
            mul(root(num(-3)), root(num(-3))),
            power(root(num(-2)), random.choice((0, 2, 4))),
        )
    )


def risky(random: Random, names: list[str]) -> Tree:
    """An expression that is undefined at some points or at all, as users stumble upon."""
    if not names or random.random() < 0.2:
        return undefined_number(random)
    a = var(random.choice(names))
    c = num(random.choice((0, 0, 1, 2, 5, -1, "1/2", "1/3", 10)))
    inner = random.choice((a, sub(a, c), sub(c, a), add(a, c), power(sub(a, c), 2), sub(power(a, 2), c)))
    kind = random.randrange(9)
    if kind < 5:
        name = random.choice(("log", "sqrt", "tan", "asin", "acos"))
        return (name, inner)
    if kind < 7:
        return div(random.choice((ONE, a, inner, ZERO)), inner)
    return rough(random, names, 2) if kind == 7 else div(ONE, hidden_zero(random, names))


def disguised(random: Random, of: Tree, names: list[str]) -> Tree:
    """An expression with the same value wherever it has one."""
    r = risky(random, names)
    return random.choice(
        (
            lambda: add(of, mul(ZERO, r)),
            lambda: add(mul(r, ZERO), of),
            lambda: add(of, div(ZERO, r)),
            lambda: mul(of, power(r, 0)),
            lambda: mul(of, div(r, r)),
            lambda: add(of, r, neg(r)),
            lambda: add(of, sub(r, r)),
            lambda: sub(add(of, r), r),
            lambda: div(ONE, div(ONE, of)),
            lambda: div(mul(of, r), r),
            lambda: power(root(of), 2),
            lambda: mul(root(of), root(of)),
            lambda: ("exp", ("log", of)),
            lambda: add(power(of, 0), of, num(-1)),
            lambda: mul(of, div(hidden_like(random, r), r)),
            lambda: add(of, mul(sub(a := smooth(random, names, 1), a), r)),
            lambda: add(of, mul(hidden_zero(random, names), r)),
            lambda: div(of, add(power(r, 0), ZERO)),
            lambda: add(of, mul(ZERO, (random.choice(("sin", "tanh", "atan", "cos")), r))),
            lambda: add(of, div(ZERO, add(TWO, ("sin", r)))),
        )
    )()


def hidden_like(random: Random, of: Tree) -> Tree:
    """The same expression, written in another way."""
    return random.choice((add(of, ZERO), mul(ONE, of), neg(neg(of)), mul(TWO, div(of, TWO))))
