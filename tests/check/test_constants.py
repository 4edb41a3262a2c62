"""The certified constants against high-precision root finding and against exact facts."""

from fractions import Fraction

import pytest
from flint import arb, ctx
from hypothesis import given
from hypothesis import strategies as st

from lyapcheck.check.numbers.balls import bracketed_root, hyperbolic_constants
from lyapcheck.family.members.hyperbolic import gamma_less_than


@pytest.fixture(autouse=True)
def _precision():
    ctx.prec = 53
    yield
    assert ctx.prec == 53, "a function left flint's precision changed"


@given(m=st.integers(2, 2000), digits=st.integers(1, 120))
def test_enclosures_are_as_narrow_as_asked(m, digits):
    known = hyperbolic_constants(m, digits)
    for value in (known.gamma, known.rho, known.L, known.gamma_at, known.rho_at, known.L_at):
        assert 0 < value.width < value.lower * Fraction(1, 10**digits)


def test_gamma_less_than_is_strict_at_the_supremum_of_tanh():
    assert not gamma_less_than(1, Fraction(1))
    assert gamma_less_than(1, 1 + Fraction(1, 10**50))


@given(m=st.integers(2, 40), exponent=st.integers(1, 400), sign=st.sampled_from((-1, 1)))
def test_gamma_less_than_decides_however_close_the_bound_is(m, exponent, sign):
    gamma = hyperbolic_constants(m, 450).gamma.mid
    bound = gamma**2 + sign * Fraction(1, 10**exponent)
    assert gamma_less_than(m, bound) is (sign > 0)


def test_equality_is_recognised_by_a_common_positive_root():
    """γ_m² is irrational for the m tried, so equality is planted: R vanishes at the peak of a stand-in."""
    from lyapcheck.family.members import hyperbolic as compared

    assert compared._has_positive_root(compared.fmpq_poly([-2, 0, 1]))
    assert not compared._has_positive_root(compared.fmpq_poly([1, 1]))
    assert not compared._has_positive_root(compared.fmpq_poly([3]))
    assert not any(
        compared._gamma_squared_is(m, hyperbolic_constants(m, 50).gamma.mid ** 2) for m in (2, 3, 9)
    )


def test_a_root_is_not_claimed_without_a_change_of_sign():
    with pytest.raises(ArithmeticError, match="no change of sign"):
        bracketed_root(lambda x: (x - 1) ** 2 + arb("1e-3"), arb(0), arb(2))


@pytest.mark.parametrize(("m", "digits"), [(0, 30), (-3, 30), (2, 0)])
def test_bad_arguments_are_refused(m, digits):
    with pytest.raises(ValueError, match="at least 1"):
        hyperbolic_constants(m, digits)
