"""Absolute values of parts whose sign is seen on a piece of the domain."""

from fractions import Fraction as F

import pytest

from lyapcheck.check.expressions.domain import Interval
from lyapcheck.check.kinds.for_all import without_abs
from lyapcheck.claims import for_all, h, tanh, var
from lyapcheck.claims.procedures import propose
from lyapcheck.verdicts import Verdict

x = var("x")
TRUE = {
    "h and the identity": for_all(abs(h(2, x)) <= abs(x)),
    "strict but at 0": for_all(abs(h(2, x)) < abs(x), low=0, open_low=True),
    "a smaller slope": for_all(abs(h(2, x)) <= F(9, 10) * abs(x)),
    "on the left": for_all(abs(tanh(x)) <= -x, high=0),
    "one factor": for_all(x * abs(x) <= x**2),
}
FALSE = {
    "strict at 0": for_all(abs(h(2, x)) < abs(x)),
    "too small a slope": for_all(abs(h(2, x)) <= F(86, 100) * abs(x)),
    "a sign that changes": for_all(abs(x - 1) <= abs(x) + F(9, 10)),
    "of the other sign": for_all(abs(tanh(x)) <= x),
}


@pytest.mark.parametrize("name", TRUE)
def test_an_absolute_value_is_the_part_or_its_negative(name):
    assert propose(TRUE[name]).verdict is Verdict.PROVED


@pytest.mark.parametrize("name", FALSE)
def test_what_is_false_is_refuted(name):
    assert propose(FALSE[name]).verdict is Verdict.REFUTED


def test_only_a_sign_that_is_seen_is_used():
    to_right, both = {"x": Interval(F(0))}, {"x": Interval(F(-1), F(1))}
    tree = abs(x).tree
    assert without_abs(tree, to_right) == x.tree
    assert without_abs(tree, both) == tree
    assert without_abs(abs(x - 1).tree, to_right) == abs(x - 1).tree
    assert without_abs(abs(-x).tree, to_right) == ("neg", (-x).tree)
