"""Trigonometric polynomials: normal forms, derivatives, evaluation in several arithmetics."""

from __future__ import annotations

import math
from fractions import Fraction

import pytest
from flint import arb
from hypothesis import given
from hypothesis import strategies as st

from lyapcheck.robots import trig
from tests.helpers.costly import costly
from tests.helpers.robot_cases import angles

RING = trig.trig_ring(2, ("p",))
S1, S2, C1, C2, P = RING.gens()
powers = st.tuples(*[st.integers(0, 3)] * 5)
polys = st.dictionaries(powers, st.fractions(max_denominator=9).filter(bool), max_size=6).map(
    lambda terms: trig.from_terms(RING, list(terms.items()))
)


def at(poly: object, points: list[tuple[Fraction, Fraction]], p: Fraction = Fraction(3, 7)) -> Fraction:
    (s1, c1), (s2, c2) = points
    return trig.evaluate(poly, [s1, s2, c1, c2, p], Fraction)


@costly
@given(polys, angles(2))
def test_normal_form_keeps_the_function(poly: object, points: list[tuple[Fraction, Fraction]]) -> None:
    assert at(trig.normal_form(poly), points) == at(poly, points)


@costly
@given(polys, polys)
def test_normal_form_is_unique(f: object, g: object) -> None:
    same = f + g * (S1**2 + C1**2 - 1) + f * (S2**2 + C2**2 - 1) * S1
    assert trig.normal_form(same) == trig.normal_form(f)


@costly
@given(polys)
def test_normal_form_has_no_squared_sine(poly: object) -> None:
    assert all(degree <= 1 for degree in trig.normal_form(poly).degrees()[:2])


def test_different_functions_have_different_normal_forms() -> None:
    assert trig.normal_form(S1**2) != trig.normal_form(C1**2)
    assert trig.normal_form(S1 * C2 + C1 * S2) != trig.normal_form(S1 * C2 - C1 * S2)


@costly
@given(polys, polys)
def test_derivative_obeys_leibniz(f: object, g: object) -> None:
    product = trig.derivative(f * g, 0)
    assert product == trig.normal_form(trig.derivative(f, 0) * g + f * trig.derivative(g, 0))


def test_derivative_of_generators() -> None:
    assert trig.derivative(S1, 0) == C1
    assert trig.derivative(C1, 0) == -S1
    assert trig.derivative(C1, 1) == 0
    assert trig.derivative(P * S2, 1) == P * C2


@pytest.mark.slow
@costly
@given(polys, st.floats(-3, 3), st.floats(-3, 3))
def test_derivative_is_the_slope(poly: object, q1: float, q2: float) -> None:
    def value(f: object, x: float) -> float:
        return trig.evaluate(f, [math.sin(x), math.sin(q2), math.cos(x), math.cos(q2), 0.5], float)

    step = 1e-5
    slope = (value(poly, q1 + step) - value(poly, q1 - step)) / (2 * step)
    scale = 1 + sum(abs(float(c)) for _, c in trig.to_terms(poly))
    assert value(trig.derivative(poly, 0), q1) == pytest.approx(slope, abs=1e-6 * scale)


@costly
@given(polys, angles(2))
def test_balls_contain_the_exact_value(poly: object, points: list[tuple[Fraction, Fraction]]) -> None:
    def ball(x: Fraction) -> arb:
        return arb(x.numerator) / arb(x.denominator)

    (s1, c1), (s2, c2) = points
    value = trig.evaluate(poly, [ball(x) for x in (s1, s2, c1, c2, Fraction(3, 7))], ball)
    assert value.overlaps(ball(at(poly, points)))
    assert (value - ball(at(poly, points))).contains(0)


@costly
@given(polys)
def test_terms_bring_the_polynomial_back(poly: object) -> None:
    assert trig.from_terms(RING, trig.to_terms(poly)) == poly


def test_zero_and_constants_evaluate() -> None:
    values = [Fraction(1)] * 5
    assert trig.evaluate(trig.constant(RING, 0), values, Fraction) == 0
    assert trig.evaluate(trig.constant(RING, Fraction(1, 3)), values, Fraction) == Fraction(1, 3)


def test_substitute_moves_to_the_smaller_ring() -> None:
    ring = trig.trig_ring(2)
    assert trig.substitute(2 * P * S1 + P**2, {"p": Fraction(1, 2)}, ring) == ring.gen(0) + exact_quarter(
        ring
    )


def exact_quarter(ring: object) -> object:
    return trig.constant(ring, Fraction(1, 4))
