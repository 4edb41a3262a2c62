"""The certified constants against high-precision root finding and against exact facts."""

from fractions import Fraction
from itertools import pairwise

import mpmath
import pytest
from flint import arb, ctx
from hypothesis import given
from hypothesis import strategies as st

from lyapcheck.check.numbers.balls import bracketed_root, hyperbolic_constants, peak_of_h
from lyapcheck.check.numbers.polynomials import Enclosure
from lyapcheck.family.asymptotes import gamma_less_than

DIGITS = 40


@pytest.fixture(autouse=True)
def _precision():
    ctx.prec = 53
    yield
    assert ctx.prec == 53, "a function left flint's precision changed"


def _h(m):
    return lambda x: mpmath.sinh(x) ** (2 * m - 1) * mpmath.cosh(x) / (1 + mpmath.sinh(x) ** (2 * m))


def _dh(m):
    def value(x):
        s = mpmath.sinh(x)
        return ((2 * m - 1) * s ** (2 * m - 2) + 2 * m * s ** (2 * m) - s ** (4 * m - 2)) / (
            1 + s ** (2 * m)
        ) ** 2

    return value


def _critical_points(function, low, high, steps=400):
    """All simple extremes of a function on an interval, by brute force, knowing nothing of the family."""

    def slope(x):
        return mpmath.diff(function, x)

    grid = [low + (high - low) * mpmath.mpf(k) / steps for k in range(steps + 1)]
    slopes = [slope(x) for x in grid]
    return [
        mpmath.findroot(slope, (a, b), solver="anderson", verify=False)
        for (a, u), (b, v) in pairwise(zip(grid, slopes, strict=True))
        if u * v < 0
    ]


@pytest.mark.parametrize("m", [2, 3, 7])
def test_constants_agree_with_a_search_for_all_extremes(m):
    with mpmath.workdps(60):
        known = hyperbolic_constants(m, DIGITS)
        cases = (
            (known.gamma, known.gamma_at, _h(m)),
            (known.rho, known.rho_at, lambda x: abs(_dh(m)(x))),
            (known.L, known.L_at, lambda x: _h(m)(x) / x),
        )
        for value, place, function in cases:
            points = _critical_points(function, mpmath.mpf("0.2"), mpmath.mpf(6), steps=100)
            best = max(points, key=function)
            _assert_close(value, function(best))
            _assert_close(place, best, digits=25)


def _mp(enclosure):
    return mpmath.mpf(enclosure.mid.numerator) / enclosure.mid.denominator


def _assert_close(enclosure, value, digits=38):
    assert abs(_mp(enclosure) - value) < mpmath.mpf(10) ** (1 - digits) * max(1, value)


def test_m_one_is_the_hyperbolic_tangent():
    known = hyperbolic_constants(1)
    one, zero = Enclosure.exact(1), Enclosure.exact(0)
    assert (known.gamma, known.rho, known.L) == (one, one, one)
    assert (known.gamma_at, known.rho_at, known.L_at) == (None, zero, zero)


def test_m_two_has_a_peak_in_closed_form():
    with ctx.workprec(200):
        assert peak_of_h(2).overlaps(2 + arb(7).sqrt())


@given(m=st.integers(2, 2000), digits=st.integers(1, 120))
def test_enclosures_are_as_narrow_as_asked(m, digits):
    known = hyperbolic_constants(m, digits)
    for value in (known.gamma, known.rho, known.L, known.gamma_at, known.rho_at, known.L_at):
        assert 0 < value.width < value.lower * Fraction(1, 10**digits)


@given(m=st.integers(2, 500))
def test_more_digits_stay_inside_fewer(m):
    rough, fine = hyperbolic_constants(m, 10), hyperbolic_constants(m, 60)
    for name in ("gamma", "rho", "L", "gamma_at", "rho_at", "L_at"):
        a, b = getattr(rough, name), getattr(fine, name)
        assert a.lower <= b.lower <= b.upper <= a.upper


def test_gamma_grows_with_m_towards_the_square_root_of_two():
    values = [hyperbolic_constants(m, 20).gamma for m in (1, 2, 3, 4, 10, 100, 1000, 100_000)]
    assert all(a.upper < b.lower for a, b in pairwise(values))
    assert values[-1].upper ** 2 < 2


def test_gamma_two_and_three_exceed_what_the_paper_prints():
    assert not gamma_less_than(2, Fraction("1.05") ** 2)
    assert not gamma_less_than(3, Fraction("1.11") ** 2)
    assert gamma_less_than(2, Fraction("1.06") ** 2)
    assert gamma_less_than(3, Fraction("1.12") ** 2)


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
    from lyapcheck.family import asymptotes as compared

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
