"""Polynomial facts: strictness comes from a hypothesis or from the form, and is never invented."""

import pytest

from lyapcheck.claims import implies, nonnegative, positive, reals, var
from lyapcheck.claims.procedures import propose
from lyapcheck.verdicts import Verdict

x, y, a, b, c = map(var, "xyabc")
OF_REALS = reals("x", "y")

STRICT = {
    "itself": implies(reals("x"), [x**2 > 0], x**2 > 0),
    "a multiple": implies(reals("x"), [2 * x**2 > 0], x**2 / 3 > 0),
    "a sum": implies(OF_REALS, [x**2 + y**2 > 0], 2 * x**2 + 3 * y**2 > 0),
    "with more": implies(OF_REALS, [x**2 + y**2 > 0], x**2 + 3 * y**2 + x**4 > 0),
    "times a gain": implies([*OF_REALS, *positive("a")], [x**2 + y**2 > 0], a * x**2 + 2 * a * y**2 > 0),
    "the other one": implies(OF_REALS, [y**2 >= 0, x**2 > 0], x**2 + y**2 > 0),
    "less a square": implies(OF_REALS, [x**2 - y**2 > 0], x**2 > 0),
    "after a bound": implies(reals("x", "y", "a"), [x**2 <= a, x**2 > 0], a + y**2 > 0),
}
BORDER = {
    "nothing excludes 0": implies(OF_REALS, [], x**2 + y**2 > 0),
    "not a strict hypothesis": implies(OF_REALS, [x**2 + y**2 >= 0], x**2 + y**2 > 0),
    "of the other variable": implies(OF_REALS, [y**2 > 0], x**2 > 0),
    "of both, for one": implies(OF_REALS, [x**2 + y**2 > 0], x**2 > 0),
    "a gain that may vanish": implies([*OF_REALS, *nonnegative("a")], [x**2 > 0], a * x**2 > 0),
    "positive ends": implies(nonnegative("a", "b"), [a + b > 0], a * b > 0),
}


@pytest.mark.parametrize("name", STRICT)
def test_a_strict_hypothesis_makes_the_conclusion_strict(name):
    assert propose(STRICT[name]).verdict is Verdict.PROVED


@pytest.mark.parametrize("name", BORDER)
def test_strictness_at_a_border_is_refuted(name):
    assert propose(BORDER[name]).verdict is Verdict.REFUTED
