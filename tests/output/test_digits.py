"""Numbers beside words of proof: always on the safe side, never longer than asked."""

import math
from decimal import Decimal
from fractions import Fraction

import pytest
from flint import arb
from hypothesis import example, given
from hypothesis import strategies as st

from lyapcheck.check.numbers.polynomials import Enclosure
from lyapcheck.output.digits import at_least, at_most

DIGITS = st.integers(1, 12)
FRACTIONS = st.builds(
    lambda top, bottom, power: Fraction(top, bottom) * Fraction(10) ** power,
    st.integers(-(10**20), 10**20),
    st.integers(1, 10**20),
    st.integers(-330, 330),
)
FLOATS = st.floats(allow_nan=False, allow_infinity=False)
NUMBERS = st.one_of(FRACTIONS, FLOATS, st.integers())


def digits_of(text):
    """Significant digits of a decimal as written, zeros at both ends left out."""
    return len(text.partition("e")[0].replace(".", "").lstrip("-").strip("0")) or 1


@given(x=NUMBERS, digits=DIGITS)
@example(x=0.0, digits=1)
@example(x=-0.0, digits=3)
@example(x=5e-324, digits=2)
@example(x=1.7976931348623157e308, digits=4)
@example(x=Fraction(99999, 10), digits=4)
@example(x=Fraction(-99999, 10), digits=4)
def test_the_text_is_on_the_safe_side_and_the_nearest_there(x, digits):
    value, up, down = Fraction(x), Fraction(at_most(x, digits)), Fraction(at_least(x, digits))
    assert down <= value <= up
    size = abs(Decimal(value.numerator) / Decimal(value.denominator))
    unit = Fraction(10) ** (size.adjusted() + 2 - digits) if value else Fraction(0)
    assert up - value <= unit
    assert value - down <= unit
    assert max(digits_of(at_most(x, digits)), digits_of(at_least(x, digits))) <= digits


@given(x=NUMBERS, digits=DIGITS)
def test_the_two_are_mirror_images(x, digits):
    assert Fraction(at_most(x, digits)) == -Fraction(at_least(-Fraction(x), digits))


@given(units=st.integers(-9999, 9999), power=st.integers(-20, 20))
def test_a_decimal_that_is_short_enough_is_written_as_it_is(units, power):
    x = units * Fraction(10) ** power
    assert at_most(x, 4) == at_least(x, 4)
    assert Fraction(at_most(x, 4)) == x


@given(x=NUMBERS, less=DIGITS, more=DIGITS)
def test_more_digits_are_never_farther_away(x, less, more):
    few, many = sorted((less, more))
    assert Fraction(at_most(x, many)) <= Fraction(at_most(x, few))
    assert Fraction(at_least(x, many)) >= Fraction(at_least(x, few))


@given(middle=st.floats(-1e6, 1e6), radius=st.floats(0, 10), digits=DIGITS)
def test_of_a_ball_the_end_counts(middle, radius, digits):
    ball = arb(middle, radius)
    ends = Enclosure.from_arb(ball)
    assert Fraction(at_least(ball, digits)) <= ends.lower <= ends.upper <= Fraction(at_most(ball, digits))
    assert at_most(ends, digits) == at_most(ends.upper, digits) == at_most(ball, digits)
    assert at_least(ends, digits) == at_least(ends.lower, digits) == at_least(ball, digits)


@pytest.mark.parametrize(
    ("x", "up", "down"),
    [
        (math.inf, "∞", "∞"),
        (-math.inf, "-∞", "-∞"),
        (arb(0, math.inf), "∞", "-∞"),
        (arb("inf"), "∞", "∞"),
        (arb("-inf"), "-∞", "-∞"),
        (Fraction(2, 3), "0.6667", "0.6666"),
        (Fraction(-2, 3), "-0.6666", "-0.6667"),
        (12345, "12350", "12340"),
        (99999, "100000", "99990"),
        (Fraction(1, 10**6), "0.000001", "0.000001"),
        (Fraction(10**15 + 1), "1.001e+15", "1e+15"),
        (Fraction(2, 3 * 10**7), "6.667e-8", "6.666e-8"),
        (25, "25", "25"),
    ],
)
def test_what_people_read(x, up, down):
    assert at_most(x) == up  # type: ignore[arg-type]
    assert at_least(x) == down  # type: ignore[arg-type]


@pytest.mark.parametrize("round_", [at_most, at_least])
@pytest.mark.parametrize("x", [math.nan, arb("nan")])
def test_what_is_no_number_has_no_decimal(round_, x):
    with pytest.raises(ValueError, match="no decimal"):
        round_(x)  # type: ignore[operator]


def test_no_digits_are_refused():
    with pytest.raises(ValueError, match="1 or more"):
        at_most(1, 0)
