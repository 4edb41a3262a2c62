"""V and dV/dt in balls at exact states: against differences along the motion, and against planted faults."""

from fractions import Fraction

import pytest
from flint import arb, ctx
from hypothesis import given
from hypothesis import strategies as st

from lyapcheck.check.loop.states import (
    Arm,
    Controller,
    State,
    confirms_positive,
    polynomial,
    rate,
    slope,
    value,
)
from lyapcheck.check.numbers.balls import precision, to_arb
from lyapcheck.check.numbers.members import Functions, member

F = Fraction
LINEAR = Functions(lambda x: x, lambda x: arb(1), lambda x: x * x / 2)

# M = [[2.351 + 0.168 c2, 0.102 + 0.084 c2], [·, 0.102]], the two-joint arm as its source prints it
ONE, C2 = (0, 0, 0, 0), (0, 0, 0, 1)
M12 = ((ONE, F("0.102")), (C2, F("0.084")))
ARM = Arm(
    ((((ONE, F("2.351")), (C2, F("0.168"))), M12), (M12, ((ONE, F("0.102")),))), (F("2.288"), F("0.175"))
)
GAINS = ((F(60), F(5)), (F("0.233"), F("0.233")))

fractions = st.fractions(-3, 3, max_denominator=50)
pairs = st.tuples(fractions, fractions)
states = st.builds(State, pairs, pairs, pairs)


def controller(m):
    return Controller(member("hyperbolic", m), *GAINS)


def printed_acceleration(m, state):
    """ẇ of (11) with C as the source prints it, and M inverted by hand."""
    q2, (e, w) = to_arb(state.q[1]), ([to_arb(x) for x in part] for part in (state.e, state.w))
    f, (kp, kv) = member("hyperbolic", m), ([to_arb(k) for k in gains] for gains in GAINS)
    s = to_arb(F("0.084")) * q2.sin()
    coriolis = [-2 * s * w[1] * w[0] - s * w[1] * w[1], s * w[0] * w[0]]
    force = [
        kp[i] * f.h(e[i]) - kv[i] * f.h(w[i]) - to_arb(ARM.viscous[i]) * w[i] - coriolis[i] for i in (0, 1)
    ]
    a, b, d = (to_arb(F(x)) for x in ("2.351", "0.102", "0.102"))
    a, b = a + to_arb(F("0.168")) * q2.cos(), b + to_arb(F("0.084")) * q2.cos()
    return [(d * force[0] - b * force[1]) / (a * d - b * b), (a * force[1] - b * force[0]) / (a * d - b * b)]


def exactly(x):
    mantissa, exponent = x.mid().man_exp()
    return F(int(mantissa)) * F(2) ** int(exponent)


@given(st.sampled_from([1, 2, 3]), states, st.fractions(F(1, 20), 2, max_denominator=20))
def test_rate_is_the_slope_of_v_along_the_motion(m, state, eps0):
    step = F(1, 10**20)
    with precision(512):
        acceleration = [exactly(a) for a in printed_acceleration(m, state)]

    def moved(dt):
        return State(
            tuple(q + dt * w for q, w in zip(state.q, state.w, strict=True)),
            tuple(e - dt * w for e, w in zip(state.e, state.w, strict=True)),
            tuple(w + dt * a for w, a in zip(state.w, acceleration, strict=True)),
        )

    args = ARM, controller(m), eps0
    with precision(512):
        difference = (value(*args, moved(step), 512) - value(*args, moved(-step), 512)) / to_arb(2 * step)
        result = rate(*args, state, 512)
        assert abs(difference - result) < arb("1e-12")


@given(st.sampled_from([1, 2, 5]), states)
def test_more_precision_refines_the_same_number(m, state):
    wide, narrow = (rate(ARM, controller(m), F(1, 2), state, bits) for bits in (64, 300))
    assert wide.overlaps(narrow)
    assert narrow.rad() < arb("1e-40")


