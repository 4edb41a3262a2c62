"""Asymptotic sums contain the function they stand for, and their sign is that of the function."""

from fractions import Fraction

import pytest
from flint import arb, ctx
from hypothesis import given, settings
from hypothesis import strategies as st

from lyapcheck.check.expressions.expression import ball, evaluate
from lyapcheck.check.expressions.scales import (
    Asymptotic,
    ScaleAlgebra,
    Start,
    X,
    exactly,
    sign_beside,
    sign_from,
)
from lyapcheck.claims import (
    atan,
    cos,
    cosh,
    exp,
    expr,
    for_all,
    gamma,
    h,
    log,
    pi,
    potential,
    sin,
    sinh,
    sqrt,
    tanh,
    var,
)
from lyapcheck.claims.procedures import propose
from tests.helpers.shares import one_in

x = var("x")
START = Start(Fraction(6))

GROWING = {
    "polynomial": 3 * x**3 - x / 7 + 2,
    "quotient": (x**2 - 3) / (x**3 + x + 1),
    "quotient by π": 1 / (pi**2 * x + 1),
    "root": sqrt(x**2 + x + 1),
    "root of 256/π²": sqrt(25 + 256 * x**2 / pi**2),
    "irrational root": sqrt(3 * x**2 + 1),
    "logarithm": log(1 + x),
    "logarithm of a constant": log(3 * x**2),
    "logarithm of a growing exponential": log(cosh(x)),
    "power of a logarithm": log(x) ** 3 / x,
    "1 over a logarithm": 1 / (1 + log(x)),
    "exp falls": exp(-2 * x) * x**5,
    "exp of a logarithm": exp(2 * log(x) - x),
    "exp of what tends to a constant": exp(1 + 1 / x),
    "exp of what tends to 0": exp(x / (1 + x**2)),
    "tanh": tanh(x),
    "hyperbolic quotient": sinh(2 * x) / (1 + cosh(x)),
    "arc tangent": atan(x),
    "arc tangent of what falls": atan(-x),
    "arc tangent near 1": atan((x + 1) / (x + 2)),
    "sine of what grows": sin(x) / x,
    "sine of what tends to 0": sin(1 / x),
    "cosine near 2": cos(2 + 1 / x),
    "the family": h(3, x),
    "its potential": potential(2, x),
    "a constant of the family": gamma(2) * x + 1,
    "absolute value": abs(1 - x),
    "many terms": (x + 1 / x + log(x)) ** 6,
}


def as_scale(tree, start=START):
    value = evaluate(tree, {"x": Asymptotic(((X, exactly(1)),), start)}, ScaleAlgebra(start))
    return value


def at(function, point):
    """Σ c e^{ax} x^b (ln x)^j at a point."""
    log_x = point.log()
    return sum(
        (
            c.ball * (number(a) * point + number(b) * log_x).exp() * log_x**j
            for (a, b, j), c in function.terms
        ),
        arb(0),
    )


def number(value):
    return arb(value.numerator) / value.denominator


@pytest.mark.parametrize("name", one_in(3, GROWING))
@settings(max_examples=12)
@given(st.fractions(min_value=START.x, max_value=60, max_denominator=50))
def test_an_asymptotic_sum_contains_its_function(name, point):
    tree = GROWING[name].tree
    with ctx.workprec(160):
        sum_there, value = at(as_scale(tree), number(point)), ball(tree, {"x": number(point)})
        assert sum_there.overlaps(value), (sum_there, value)
        assert sum_there.is_finite()


@pytest.mark.parametrize("name", GROWING)
def test_most_of_them_are_tight(name):
    """Apart from a sine of what grows, the enclosure at a large point is far smaller than the value."""
    with ctx.workprec(160):
        there = at(as_scale(GROWING[name].tree, Start(Fraction(40))), arb(50))
        wide = name in ("sine of what grows", "1 over a logarithm", "many terms")
        assert wide or float(there.rad()) < 1e-6 * abs(float(there.mid())), there


