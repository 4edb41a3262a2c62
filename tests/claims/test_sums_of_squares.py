"""Polynomial facts: strictness comes from a hypothesis or from the form, and is never invented."""

from collections import Counter
from fractions import Fraction
from random import Random

import pytest

from lyapcheck.claims import cos, expr, implies, nonnegative, positive, reals, sin, var
from lyapcheck.claims.procedures import implication, propose
from lyapcheck.verdicts import Verdict
from tests.helpers.polynomial_facts import fact
from tests.helpers.shares import one_in

x, y, z, a, b, c = map(var, "xyzabc")
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


# Sums of squares --------------------------------------------------------------------------------------------

V = 3 * x**2 / 2 - x * y + y**2
RATE = -(x**2) - y**2 - x**3 * y + 2 * x**2 * y**2
AWAY = x**2 + y**2 > 0
TEXTBOOK = {
    "a trinomial": implies(OF_REALS, [], x**2 - x * y + y**2 >= 0),
    "a product": implies(OF_REALS, [], x * y <= x**2 + y**2),
    "a square": implies(OF_REALS, [], 2 * x * y <= x**2 + y**2),
    "V with cross terms": implies(OF_REALS, [AWAY], V > 0),
    "V away from the origin otherwise": implies(OF_REALS, [x**2 + y**4 > 0], V > 0),
    "V above a form": implies(OF_REALS, [], (x**2 + y**2) / 2 <= V),
    "Van der Pol, V falls": implies(OF_REALS, [AWAY, V <= 2], RATE < 0),
    "Van der Pol, a bounded region": implies(OF_REALS, [V <= 2], x**2 + y**2 <= 4),
    "with a constant": implies(OF_REALS, [], x**2 - 2 * x * y + y**2 + 1 > 0),
    "a half-plane": implies(OF_REALS, [x + y > 1], x**2 + y**2 > expr("1/2")),
    "two means": implies(nonnegative("a", "b", "c"), [], a**3 + b**3 + c**3 >= 3 * a * b * c),
    "gains": implies(positive("a", "b"), [], a**2 - a * b + b**2 > 0),
    "Motzkin": implies(OF_REALS, [], x**4 * y**2 + x**2 * y**4 + 1 >= 3 * x**2 * y**2),
    "Pythagoras": implies(reals("x"), [], sin(x) ** 2 + cos(x) ** 2 <= 1),
    "a bound": implies(reals("x"), [], sin(x) * cos(x) <= Fraction(1, 2)),
    "a sum": implies(reals("x"), [], (sin(x) + cos(x)) ** 2 <= 2),
    "strict": implies(reals("x"), [], sin(x) < Fraction(3, 2)),
    "with a variable": implies(reals("x", "y"), [y**2 <= 1], y * sin(x) <= 1),
    "an equation": implies(reals("x", "y"), [x * y <= 1, x * y >= 1, x <= y, x >= y], x**2 + y**2 <= 2),
    "of odd degree": implies(reals("x", "y", "z"), [x <= y**2, x >= y**2], z * x <= z * y**2),
    "a shift": implies([*OF_REALS, *positive("a")], [a >= 2], x**2 + a * x * y + a**2 * y**2 >= 0),
}
PLANTED = {
    "the origin": implies(OF_REALS, [], x**2 - x * y + y**2 > 0),
    "the border of a half-plane": implies(OF_REALS, [x + y >= 1], x**2 + y**2 > expr("1/2")),
    "thirds": implies(reals("a", "b", "c"), [a + b + c >= 1], a**2 + b**2 + c**2 > expr("1/3")),
    "equal numbers": implies(positive("a", "b", "c"), [], a**3 + b**3 + c**3 > 3 * a * b * c),
    "Motzkin": implies(OF_REALS, [], x**4 * y**2 + x**2 * y**4 + 1 > 3 * x**2 * y**2),
    "beyond": implies(OF_REALS, [], x**2 - expr("2.000001") * x * y + y**2 >= 0),
    "a large region": implies(OF_REALS, [AWAY, V <= 3], RATE < 0),
    "the wrong side": implies(OF_REALS, [x + y <= 1], x**2 + y**2 >= expr("1/2")),
}


BEYOND = {
    "too small a bound": implies(reals("x"), [], sin(x) * cos(x) <= Fraction(49, 100)),
    "a strict bound that is met": implies(reals("x"), [], sin(x) < 1),
    "half of an equation": implies(reals("x", "y", "z"), [x <= y**2], z * x <= z * y**2),
    "strict from an equation": implies(reals("x", "y"), [x <= y, x >= y], x < y),
    "zero of a sine": implies(reals("x"), [x**2 > 0], sin(x) ** 2 > 0),
    "zero of 1 − cos": implies(reals("x"), [x**2 > 0], 1 - cos(x) > 0),
    "the origin": implies(reals("x"), [], 1 - cos(x) > 0),
}


@pytest.mark.parametrize("name", BEYOND)
def test_what_is_false_of_sines_or_equations_is_not_proved(name):
    assert propose(BEYOND[name]).verdict is not Verdict.PROVED


@pytest.mark.parametrize("name", one_in(5, TEXTBOOK))
def test_a_textbook_fact_is_proved(name):
    assert propose(TEXTBOOK[name]).verdict is Verdict.PROVED


@pytest.mark.parametrize("name", PLANTED)
def test_a_planted_fault_is_refuted(name):
    assert propose(PLANTED[name]).verdict is Verdict.REFUTED


def verdicts(true, draws):
    return Counter(propose(fact(Random(f"{true} {k}"), true)).verdict for k in draws)


@pytest.mark.slow
def test_most_facts_drawn_at_random_are_decided_and_none_wrongly():
    true, false = verdicts(True, range(100)), verdicts(False, range(100))
    assert true[Verdict.REFUTED] == false[Verdict.PROVED] == 0
    assert true[Verdict.PROVED] >= 95
    assert false[Verdict.REFUTED] >= 90


def test_a_missing_library_is_named(monkeypatch):
    monkeypatch.setattr(implication, "installed", lambda name: name != "cvxpy")
    found = implication.find_implies(TEXTBOOK["a trinomial"])
    assert found.verdict is Verdict.UNDECIDED
    assert "pip install cvxpy" in found.reason