@given(states, st.fractions(0, 2, max_denominator=20))
def test_mirrored_state_has_the_same_rate(state, eps0):
    """M is even in q, so the mirror image of a motion is a motion; turning e and w alone is not."""
    turned = State(*(tuple(-x for x in part) for part in (state.q, state.e, state.w)))
    assert rate(ARM, controller(2), eps0, state).overlaps(rate(ARM, controller(2), eps0, turned))


def test_value_and_rate_vanish_at_the_origin():
    origin = State((F(1), F(2)), (F(0), F(0)), (F(0), F(0)))
    assert origin.at_origin
    assert value(ARM, controller(1), F(1, 2), origin).contains(0)
    assert rate(ARM, controller(1), F(1, 2), origin).contains(0)
    assert not confirms_positive(ARM, controller(1), F(1, 2), origin)


def test_rate_at_rest_is_the_pull_of_the_gains():
    """w = 0: dV/dt = −ε hᵀK_p h, by hand with tanh and e = (1, 0)."""
    with precision(128):
        h = arb(1).tanh()
        expected = -to_arb(F(1, 4)) * 60 * h * h
        result = rate(ARM, controller(1), F(1, 2), State((F(0), F(0)), (F(1), F(0)), (F(0), F(0))))
        assert result.overlaps(expected)
        assert result < 0


def test_fast_state_at_zero_error_by_hand():
    """e = 0, m = 1: dV/dt = −wᵀBw − wᵀK_v tanh(w) + ε₀ wᵀMw."""
    state = State((F(0), F(0)), (F(0), F(0)), (F(10), F(20)))
    with precision(128):
        kinetic = to_arb(F("2.519") * 100 + 2 * F("0.186") * 200 + F("0.102") * 400)
        damping = to_arb(F("2.288") * 100 + F("0.175") * 400)
        damping += to_arb(F("0.233")) * (10 * arb(10).tanh() + 20 * arb(20).tanh())
        assert rate(ARM, controller(1), F(1), state).overlaps(kinetic - damping)


@pytest.mark.parametrize(
    ("eps0", "confirmed"), [("0.9", True), ("0.82", True), ("0.80", False), ("0", False), ("-1", False)]
)
def test_fast_state_confirms_only_above_the_threshold(eps0, confirmed):
    state = State((F(0), F(0)), (F(0), F(0)), (F("522229.112"), F("852805.227")))
    assert confirms_positive(ARM, controller(1), F(eps0), state) is confirmed


def test_a_nan_never_confirms():
    broken = Functions(lambda x: arb("nan"), lambda x: arb("nan"), lambda x: arb("nan"))
    state = State((F(0), F(0)), (F(1), F(0)), (F(1), F(1)))
    assert not confirms_positive(ARM, Controller(broken, *GAINS), F(100), state)


def test_gains_per_degree_count_as_180_over_pi_per_radian():
    state = State((F(0), F(0)), (F(1), F(0)), (F(0), F(0)))
    degrees = rate(ARM, Controller(LINEAR, *GAINS, per_degree=True), F(1), state)
    radians = rate(ARM, Controller(LINEAR, *GAINS), F(1), state)
    with precision(128):
        assert degrees.overlaps(radians * 180 / arb.pi())


def test_precision_is_put_back():
    before = ctx.prec
    rate(ARM, controller(1), F(1), State((F(0), F(0)), (F(1), F(0)), (F(0), F(1))), 300)
    assert ctx.prec == before


def test_slope_of_a_term_by_hand():
    """d/dq₁ of 3 s1² c1 c2 = 3 (2 s1 c1² − s1³) c2."""
    q = [arb("0.3"), arb("1.1")]
    s, c = [x.sin() for x in q], [x.cos() for x in q]
    terms = (((2, 0, 1, 1), F(3)),)
    assert polynomial(terms, s, c).overlaps(3 * s[0] * s[0] * c[0] * c[1])
    expected = 3 * (2 * s[0] * c[0] * c[0] - s[0] * s[0] * s[0]) * c[1]
    assert slope(terms, 0, s, c).overlaps(expected)
    assert slope(terms, 1, s, c).overlaps(-3 * s[0] * s[0] * c[0] * s[1])
