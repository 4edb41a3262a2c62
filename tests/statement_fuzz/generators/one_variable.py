"""Inequalities in one variable: known, products of roots, poles, almost true, disguised; norms; angles."""

from dataclasses import replace
from fractions import Fraction
from math import isfinite

import numpy as np

from lyapcheck.claims import AllOf, Constant, ForAll, NormBound
from tests.oracle.trees import floats
from tests.statement_fuzz.generators import FALSE, GENERATORS, TRUE, Made, generates
from tests.statement_fuzz.generators.expressions import (
    ONE,
    TWO,
    ZERO,
    add,
    constant,
    disguised,
    div,
    hidden_zero,
    le,
    lt,
    mul,
    neg,
    num,
    positive,
    power,
    relation,
    risky,
    root,
    rough,
    smooth,
    sub,
    undefined_number,
    var,
)

X = var("x")
CUBE = sub(X, div(power(X, 3), num(6)))


@generates("ForAll", 18)
def for_all(random):
    """One inequality."""
    families = (_known, _factors, _poles, _tails, _disguised, _beside_its_least_value, _random_sides)
    return random.choices(families, (30, 20, 12, 8, 18, 8, 6))[0](random)


def _random_sides(random):
    """Any two expressions."""
    result = relation(random, rough(random, ["x"], 3), rough(random, ["x"], 1))
    return Made(ForAll(result, *ends(random)), "random sides")


def ends(random):
    """A domain: half-lines, the line, intervals, points; ends open or closed, often 0 or whole."""
    low = random.choice(
        (None, Fraction(0), Fraction(0), Fraction(1), Fraction(random.randint(-6, 6), random.randint(1, 3)))
    )
    start = low if low is not None else Fraction(random.randint(-6, 2))
    size = random.choice((1, 2, 5, 10, Fraction(1, 3), Fraction(1, 1000), 0))
    high = random.choice((None, start + size))
    return low, high, low is not None and random.random() < 0.4, high is not None and random.random() < 0.4


KNOWN = (
    (("tanh", X), X, "right"),
    (("sin", X), X, "right"),
    (("atan", X), X, "right"),
    (X, ("sinh", X), "right"),
    (CUBE, ("sin", X), "right"),
    (("log", add(ONE, X)), X, "right"),
    (root(add(ONE, X)), add(ONE, div(X, TWO)), "right"),
    (add(ONE, X), ("exp", X), "line"),
    (add(ONE, div(power(X, 2), TWO)), ("cosh", X), "line"),
    (sub(ONE, div(power(X, 2), TWO)), ("cos", X), "line"),
    (("h", 1, X), X, "right"),
    (("h", 2, X), ("gamma", 2), "line"),
    (("h", 2, X), mul(("L", 2), X), "right"),
    (("dh", 2, X), ("rho", 2), "line"),
    (("h", 3, X), num("1.12"), "line"),
    (("abs", ("tanh", X)), ("abs", X), "line"),
    (ZERO, ("potential", 2, X), "line"),
    (mul(TWO, X), add(ONE, power(X, 2)), "line"),
    (("tanh", X), ONE, "line"),
    (("atan", X), div(("pi",), TWO), "line"),
    (ZERO, ("abs", X), "line"),
    (mul(X, ("exp", neg(X))), ONE, "line"),
)
"""left <= right for x >= 0 or for all x."""


def _known(random):
    """A known inequality, as it is or with a slack of either sign; strict ones may fail at an end."""
    left, right, where = random.choice(KNOWN)
    domain = ends(random)
    if where == "right" and (domain[0] is None or domain[0] < 0):
        low = random.choice((Fraction(0), Fraction(0), Fraction(1), Fraction(1, 10)))
        high = None if domain[1] is None else low + random.choice((1, 3, 0))
        domain = (low, high, *domain[2:])
    slack = random.choice((0, 0, Fraction(1, 10**6), Fraction(-1, 10**6), Fraction(-1, 2)))
    right = add(right, num(slack)) if slack else right
    result = relation(random, left, right)
    truth = TRUE if slack > 0 or (slack == 0 and result.operator == "<=") else None
    return Made(ForAll(result, *domain), "a known inequality", truth)


def _factors(random):
    """A product of powers of x − r, with ends of the domain at the roots."""
    roots = [
        Fraction(random.randint(-3, 5), random.choice((1, 1, 2, 3))) for _ in range(random.randint(1, 3))
    ]
    powers = [random.choice((1, 1, 2, 2, 3)) for _ in roots]
    product = mul(*(power(sub(X, num(r)), k) for r, k in zip(roots, powers, strict=True)))
    if random.random() < 0.3:
        product = mul(product, add(power(X, 2), num(random.choice((1, "1/1000000", 0)))))
    domain = list(ends(random))
    for k in (0, 1):
        if domain[k] is not None and random.random() < 0.6:
            domain[k] = random.choice(roots)
    low, high = domain[0], domain[1]
    if low is not None and high is not None and low > high:
        domain[0], domain[1] = high, low
    if random.random() < 0.3:
        product = neg(product)
    result = relation(random, ZERO, product)
    if random.random() < 0.3:
        result = replace(result, left=num(random.choice(("-1/1000000", "1/1000000"))))
    return Made(ForAll(result, *domain), "factors")


