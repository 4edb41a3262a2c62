"""(10), (10p) and (19) against an independent computation, and exactly on their borders."""

from fractions import Fraction

import mpmath
import pytest
from hypothesis import given
from hypothesis import strategies as st
from mpmath import mpf

from lyapcheck.check.expressions.expression import ball
from lyapcheck.check.numbers.balls import hyperbolic_constants, precision, to_arb
from lyapcheck.check.verify import verify
from lyapcheck.control.conditions import Conditions
from lyapcheck.control.gains import PRINTED_GAMMA, GainSet
from lyapcheck.control.limits import Limits
from lyapcheck.control.threshold import root
from lyapcheck.errors import InputError
from lyapcheck.family.base import LARGEST_M, named
from lyapcheck.files.decimals import written

MS = st.one_of(st.integers(1, 6), st.sampled_from([10, 37, 100]))


def gains_of(kp, kv, m=2, family="hyperbolic"):
    def read(texts):
        values = [written(text) if "." in text or "e" in text else Fraction(text) for text in texts]
        assert all(isinstance(value, Fraction) for value in values)
        return tuple(values)  # type: ignore[arg-type]

    return GainSet("set", m, read(kp), read(kv), family)


def limits_of(torque, gravity, friction):
    joints = tuple(f"j{i + 1}" for i in range(len(torque)))
    friction_min = None if friction is None else Fraction(friction)
    return Limits(tuple(map(Fraction, torque)), tuple(map(Fraction, gravity)), friction_min, joints)


def checked(gains, limits, gamma=None):
    bound = named(gains.family, gains.m).gamma if gamma is None else gamma
    return {(check.id, check.joint): check for check in Conditions(limits, bound).all(gains, ("10i",))}


# --- an independent computation ------------------------------------------------------------------


def gamma_by_search(m):
    """sup h_m by bisection of h_m' in x, from the definition of h_m alone."""
    if m == 1:
        return mpf(1)

    def h(x):
        s = mpmath.sinh(x)
        return s ** (2 * m - 1) * mpmath.cosh(x) / (1 + s ** (2 * m))

    low, high = mpmath.asinh(1), mpf(4)  # h rises up to sinh x = 1 and falls where sinh x is large
    for _ in range(230):
        middle = (low + high) / 2
        low, high = (middle, high) if mpmath.diff(h, middle) > 0 else (low, middle)
    return h(low)


@pytest.fixture(scope="module")
def gammas():
    with mpmath.workdps(70):
        return {m: gamma_by_search(m) for m in (1, 2, 3, 4, 5, 6, 10, 37, 100)}


DECIMALS = st.builds(
    lambda digits, places: written(f"{digits // 10**places}.{digits % 10**places:0{places}d}"),
    st.integers(1, 200_000),
    st.integers(1, 6),
)


@st.composite
def cases(draw):
    n = draw(st.integers(1, 7))
    several = st.lists(DECIMALS, min_size=n, max_size=n).map(tuple)
    gains = GainSet("set", draw(MS), draw(several), draw(several))
    return gains, Limits(draw(several), draw(several), draw(DECIMALS), tuple(f"j{i}" for i in range(n)))


def real(x):
    return mpf(x.numerator) / x.denominator


@given(cases())
def test_the_conditions_agree_with_an_independent_computation(gammas, case):
    gains, limits = case
    assert gains.m is not None
    assert limits.viscous_min is not None
    result = checked(gains, limits)
    with mpmath.workdps(60):
        scale = mpmath.sqrt(limits.n) * gammas[gains.m]
        expected = {
            ("10", None): (
                max(gains.kp) + max(gains.kv),
                (
                    mpmath.norm([real(t) for t in limits.torque if t])
                    - mpmath.norm([real(g) for g in limits.gravity])
                )
                / scale,
            )
        }
        for i, (kp, kv) in enumerate(zip(gains.kp, gains.kv, strict=True)):
            torque = limits.torque[i]
            assert torque is not None
            expected["10p", i] = kp + kv, (real(torque) - real(limits.gravity[i])) / scale
            expected["10i", i] = kp + kv, (real(torque) - real(limits.gravity[i])) / gammas[gains.m]
            expected["19", i] = kv, real(limits.viscous_min) / scale
        assert result.keys() == expected.keys()
        for key, (value, limit) in expected.items():
            check = result[key]
            assert check.value == value
            on_border = abs(real(value) - limit) < mpf(10) ** -40  # simple decimals do meet there
            passes = check.id == "10" if on_border else real(value) < limit
            assert check.verdict == ("accepted" if passes else "rejected")
            assert check.limit is not None
            assert (
                real(check.limit.lower) - mpf(10) ** -50 <= limit <= real(check.limit.upper) + mpf(10) ** -50
            )
            assert check.limit.width <= Fraction(1, 10**20)
            assert check.margin is not None
            assert on_border or (check.margin > 0) == passes
            assert not on_border or check.margin == 0


