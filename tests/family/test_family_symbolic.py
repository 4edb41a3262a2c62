"""The family in SymPy, for every m at once."""

from __future__ import annotations

import pytest
import sympy as sp

from lyapcheck.family.symbolic import hyperbolic_symbolic
from tests.family.same_function import hyperbolic_printed, same_function

x = sp.Symbol("x", real=True)
m = sp.Symbol("m", positive=True, integer=True)
every_m = pytest.mark.parametrize("member", [m, sp.Symbol("m"), 1, 2, 3, 11])


@every_m
def test_the_printed_formulas_are_the_derivatives_of_the_potential(member):
    derived, printed = hyperbolic_symbolic(x, member), hyperbolic_printed(x, member)
    assert derived.potential == printed.potential
    assert same_function(derived.h, printed.h, x, member)
    assert same_function(derived.dh, printed.dh, x, member)


@every_m
def test_a_changed_coefficient_is_noticed(member):
    s = sp.sinh(x)
    printed = hyperbolic_printed(x, member)
    planted = printed.dh + s ** (2 * member) / (1 + s ** (2 * member)) ** 2
    assert not same_function(printed.dh, planted, x, member)
    assert not same_function(printed.h, -printed.h, x, member)


def test_second_derivative_has_the_sign_of_the_polynomial_whose_roots_give_rho():
    s, c = sp.sinh(x), sp.cosh(x)
    polynomial = (
        (2 * m - 1) * (m - 1)
        + 2 * m**2 * s**2
        - (2 * m - 1) * (m + 2) * s ** (2 * m)
        - 2 * m**2 * s ** (2 * m + 2)
        + s ** (4 * m)
    )
    expected = 2 * c * s ** (2 * m - 3) * polynomial / (1 + s ** (2 * m)) ** 3
    assert same_function(sp.diff(hyperbolic_printed(x, m).dh, x), expected, x, m)


def test_derivative_has_the_sign_of_the_polynomial_whose_root_gives_gamma():
    s = sp.sinh(x)
    expected = s ** (2 * m - 2) * (2 * m - 1 + 2 * m * s**2 - s ** (2 * m)) / (1 + s ** (2 * m)) ** 2
    assert same_function(hyperbolic_printed(x, m).dh, expected, x, m)


def test_cosh_squared_is_reduced():
    assert same_function(sp.cosh(x) ** 2, 1 + sp.sinh(x) ** 2, x, m)
    assert same_function(sp.cosh(x) ** 4 - sp.sinh(x) ** 4, sp.cosh(x) ** 2 + sp.sinh(x) ** 2, x, 2)
    assert not same_function(sp.cosh(x), sp.sinh(x), x, m)


def test_tanh_is_the_first_member():
    assert same_function(hyperbolic_symbolic(x, 1).h, sp.sinh(x) / sp.cosh(x), x, 1)


def test_other_functions_are_refused():
    with pytest.raises(ValueError, match="not rational"):
        same_function(sp.sin(x), sp.cosh(x), x, m)
