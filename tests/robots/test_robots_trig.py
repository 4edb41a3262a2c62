"""Trigonometric polynomials: normal forms, derivatives, evaluation in several arithmetics."""

from __future__ import annotations

from fractions import Fraction

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


def test_different_functions_have_different_normal_forms() -> None:
    assert trig.normal_form(S1**2) != trig.normal_form(C1**2)
    assert trig.normal_form(S1 * C2 + C1 * S2) != trig.normal_form(S1 * C2 - C1 * S2)


@costly
@given(polys, polys)
def test_derivative_obeys_leibniz(f: object, g: object) -> None:
    product = trig.derivative(f * g, 0)
    assert product == trig.normal_form(trig.derivative(f, 0) * g + f * trig.derivative(g, 0))


@costly
@given(polys, angles(2))
def test_balls_contain_the_exact_value(poly: object, points: list[tuple[Fraction, Fraction]]) -> None:
    def ball(x: Fraction) -> arb:
        return arb(x.numerator) / arb(x.denominator)

    (s1, c1), (s2, c2) = points
    value = trig.evaluate(poly, [ball(x) for x in (s1, s2, c1, c2, Fraction(3, 7))], ball)
    assert value.overlaps(ball(at(poly, points)))
    assert (value - ball(at(poly, points))).contains(0)


def test_substitute_moves_to_the_smaller_ring() -> None:
    ring = trig.trig_ring(2)
    assert trig.substitute(2 * P * S1 + P**2, {"p": Fraction(1, 2)}, ring) == ring.gen(0) + exact_quarter(
        ring
    )


def exact_quarter(ring: object) -> object:
    return trig.constant(ring, Fraction(1, 4))


def test_derivative_of_generators() -> None:
    assert trig.derivative(S1, 0) == C1
    assert trig.derivative(C1, 0) == -S1
    assert trig.derivative(C1, 1) == 0
    assert trig.derivative(P * S2, 1) == P * C2
