"""What holds for every registered family, in all four arithmetics."""

import casadi as ca
import numpy as np
import pytest
import sympy as sp
from flint import arb, ctx
from hypothesis import given
from hypothesis import strategies as st
from hypothesis.extra.numpy import arrays

from lyapcheck import family
from lyapcheck.errors import InputError
from tests.helpers.shares import one_in

MEMBERS = (1, 2, 3, 10, 317)
FAMILIES = [family.hyperbolic(m) for m in MEMBERS] + [
    family.named(name) for name in family.names() if name != "hyperbolic"
]
FORMS = ("h", "dh", "potential", "secant")
GRID = np.concatenate([np.linspace(-6, 6, 241), np.geomspace(1e-12, 300, 60), -np.geomspace(1e-12, 300, 60)])

every_family = pytest.mark.parametrize("f", FAMILIES, ids=lambda f: f"{f.name}{f.m or ''}")


def in_casadi(f, x):
    symbol = ca.SX.sym("x")
    values = f.casadi(symbol)
    function = ca.Function("forms", [symbol], [getattr(values, form) for form in FORMS])
    return {form: out.full().ravel() for form, out in zip(FORMS, function(x.reshape(1, -1)), strict=True)}


def accuracy(f):
    """4m + 8 units in the last place, relative."""
    return (4 * (f.m or 1) + 8) * np.finfo(float).eps


@every_family
def test_certified_constants_bound_the_values_and_are_reached(f):
    known = f.constants()
    x = np.linspace(0, 8, 20001)
    reached = {"gamma": np.max(f.h(x)), "rho": np.max(np.abs(f.dh(x))), "L": np.max(f.secant(x))}
    for name, value in reached.items():
        bound = getattr(known, name)
        if bound is None:
            assert not f.bounded
            continue
        at = getattr(known, f"{name}_at")
        assert value <= bound.float_upper
        if at is not None:
            form = {"gamma": "h", "rho": "dh", "L": "secant"}[name]
            assert abs(getattr(f, form)(float(at.mid))) == pytest.approx(float(bound.mid), rel=1e-14)


@every_family
def test_a_bound_that_is_not_reached_is_approached(f):
    known = f.constants()
    if known.gamma is not None and known.gamma_at is None:
        assert f.h(1e300) == pytest.approx(known.gamma.float_upper, rel=1e-15)


def ball(f, form):
    """A map of balls; that of h(x)/x is made of those of h and h', for points."""
    if form == "secant":
        return lambda x: f.ball_h(x) / x if x != 0 else f.ball_dh(x)
    return getattr(f, f"ball_{form}")


@every_family
@pytest.mark.parametrize("form", FORMS)
def test_doubles_are_within_a_few_units_in_the_last_place_of_the_balls(f, form):
    for x in GRID[::7].tolist():
        value = float(getattr(f, form)(x))
        with ctx.workprec(300):
            error = abs(ball(f, form)(arb(x)) - value)
        size = max(abs(value), 1.0) if form == "dh" else abs(value)  # near its zero h' loses digits
        assert error <= (4 * (f.m or 1) + 4) * np.spacing(size)


@every_family
@pytest.mark.parametrize("form", one_in(4, ("h", "dh", "potential")))
@given(middle=st.floats(-3, 3), radius=st.floats(0, 3), inside=st.floats(-1, 1))
def test_wide_balls_contain_the_values_inside(f, form, middle, radius, inside):
    wide = getattr(f, f"ball_{form}")(arb(middle, radius))
    with ctx.workprec(1300):
        point = arb(middle) + arb(radius) * inside
        assert wide.overlaps(getattr(f, f"ball_{form}")(point))


@every_family
def test_casadi_gives_the_same_numbers(f):
    x = np.concatenate([GRID, [0.0, 1e-310, 1e5, -1e150]])
    for form, values in in_casadi(f, x).items():
        assert np.allclose(values, getattr(f, form)(x), rtol=2 * accuracy(f), atol=1e-320), form


@every_family
def test_sympy_forms_are_derivatives_of_each_other_and_evaluate_alike(f):
    x = sp.Symbol("x", positive=True)
    forms = f.sympy(x)
    assert (
        sp.Float(sp.diff(forms.potential, x).subs(x, 0.7).evalf(30) - forms.h.subs(x, 0.7).evalf(30)) < 1e-20
    )
    for form in FORMS[:3]:
        value = sp.sympify(getattr(forms, form)).subs(x, sp.Rational(7, 10)).evalf(40)
        assert float(getattr(f, form)(0.7)) == pytest.approx(float(value), rel=1e-14)


@every_family
@given(x=arrays(float, st.integers(1, 40), elements=st.floats(allow_nan=False, allow_infinity=False)))
def test_bounded_for_every_double(f, x):
    known = f.constants()
    assert not np.any(np.isnan(f.h(x)))
    assert np.all(np.abs(f.dh(x)) <= known.rho.float_upper * (1 + 1e-15))
    assert np.all((f.secant(x) >= 0) & (f.secant(x) <= known.L.float_upper * (1 + 1e-15)))
    if known.gamma is not None:
        assert np.all(np.abs(f.h(x)) <= known.gamma.float_upper * (1 + 1e-15))


def test_families_are_named_and_comparable():
    assert family.names() == tuple(sorted(family.names()))
    assert family.named("hyperbolic", 3) == family.hyperbolic(3)
    assert family.hyperbolic(2) != family.hyperbolic(3)
    assert [f.name for f in FAMILIES if not f.bounded] == ["linear"]


@pytest.mark.parametrize(
    ("name", "m", "subject"),
    [
        ("hyperbolic", None, "m"),
        ("hyperbolic", 0, "m"),
        ("hyperbolic", -2, "m"),
        ("hyperbolic", 2.0, "m"),
        ("hyperbolic", True, "m"),
        ("hyperbolic", "3", "m"),
        ("hyperbolic", 10**9, "m"),
        ("tanh", 1, "m"),
        ("linear", 3, "m"),
        ("sigmoid", None, "family"),
        ("registry", None, "family"),
    ],
)
def test_bad_names_and_members_are_input_errors(name, m, subject):
    with pytest.raises(InputError) as caught:
        family.named(name, m)
    assert [problem.key for problem in caught.value.problems] == [subject]
