"""V and dV/dt in balls at exact states: against those of the oracle, and in limit cases."""

from fractions import Fraction

import pytest
from flint import arb, ctx
from hypothesis import given
from hypothesis import strategies as st
from mpmath import mp

from lyapcheck.check.loop.states import Arm, Controller, State, confirms_positive, rate, value
from lyapcheck.check.numbers.balls import precision
from lyapcheck.check.numbers.members import Functions, member
from tests.oracle.loop import DIGITS, Loop, many, many_digits

F = Fraction

# M = [[2.351 + 0.168 c2, 0.102 + 0.084 c2], [·, 0.102]], the two-joint arm as its source prints it
ONE, C2 = (0, 0, 0, 0), (0, 0, 0, 1)
M12 = ((ONE, F("0.102")), (C2, F("0.084")))
ARM = Arm(
    ((((ONE, F("2.351")), (C2, F("0.168"))), M12), (M12, ((ONE, F("0.102")),))), (F("2.288"), F("0.175"))
)
BENT = Arm((((*ARM.mass[0][0], ((2, 0, 1, 1), F(3, 10))), M12), ARM.mass[1]), ARM.viscous)
"""With 0.3 s1² c1 c2 in M11, as no such arm has."""
GAINS = ((F(60), F(5)), (F("0.233"), F("0.233")))
FAST = State((F(0), F(0)), (F(0), F(0)), (F("522229.112"), F("852805.227")))

fractions = st.fractions(-3, 3, max_denominator=50)
pairs = st.tuples(fractions, fractions)
states = st.builds(State, pairs, pairs, pairs)


def controller(m):
    return Controller(member("hyperbolic", m), *GAINS)


@given(st.sampled_from([1, 2, 3, 5]), states, st.fractions(F(1, 20), 2, max_denominator=20))
def test_V_and_its_rate_are_those_of_the_oracle(m, state, eps0):
    loop = Loop(BENT.mass, BENT.viscous, (), "hyperbolic", m, *GAINS, eps0)
    with mp.workdps(3 * DIGITS):
        e = [x or F(1, 10**60) for x in state.e]  # the oracle divides by ‖e‖
        own = loop.exact_rate(state.q, e, state.w)
        stored = loop.energy(*([many(x) for x in part] for part in (state.q, e, state.w)), many_digits())
        for ball, number in (
            (rate(BENT, controller(m), eps0, state, 300), own),
            (value(BENT, controller(m), eps0, state, 300), stored),
        ):
            assert ball.rad() < arb("1e-40")
            assert abs(mp.mpf(ball.mid().str(80, radius=False)) - number) < mp.mpf(10) ** -40
    assert rate(BENT, controller(m), eps0, state, 64).overlaps(rate(BENT, controller(m), eps0, state, 300))


@pytest.mark.parametrize(
    ("eps0", "confirmed"), [("0.9", True), ("0.82", True), ("0.80", False), ("0", False), ("-1", False)]
)
def test_fast_state_confirms_only_above_the_threshold(eps0, confirmed):
    assert confirms_positive(ARM, controller(1), F(eps0), FAST) is confirmed


def test_a_nan_never_confirms():
    broken = Functions(lambda x: arb("nan"), lambda x: arb("nan"), lambda x: arb("nan"))
    state = State((F(0), F(0)), (F(1), F(0)), (F(1), F(1)))
    assert not confirms_positive(ARM, Controller(broken, *GAINS), F(100), state)


def test_gains_per_degree_count_as_180_over_pi_per_radian():
    linear = Functions(lambda x: x, lambda x: arb(1), lambda x: x * x / 2)
    state = State((F(0), F(0)), (F(1), F(0)), (F(0), F(0)))
    degrees = rate(ARM, Controller(linear, *GAINS, per_degree=True), F(1), state)
    radians = rate(ARM, Controller(linear, *GAINS), F(1), state)
    with precision(128):
        assert degrees.overlaps(radians * 180 / arb.pi())


def test_precision_is_put_back():
    before = ctx.prec
    rate(ARM, controller(1), F(1), FAST, 300)
    assert ctx.prec == before
