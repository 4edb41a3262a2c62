"""Enclosures and the ball forms: nothing ever gets outside."""

import math
from fractions import Fraction

import pytest
from flint import arb, ctx
from hypothesis import given
from hypothesis import strategies as st

from lyapcheck.check.numbers import balls
from lyapcheck.check.numbers.balls import hyperbolic_constants
from lyapcheck.check.numbers.polynomials import Enclosure
from lyapcheck.output.digits import correct_digits, decimals

rationals = st.fractions(max_denominator=10**12)
widths = st.fractions(min_value=0, max_denominator=10**9)


@given(lower=rationals, width=widths, digits=st.integers(1, 40))
def test_decimals_enclose(lower, width, digits):
    low, high = decimals(Enclosure(lower, lower + width), digits)
    assert Fraction(low) <= lower
    assert lower + width <= Fraction(high)


@pytest.mark.parametrize(
    ("value", "digits", "shown"),
    [
        (1, 30, "1"),
        (0, 5, "0"),
        (Fraction(1, 4), 5, "0.25"),
        (Fraction(-1, 3), 4, "-0.3333"),
        (1500, 2, "1500"),
    ],
)
def test_exact_numbers_are_written_as_they_are(value, digits, shown):
    assert correct_digits(Enclosure.exact(Fraction(value)), digits) == shown


@given(value=rationals)
def test_float_bounds_are_outward_and_adjacent(value):
    enclosure = Enclosure.exact(value)
    low, high = enclosure.float_lower, enclosure.float_upper
    assert Fraction(low) <= value <= Fraction(high)
    assert low == high or math.nextafter(low, math.inf) == high


def test_float_bounds_beyond_the_largest_double():
    huge = Enclosure.exact(Fraction(10) ** 400)
    assert huge.float_lower == math.nextafter(math.inf, 0)
    assert huge.float_upper == math.inf


def test_an_enclosure_has_no_truth_value():
    with pytest.raises(TypeError, match="truth value"):
        bool(Enclosure.exact(1))


@pytest.mark.parametrize("bad", ["nan", "inf", "[0 +/- inf]"])
def test_a_ball_without_ends_is_refused(bad):
    with pytest.raises(ValueError, match="encloses nothing"):
        Enclosure.from_arb(arb(bad))


def test_ends_out_of_order_are_refused():
    with pytest.raises(ValueError, match="out of order"):
        Enclosure(Fraction(1), Fraction(0))


@given(value=rationals, width=widths)
def test_conversion_to_a_ball_and_back_only_widens(value, width):
    enclosure = Enclosure(value, value + width)
    again = Enclosure.from_arb(enclosure.to_arb())
    assert again.lower <= enclosure.lower <= enclosure.upper <= again.upper


FORMS = {"h": balls.h, "dh": balls.dh, "potential": balls.potential}
points = st.floats(-6, 6) | st.floats(allow_nan=False, allow_infinity=False)


@pytest.mark.parametrize("name", FORMS)
@given(m=st.sampled_from((1, 2, 3, 20, 1000)), x=points)
def test_points_agree_with_more_precision(name, m, x):
    rough = FORMS[name](m, arb(x))
    with balls.precision(300):
        fine = FORMS[name](m, arb(x))
    assert rough.contains(fine.mid())


@pytest.mark.parametrize("name", FORMS)
@given(
    m=st.sampled_from((1, 2, 3, 20)), middle=st.floats(-4, 4), radius=st.floats(0, 3), inside=st.floats(-1, 1)
)
def test_wide_balls_contain_the_values_at_their_points(name, m, middle, radius, inside):
    point = arb(middle) + arb(radius) * inside
    wide = FORMS[name](m, arb(middle, radius))
    assert wide.is_finite()
    assert wide.contains(FORMS[name](m, point.mid()).mid())


def test_wide_balls_reach_no_further_than_the_extremes():
    everything = arb(0, 50)
    for m in (2, 3, 20):
        known = hyperbolic_constants(m)
        assert abs(balls.h(m, everything)).upper() < known.gamma.float_upper * 1.000001
        assert balls.dh(m, everything).upper() < known.rho.float_upper * 1.000001


@pytest.mark.parametrize("name", FORMS)
def test_no_number_comes_of_no_number(name):
    assert FORMS[name](2, arb("nan")).is_nan()


def test_precision_is_put_back_after_an_error():
    before = ctx.prec

    def fail_inside():
        with balls.precision(999):
            assert ctx.prec == 999
            raise RuntimeError

    with pytest.raises(RuntimeError):
        fail_inside()
    assert ctx.prec == before


@pytest.mark.parametrize("power", [10**6, -(10**6), 10**15])
def test_numbers_that_would_fill_the_memory_are_refused(power):
    """2^(10^15) is a ball of a few bytes, and a rational of a hundred terabytes."""
    with pytest.raises(ValueError, match="too large or too small to write down"):
        Enclosure.from_arb(arb(2) ** power)