SIGNS = {
    "x − ln x": (x - log(x), 1),
    "equal to second order": (sqrt(x**2 + 1) - x - 1 / (2 * x), -1),
    "π/2 cancels": (pi / 2 - atan(x), 1),
    "π/2 and 1/x cancel": (pi / 2 - atan(x) - 1 / x, -1),
    "exponentially close": (1 - tanh(x), 1),
    "a power beats a power of the logarithm": (sqrt(x) - log(x) ** 2, 1),
    "an exponential beats a power": (exp(x) - x**40, 1),
    "nothing": (x - x, 0),
    "equal, but not in normal form": (log(x**2) - 2 * log(x), 0),
    "without a sign": (sin(x), 0),
    "undefined": (sqrt(1 - x), 0),
    "logarithm of what is negative": (log(2 - x), 0),
    "division by nothing": (1 / (x - x), 0),
}


@pytest.mark.parametrize("name", SIGNS)
def test_signs_far_out(name):
    tree, sign = SIGNS[name]
    result = [sign_from(tree.tree, "x", Fraction(2**k)) for k in range(1, 20)]
    assert set(result) <= {0, sign}
    assert result[-1] == sign


def test_a_sign_is_not_claimed_before_the_last_change_of_it():
    """x² − 100 x + 1 is negative up to nearly 100; exp(x) − x⁴⁰ up to about 200."""
    for tree, change in (((x**2 - 100 * x + 1).tree, 100), ((exp(x) - x**40).tree, 200)):
        assert all(sign_from(tree, "x", Fraction(start)) == 0 for start in range(2, change - 10, 7))


BESIDE = {
    "sinh x / x − 1": (sinh(x) / x - 1, Fraction(0), 1, 1),
    "x ln x": (x * log(x), Fraction(0), 1, -1),
    "√x − x": (sqrt(x) - x, Fraction(0), 1, 1),
    "tan x / x against Becker and Stark": (
        pi**2 / (pi**2 - 4 * x**2) - sin(x) / (x * cos(x)),
        Fraction(0),
        1,
        1,
    ),
    "x − 1 − ln x, right of 1": (x - 1 - log(x), Fraction(1), 1, 1),
    "x − 1 − ln x, left of 1": (x - 1 - log(x), Fraction(1), -1, 1),
    "x³ left of 0": (x**3, Fraction(0), -1, -1),
    "√x left of 0": (sqrt(x), Fraction(0), -1, 0),
    "e^x − e^1 e^(x−1) is nothing": (exp(x) - exp(expr(1)) * exp(x - 1), Fraction(1), 1, 0),
}


@pytest.mark.parametrize("name", BESIDE)
def test_signs_beside_a_point(name):
    tree, point, side, sign = BESIDE[name]
    result = [sign_beside(tree.tree, "x", point, side * Fraction(1, 2**k)) for k in range(1, 14)]
    assert set(result) <= {0, sign}
    assert result[-1] == sign


def test_what_is_undefined_at_0_is_not_positive_there():
    """Its sign right of 0 is known, and no proof for a domain with 0 in it."""
    assert sign_beside((sinh(x) / x).tree, "x", Fraction(0), Fraction(1, 4)) > 0
    verdicts = [
        propose(for_all(f > 0, 0, 1, open_low=open_low)).verdict.value
        for f, open_low in ((sinh(x) / x, False), (sinh(x) / x, True), (1 + sqrt(x), False))
    ]
    assert verdicts == ["undecided", "proved", "proved"]


def test_a_divisor_that_vanishes_is_not_cancelled():
    """Signs are those of lowest terms; that a value is there at all is judged beside them."""
    verdicts = [
        propose(for_all(expr(0) < quotient, 0, open_low=open_low)).verdict.value
        for quotient, open_low in (
            (x / x, False),
            (x / x, True),
            ((x - 1) / (x - 1), True),
            (1 / (1 + x**2), False),
        )
    ]
    assert verdicts == ["undecided", "proved", "undecided", "proved"]
