"""Decimals of so many significant digits, of numbers of any size."""

from fractions import Fraction

import pytest
from hypothesis import given
from hypothesis import strategies as st

from lyapcheck.files.decimals import significant_down, significant_up

SIZES = st.builds(
    lambda p, q, e: Fraction(p, q) * Fraction(10) ** e,
    st.integers(1, 10**6),
    st.integers(1, 10**6),
    st.integers(-700, 700),
)


@given(SIZES, st.integers(1, 12))
def test_the_nearest_decimals_below_and_above(value, digits):
    low, high = significant_down(value, digits), significant_up(value, digits)
    assert low <= value <= high
    assert high - low <= value * Fraction(10) ** (1 - digits)
    for one in (low, high):
        written = f"{one.numerator}{'0' * 2000}" if one.denominator == 1 else str(one * 10**2000)
        assert len(written.rstrip("0")) <= digits


@pytest.mark.parametrize("exponent", [-300, -22, -1, 0, 1, 22, 300])
def test_powers_of_ten_are_themselves(exponent):
    power = Fraction(10) ** exponent
    assert significant_down(power, 1) == significant_up(power, 1) == power


def test_nothing_is_nothing():
    assert significant_down(Fraction(0), 3) == significant_up(Fraction(0), 3) == 0
