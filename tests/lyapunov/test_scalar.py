"""The scalar certificates bound dV/dt on real arms; their ε₀ is proved in rationals and nearly largest."""

from __future__ import annotations

from dataclasses import dataclass, replace
from fractions import Fraction

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from lyapcheck import family, robots
from lyapcheck.check.loop import ScalarForm, certifies
from lyapcheck.lyapunov.numeric import LyapunovNumeric
from lyapcheck.lyapunov.scalar import RobotBounds, published_limit, scalar_form, sharp_form
from lyapcheck.robots.numeric import NumericModel
from lyapcheck.search.scalar_program import scalar_epsilon
from tests.helpers.shares import one_in

positive = st.fractions(min_value=Fraction(1, 50), max_value=100, max_denominator=50)
forms = st.builds(ScalarForm, positive, positive, positive, positive)


def theta(form, eps):
    """θ'11, θ'12 and θ'22 at one ε."""
    off = -eps * (form.cross + eps * form.drift) / 2
    return eps * form.stiffness, off, form.friction - eps * form.drift


@dataclass(frozen=True)
class Diagonal:
    kp: tuple[Fraction, ...]
    kv: tuple[Fraction, ...]
    angle_unit: str = "rad"


def gains_for(n):
    kp, kv = ("25", "50", "5"), ("0.25", "0.5", "0.125")
    return Diagonal(tuple(map(Fraction, kp[:n])), tuple(map(Fraction, kv[:n])))


def sampled_bounds(arm):
    """β_M and k_c from many angles with 1 % on top: enough to test the inequality on sampled states."""
    model = robots.load(arm)
    numeric, random = NumericModel(model), np.random.default_rng(5)
    q, x = random.uniform(-np.pi, np.pi, (20_000, model.n)), random.normal(size=(20_000, model.n))
    x /= np.linalg.norm(x, axis=1, keepdims=True)
    beta = np.linalg.norm(numeric.mass(q), 2, axis=(1, 2)).max()
    turning = np.linalg.norm(numeric.coriolis(q, x), 2, axis=(1, 2)).max()
    viscous = [number.value for number in model.viscous]
    upper = [Fraction(float(value) * 1.01) for value in (beta, turning)]
    return RobotBounds(upper[0], upper[1], min(viscous), max(viscous))


CASES = [(arm, h) for arm in ("pendulum1", "reyes-kelly2", "buap3") for h in (1, 2, 7)]


@pytest.mark.parametrize(("arm", "m"), one_in(4, CASES))
@pytest.mark.parametrize("eps0", one_in(3, [0.3, 0.01, 3.0]))
def test_theta_bounds_the_rate_at_random_states(arm, m, eps0):
    bounds, gains, h = sampled_bounds(arm), gains_for(robots.load(arm).n), family.hyperbolic(m)
    form = scalar_form(gains, h.constants(), bounds)
    assert form is not None
    rate, eps, a, b = _sampled(arm, h, gains, eps0)
    t11, t12, t22 = (np.array([float(x) for x in column]) for column in _thetas(form, eps))
    assert np.all(rate <= -(t11 * a * a + 2 * t12 * a * b + t22 * b * b) + 1e-9 * (1 + b * b))


@pytest.mark.parametrize("arm", ["pendulum1", "reyes-kelly2", "buap3"])
@pytest.mark.parametrize(
    "h", [family.hyperbolic(1), family.hyperbolic(3), family.named("linear")], ids=lambda h: h.name
)
def test_sharp_form_keeps_the_rate_negative_up_to_its_eps0(arm, h):
    gains, bounds = gains_for(robots.load(arm).n), sampled_bounds(arm)
    sharp = scalar_epsilon(sharp_form(gains, h.constants(), bounds))
    assert sharp.eps0 is not None
    rate = _sampled(arm, h, gains, float(sharp.eps0))[0]
    assert np.all(rate <= 0)
    plain = scalar_epsilon(scalar_form(gains, h.constants(), bounds)).eps0
    assert plain is None or plain <= sharp.eps0


@given(forms, positive)
def test_the_check_is_sylvesters_criterion_at_eps0(form, eps0):
    t11, t12, t22 = theta(form, eps0)
    assert certifies(form, eps0) == (t11 > 0 and t11 * t22 > t12**2)


@pytest.mark.parametrize(
    "change",
    [{"stiffness": 0}, {"friction": 0}, {"drift": -1}, {"cross": -1}, {"stiffness": -1, "friction": -1}],
)
def test_coefficients_outside_the_argument_certify_nothing(change):
    form = ScalarForm(*map(Fraction, (1, 1, 1, 1)))
    tiny = Fraction(1, 10**6)
    assert certifies(form, tiny)
    assert not certifies(replace(form, **{k: Fraction(v) for k, v in change.items()}), tiny)
    assert not certifies(form, Fraction(0))
    assert not certifies(form, -tiny)


@pytest.mark.parametrize("scale", [Fraction(1, 10**4), Fraction(1), Fraction(10**4)])
def test_the_program_finds_nearly_the_largest_eps0(scale):
    form = ScalarForm(Fraction(5) * scale, Fraction(2, 5), Fraction(7), Fraction(5, 2))
    result = scalar_epsilon(form)
    assert result.eps0 is not None
    assert certifies(form, result.eps0)
    assert not certifies(form, result.eps0 * Fraction(1_000_001, 1_000_000))


def test_published_interval_is_empty_exactly_without_19():
    bounds = RobotBounds(Fraction(3), Fraction(1, 3), Fraction(2, 5), Fraction(2))
    constants = family.hyperbolic(1).constants()
    low, high = (Diagonal((Fraction(9),), (Fraction(k),)) for k in ("0.399", "0.4"))
    assert published_limit(low, constants, bounds) is not None
    assert published_limit(high, constants, bounds) is None


def test_gains_per_degree_are_rounded_to_the_safe_side():
    bounds, constants = sampled_bounds("reyes-kelly2"), family.named("linear").constants()
    degrees = Diagonal((Fraction(1),) * 2, (Fraction(1),) * 2, "deg")
    form = sharp_form(degrees, constants, bounds)
    assert float(form.stiffness) == pytest.approx(np.degrees(1.0), rel=1e-12)
    assert form.cross > bounds.viscous_max + form.stiffness


def _thetas(form, eps):
    return list(zip(*(theta(form, Fraction(float(x))) for x in eps), strict=True))


def _sampled(arm, h, gains, eps0):
    """dV/dt, ε, ‖h(e)‖ and ‖w‖ at random states of many sizes."""
    model = robots.load(arm)
    random, shape = np.random.default_rng(11), (400, model.n)
    q = random.uniform(-np.pi, np.pi, shape)
    e, w = (random.normal(size=shape) * 10 ** random.uniform(-3, 2, (shape[0], 1)) for _ in range(2))
    numeric = LyapunovNumeric(model, h, [float(k) for k in gains.kp], [float(k) for k in gains.kv], eps0)
    eps = eps0 / (1 + np.linalg.norm(e, axis=1))
    return numeric.rate(q, e, w), eps, np.linalg.norm(h.h(e), axis=1), np.linalg.norm(w, axis=1)