def _poles(random):
    """Quotients with poles, removable ones too, some at the ends."""
    c = Fraction(random.randint(-3, 6), random.choice((1, 1, 2)))
    bottom = random.choice(
        (
            sub(X, num(c)),
            power(sub(X, num(c)), 2),
            sub(power(X, 2), num(c)),
            sub(num(c), X),
            mul(X, sub(X, num(c))),
        )
    )
    top = random.choice(
        (bottom, ONE, X, ZERO, mul(bottom, add(ONE, power(X, 2))), power(bottom, 2), neg(bottom))
    )
    tree = random.choice(
        (
            div(top, bottom),
            power(div(top, bottom), 2),
            ("abs", div(top, bottom)),
            ("exp", div(top, bottom)),
            root(bottom),
            ("log", bottom),
            mul(root(bottom), root(bottom)),
            ("tanh", div(ONE, bottom)),
            ("atan", div(ONE, bottom)),
            div(ONE, div(ONE, bottom)),
            mul(X, ("log", X)),
            div(("sin", X), X),
            div(sub(("exp", X), ONE), X),
            ("exp", neg(div(ONE, power(X, 2)))),
            mul(bottom, ("log", ("abs", bottom))),
        )
    )
    domain = list(ends(random))
    if random.random() < 0.5:
        domain[random.choice((0, 1))] = c
    low, high = domain[0], domain[1]
    if low is not None and high is not None and low > high:
        domain[0], domain[1] = high, low
    bound = num(random.choice((0, 0, -1, 1, "-1/10", -10, 100)))
    sides = (bound, tree) if random.random() < 0.75 else (tree, bound)
    return Made(ForAll(relation(random, *sides), *domain), "poles")


def _tails(random):
    """Functions that approach a limit slowly or exceed a bound only far out or near an end."""
    far = num(10 ** random.choice((1, 3, 6, 12)))
    left, right = random.choice(
        (
            (div(X, add(ONE, X)), sub(ONE, div(ONE, far))),
            (("tanh", X), sub(ONE, div(ONE, far))),
            (("atan", X), sub(div(("pi",), TWO), div(ONE, far))),
            (("log", add(ONE, X)), mul(far, ONE)),
            (("log", add(ONE, X)), mul(num(2), root(X))),
            (X, ("exp", div(X, far))),
            (("log", X), div(X, TWO)),
            (mul(X, ("log", X)), power(X, 2)),
            (root(add(power(X, 2), ONE)), add(X, div(ONE, far))),
            (div(("sin", X), X), ONE),
            (div(ONE, X), far),
            (div(sub(("exp", X), ONE), X), ("exp", X)),
            (("abs", ("sin", X)), X),
            (("tanh", X), div(X, add(ONE, div(X, far)))),
            (power(X, 8), ("exp", X)),
            (mul(power(X, 2), ("exp", neg(X))), num(random.choice(("0.5413", "0.5414")))),
        )
    )
    low = random.choice((Fraction(0), Fraction(0), Fraction(1), Fraction(2), Fraction(1, 100)))
    high = random.choice((None, None, low + 1, low + 100))
    return Made(ForAll(relation(random, left, right), low, high, random.random() < 0.5, False), "tails")


def _disguised(random):
    """A simple true inequality with a risky part hidden in it."""
    base = random.choice(
        (ONE, add(ONE, power(X, 2)), ("exp", X), X, power(X, 2), ("cosh", X), add(TWO, ("sin", X)))
    )
    tree = disguised(random, base, ["x"])
    if random.random() < 0.3:
        tree = add(base, mul(hidden_zero(random, ["x"]), risky(random, ["x"])))
    bound = num(random.choice((0, 0, -1, "-1/1000", "1/2")))
    return Made(ForAll(relation(random, bound, tree), *ends(random)), "a disguised expression")


def _beside_its_least_value(random):
    """A function against what floating point says is its least value, a little lower or higher."""
    tree = smooth(random, ["x"], 2)
    low, high = Fraction(random.randint(-4, 1)), Fraction(random.randint(2, 5))
    with np.errstate(all="ignore"):
        values = floats(tree, {"x": np.linspace(float(low), float(high), 4001)}, {}) + np.zeros(4001)
    least = float(np.min(values)) if np.all(np.isfinite(values)) else float("nan")
    if not isfinite(least) or abs(least) > 1e9:
        return Made(ForAll(lt(neg(positive_tree(random)), tree), low, high), "random sides")
    step = Fraction(1, 10 ** random.choice((1, 3, 6)))
    below = random.random() < 0.5
    near = Fraction(least).limit_denominator(10**12)
    bound = near - step if below else near + step
    truth = None if below else FALSE
    return Made(ForAll(relation(random, num(bound), tree), low, high), "beside its least value", truth)


def positive_tree(random):
    """A positive number."""
    return num(positive(random))


@generates("NormBound", 2)
def bound(random):
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
def together(random):
    """Several statements of other kinds."""
    names = ["Identity", "ForAll", "Constant", "Implies"]
    parts = []
    for k in range(random.randint(1, 3)):
        parts.append((f"part {k}", GENERATORS[random.choice(names)][1](random).statement))
    if random.random() < 0.2:
        parts.append(("numbers", Constant(random.choice((lt, le))(ONE, rough(random, [], 2)))))
    return Made(AllOf(tuple(parts)), "all of several")


ANGLES = ("q1", "q2")