# --- what cannot be decided ------------------------------------------------------------------------


def test_an_unbounded_function_meets_no_bound():
    gains = gains_of(["0.8"], ["0.4"], None, "linear")
    for check in checked(gains, limits_of(["50"], ["0"], "1")).values():
        assert (check.verdict, check.limit, check.margin, check.largest_admissible) == (
            "rejected",
            None,
            None,
            None,
        )
        assert "unbounded" in check.reason


def test_without_a_limit_nothing_is_decided():
    gains = gains_of(["1", "1"], ["1", "1"])
    limits = Limits((Fraction(50), None), (Fraction(0), Fraction(0)), None, ("a", "b"))
    result = checked(gains, limits)
    assert {key for key, check in result.items() if check.verdict == "undecided"} == {
        ("10", None),
        ("10p", 1),
        ("10i", 1),
        ("19", 0),
        ("19", 1),
    }
    assert all("[bounds]" in check.reason for check in result.values() if check.verdict == "undecided")
    assert result["10p", 0].verdict == "accepted"


def test_the_printed_bounds_are_those_of_the_paper():
    """γ_1 = 1, γ_2 = 1.05, γ_3 = 1.11 (Table 2); the last two are below the true ones."""
    assert [PRINTED_GAMMA[m] for m in (1, 2, 3)] == [1, Fraction("1.05"), Fraction("1.11")]
    for m, printed in PRINTED_GAMMA.items():
        assert hyperbolic_constants(m).gamma.lower >= printed


def test_the_largest_member_is_decided_and_the_next_is_none():
    limits = limits_of(["50", "150", "15"], ["0", "40.28", "1.81"], "0.406")
    found = checked(gains_of(["1.5"] * 3, ["0.1"] * 3, LARGEST_M), limits).values()
    assert {check.verdict for check in found} <= {"accepted", "rejected"}
    with pytest.raises(InputError, match="from 1 to 10000"):
        checked(gains_of(["1.5"] * 3, ["0.1"] * 3, LARGEST_M + 1), limits)


@given(cases(), st.sampled_from(["hyperbolic", "arctan", "tanh", "algebraic", "linear"]))
def test_every_verdict_is_that_of_a_statement_and_its_proof(case, family):
    base, limits = case
    gains = GainSet("set", base.m if family == "hyperbolic" else None, base.kp, base.kv, family)
    for check in checked(gains, limits).values():
        result = check.judgement
        assert result is not None
        assert result.proof is not None
        again = verify(result.statement, result.proof)
        assert (again.verdict, again.grade) == (result.shown, result.grade)
        assert check.verdict == {"proved": "accepted", "refuted": "rejected"}[again.verdict]


def test_squares_are_taken_out_of_roots():
    for text in ("8", "1/2", "9/4", "0", "162577/100", str(2 * 2003**2)):
        with precision(200):
            assert abs(ball(root(Fraction(text))) ** 2 - to_arb(Fraction(text))) < 1e-40
    assert root(Fraction(8)) == ("mul", ("num", "2"), ("sqrt", ("num", "2")))
    assert root(Fraction(9, 4)) == ("num", "3/2")
    assert root(Fraction(2 * 2003**2))[2] != ("sqrt", ("num", str(2 * 2003**2)))
