"""The hyperbolic family in doubles against mpmath at 60 digits, in units in the last place."""

import math

import casadi as ca
import mpmath
import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from lyapcheck import family
from lyapcheck.check.numbers.balls import hyperbolic_constants
from tests.helpers.shares import one_in

MEMBERS = (1, 2, 3, 5, 10, 50, 100, 317, 513, 1000)
FORMS = ("h", "dh", "potential", "secant")
BORDER = 0.8813735870195430
DIGITS = 60


def limit(m):
    """What is said: 4m + 8 units in the last place."""
    return 4 * m + 8


def exact(m, x):
    """Each form with the size that its error is relative to: its own, and of h' that of its terms."""
    if x == 0:
        first = mpmath.mpf(m == 1)
        return {"h": (0, 0), "dh": (first, first), "potential": (0, 0), "secant": (first, first)}
    s, c = mpmath.sinh(x), mpmath.cosh(x)
    P, r2 = s ** (2 * m), s**-2
    h = c / s / (1 + 1 / P)
    U = mpmath.log1p(P) / (2 * m)
    weight = P / (1 + P) ** 2 * r2
    dh = weight * (2 * m - 1 + 2 * m * s**2 - P)
    size = weight * (2 * m - 1 + 2 * m * s**2 + P)
    return {"h": (h, h), "dh": (dh, size), "potential": (U, U), "secant": (h / x, h / x)}


def worst(m, form, x, values):
    """The largest error in units in the last place of what it is relative to."""
    errors = []
    with mpmath.workdps(DIGITS):
        for value, p in zip(values.tolist(), x.tolist(), strict=True):
            number, size = exact(m, mpmath.mpf(p))[form]
            size = float(size)
            unit = 2.0**-1074 if size < 2.0**-1022 else math.ldexp(1.0, math.frexp(size)[1] - 53)
            off = float(abs(mpmath.mpf(value) - number) / mpmath.mpf(unit))
            errors.append(off if math.isfinite(value) else math.inf)
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
@pytest.mark.parametrize("m", one_in(3, MEMBERS))
def test_arrays_are_as_exact_as_is_said(m, form):
    x = hard_points(m)
    assert worst(m, form, x, getattr(family.hyperbolic(m), form)(x)) <= limit(m)


@pytest.mark.parametrize("m", one_in(3, MEMBERS))
def test_casadi_is_as_exact_as_is_said(m):
    x = hard_points(m)
    symbol = ca.SX.sym("x")
    forms = family.hyperbolic(m).casadi(symbol)
    function = ca.Function("forms", [symbol], [getattr(forms, form) for form in FORMS])
    for form, values in zip(FORMS, function(x.reshape(1, -1)), strict=True):
        assert worst(m, form, x, values.full().ravel()) <= limit(m)


@given(
    m=st.integers(1, 1000),
    x=st.floats(0, 1e308) | st.floats(0, 3) | st.floats(0.5, 1.2),
    form=st.sampled_from(FORMS),
)
def test_any_member_and_any_double(m, x, form):
    value = getattr(family.hyperbolic(m), form)(np.array([x]))
    assert worst(m, form, np.array([x]), value) <= limit(m)


@pytest.mark.parametrize("m", [1001, pytest.param(10_000, marks=pytest.mark.slow)])
@pytest.mark.parametrize("form", FORMS)
def test_the_largest_members_overflow_nowhere(m, form):
    x = np.concatenate([np.geomspace(5e-324, 1.7e308, 2000), np.linspace(0, 3, 2000), neighbours(BORDER)])
    assert np.isfinite(getattr(family.hyperbolic(m), form)(np.concatenate([x, -x]))).all()
