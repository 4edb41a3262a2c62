"""The numeric hyperbolic family against balls of 400 bits, in units in the last place."""

from __future__ import annotations

import math

import casadi as ca
import numpy as np
import pytest
from flint import arb
from hypothesis import given
from hypothesis import strategies as st

from lyapcheck import family
from lyapcheck.check.numbers import balls
from lyapcheck.check.numbers.constants import hyperbolic_constants

MEMBERS = (1, 2, 3, 5, 10, 50, 100, 317, 513, 1000)


def secant(m, x):
    """h_m(x)/x, and h_m'(0) at x = 0."""
    return balls.h(m, x) / x if x != 0 else balls.dh(m, x)


FORMS = {"h": balls.h, "dh": balls.dh, "potential": balls.potential, "secant": secant}
BORDER = 0.8813735870195430
LIMIT = 4.0


def units(value, exact):
    """The distance between a double and a number, in the spacing of doubles at that number."""
    reference = float(exact.mid())
    ulp = 2.0**-1074 if abs(reference) < 2.0**-1022 else math.ldexp(1.0, math.frexp(reference)[1] - 53)
    return float((abs(arb(value) - exact) / arb(ulp)).mid()) if math.isfinite(value) else math.inf


def worst(m, form, x, values):
    with balls.precision(400):
        errors = [units(v, FORMS[form](m, arb(p))) for v, p in zip(values.tolist(), x.tolist(), strict=True)]
    place = int(np.argmax(errors))
    print(f"m = {m}, {form}: worst {errors[place]:.2f} ulp at x = {x[place]!r}")
    return errors[place]


def neighbours(x, count=4):
    """The doubles around x."""
    up, down = [x], [x]
    for _ in range(count):
        up.append(math.nextafter(up[-1], math.inf))
        down.append(math.nextafter(down[-1], 0.0))
    return up + down


def hard_points(m):
    """Doubles of every size, and those next to every place where a formula could fail."""
    rng = np.random.default_rng(m)
    known = hyperbolic_constants(m)
    places = [float(e.mid) for e in (known.gamma_at, known.rho_at, known.L_at) if e is not None] + [BORDER]
    threshold, underflow = 710 / (2 * m), 1e-308 ** (1 / (2 * m))
    parts = [
        [0.0, 5e-324, 2.3e-308, 1e-300, 1e-154, 372.0, 373.0, 400.0, 745.0, 1e300, 1.7e308],
        np.ldexp(rng.uniform(1, 2, 30), rng.integers(-1074, 1023, 30)),
        np.ldexp(rng.uniform(1, 2, 30), rng.integers(-12, 10, 30)),
        rng.uniform(0, 3, 40),
        threshold * (1 + np.linspace(-1e-3, 1e-3, 7)),
        underflow * rng.uniform(0.9, 1.1, 20),
        rng.uniform(300, 400, 8),
        *(neighbours(place) for place in places),
        *(place + rng.normal(size=16) * 10.0 ** -rng.integers(1, 16, 16) / m for place in places),
    ]
    return np.abs(np.concatenate([np.asarray(part, dtype=float) for part in parts]))


@pytest.mark.parametrize("form", FORMS)
@pytest.mark.parametrize("m", MEMBERS)
def test_arrays_are_within_four_ulp(m, form):
    x = hard_points(m)
    assert worst(m, form, x, getattr(family.hyperbolic(m), form)(x)) <= LIMIT


@pytest.mark.parametrize("m", MEMBERS)
def test_single_numbers_are_within_four_ulp(m):
    x = hard_points(m)
    for form in FORMS:
        function = getattr(family.hyperbolic(m), form)
        assert worst(m, form, x, np.array([float(function(p)) for p in x])) <= LIMIT


@pytest.mark.parametrize("m", MEMBERS)
def test_casadi_is_within_four_ulp(m):
    x = hard_points(m)
    symbol = ca.SX.sym("x")
    forms = family.hyperbolic(m).casadi(symbol)
    function = ca.Function("forms", [symbol], [getattr(forms, form) for form in FORMS])
    for form, values in zip(FORMS, function(x.reshape(1, -1)), strict=True):
        assert worst(m, form, x, values.full().ravel()) <= LIMIT


@given(
    m=st.integers(1, 1000),
    x=st.floats(0, 1e308) | st.floats(0, 3) | st.floats(0.5, 1.2),
    form=st.sampled_from(sorted(FORMS)),
)
def test_any_member_and_any_double(m, x, form):
    value = getattr(family.hyperbolic(m), form)(np.array([x]))
    assert worst(m, form, np.array([x]), value) <= LIMIT


def test_the_printed_formula_would_not_do():
    """The negative control: the formula as printed overflows, and in doubles it loses digits for large m."""
    m, x = 317, np.array([0.7])
    s = np.sinh(x)
    assert worst(m, "h", x, s ** (2 * m - 1) * np.cosh(x) / (1 + s ** (2 * m))) > 20
    with np.errstate(all="ignore"):
        s = np.sinh(np.array([3.0]))
        assert np.isnan(s ** (2 * m - 1) * np.cosh(3.0) / (1 + s ** (2 * m))).all()


def test_simplified_graphs_lose_the_error_terms():
    """Another: built without ``exact_graph`` the same code is no better than plain doubles near x_γ."""
    from lyapcheck.family.arithmetic import graphs
    from lyapcheck.family.hyperbolic_numeric import Near

    m, symbol = 1000, ca.SX.sym("x")
    x = np.linspace(0.7, 0.88, 50)
    careless = ca.Function("h", [symbol], [Near(graphs(), m, symbol).h()[0]])(x.reshape(1, -1)).full().ravel()
    assert worst(m, "h", x, careless) > LIMIT
