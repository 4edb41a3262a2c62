"""(10), (10p) and (19) against an independent computation, and exactly on their borders."""

from __future__ import annotations

from collections.abc import Callable
from fractions import Fraction
from math import isqrt

import mpmath
import pytest
from hypothesis import assume, given
from hypothesis import strategies as st
from mpmath import mpf

from lyapcheck.check.expressions.expression import Tree, ball
from lyapcheck.check.numbers.balls import precision, to_arb
from lyapcheck.check.numbers.constants import hyperbolic_constants
from lyapcheck.check.numbers.enclosure import Enclosure
from lyapcheck.check.verify import verify
from lyapcheck.control.conditions import Check, Conditions, check_10p, check_19, gamma_of
from lyapcheck.control.gains import GainSet
from lyapcheck.control.limits import Limits
from lyapcheck.control.paper import PRINTED_GAMMA
from lyapcheck.control.threshold import norms, root
from lyapcheck.errors import InputError
from lyapcheck.files.decimals import places_of, written
from tests.helpers.costly import costly

MS = st.one_of(st.integers(1, 6), st.sampled_from([10, 37, 100]))


def gains_of(kp: list[str], kv: list[str], m: int | None = 2, family: str = "hyperbolic") -> GainSet:
    def read(texts: list[str]) -> tuple[Fraction, ...]:
        values = [written(text) if "." in text or "e" in text else Fraction(text) for text in texts]
        assert all(isinstance(value, Fraction) for value in values)
        return tuple(values)  # type: ignore[arg-type]

    return GainSet("set", m, read(kp), read(kv), family)


def limits_of(torque: list[str], gravity: list[str], friction: str | None) -> Limits:
    joints = tuple(f"j{i + 1}" for i in range(len(torque)))
    friction_min = None if friction is None else Fraction(friction)
    return Limits(tuple(map(Fraction, torque)), tuple(map(Fraction, gravity)), friction_min, joints)


def checked(gains: GainSet, limits: Limits, gamma: Tree | None = None) -> dict[tuple[str, int | None], Check]:
    bound = gamma_of(gains) if gamma is None else gamma
    return {(check.id, check.joint): check for check in Conditions(limits, bound).all(gains, ("10i",))}


def check_10(gains: GainSet, limits: Limits, gamma: Tree | None) -> list[Check]:
    return Conditions(limits, gamma).check_10(gains)


# --- an independent computation ------------------------------------------------------------------


def gamma_by_search(m: int) -> mpf:
    """sup h_m by bisection of h_m' in x, from the definition of h_m alone."""
    if m == 1:
        return mpf(1)

    def h(x: mpf) -> mpf:
        s = mpmath.sinh(x)
        return s ** (2 * m - 1) * mpmath.cosh(x) / (1 + s ** (2 * m))

    low, high = mpmath.asinh(1), mpf(4)  # h rises up to sinh x = 1 and falls where sinh x is large
    for _ in range(230):
        middle = (low + high) / 2
        low, high = (middle, high) if mpmath.diff(h, middle) > 0 else (low, middle)
    return h(low)


@pytest.fixture(scope="module")
def gammas() -> dict[int, mpf]:
    with mpmath.workdps(70):
        return {m: gamma_by_search(m) for m in (1, 2, 3, 4, 5, 6, 10, 37, 100)}


DECIMALS = st.builds(
    lambda digits, places: written(f"{digits // 10**places}.{digits % 10**places:0{places}d}"),
    st.integers(1, 200_000),
    st.integers(1, 6),
)


@st.composite
def cases(draw: st.DrawFn) -> tuple[GainSet, Limits]:
    n = draw(st.integers(1, 7))
    several = st.lists(DECIMALS, min_size=n, max_size=n).map(tuple)
    gains = GainSet("set", draw(MS), draw(several), draw(several))
    return gains, Limits(draw(several), draw(several), draw(DECIMALS), tuple(f"j{i}" for i in range(n)))


def real(x: Fraction) -> mpf:
    return mpf(x.numerator) / x.denominator


@given(cases())
def test_the_conditions_agree_with_an_independent_computation(
    gammas: dict[int, mpf], case: tuple[GainSet, Limits]
) -> None:
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


def test_table_2_by_hand(gammas: dict[int, mpf]) -> None:
    """(19) for the paper's arm: 0.406/√3 = 0.23440421…, over γ_2 = 1.05356… and γ_3 = 1.11419…"""
    limits = limits_of(["50", "150", "15"], ["0", "40.28", "1.81"], "0.406")
    for m, kv, verdict in ((1, "0.233", "accepted"), (2, "0.223", "rejected"), (3, "0.223", "rejected")):
        check = check_19(gains_of(["1"] * 3, [kv] * 3, m), limits, gamma_of(gains_of(["1"], ["1"], m)))[0]
        assert check.verdict == verdict
        assert check.limit is not None
        assert float(check.limit.lower) == pytest.approx(0.406 / 3**0.5 / float(gammas[m]), rel=1e-15)


# --- the largest value that passes -----------------------------------------------------------------


def with_value(gains: GainSet, check: Check, value: Fraction) -> GainSet | None:
    """The gains changed so that the check's value is another one; ``None`` where they cannot be."""
    i = check.joint
    if check.id == "19" and i is not None:
        return GainSet("set", gains.m, gains.kp, (*gains.kv[:i], value, *gains.kv[i + 1 :]), gains.family)
    kv = Fraction(min(gains.kv)) / 10**9 if i is None else gains.kv[i]
    if value <= kv:
        return None
    if i is None:
        return GainSet("set", gains.m, (value - kv,) * gains.n, (kv,) * gains.n, gains.family)
    return GainSet("set", gains.m, (*gains.kp[:i], value - kv, *gains.kp[i + 1 :]), gains.kv, gains.family)


@costly
@given(cases(), st.sampled_from(["hyperbolic", "arctan", "tanh", "algebraic"]))
def test_the_largest_admissible_is_admitted_and_the_next_decimal_is_not(
    case: tuple[GainSet, Limits], family: str
) -> None:
    base, limits = case
    gains = GainSet("set", base.m if family == "hyperbolic" else None, base.kp, base.kv, family)
    gamma = gamma_of(gains)
    for check in checked(gains, limits, gamma).values():
        assert check.limit is not None
        if check.largest_admissible is None:
            assert check.limit.lower <= 0
            continue
        unit = Fraction(1, 10 ** places_of(check.largest_admissible))
        assert (check.largest_admissible / unit).denominator == 1
        for value, verdict in (
            (check.largest_admissible, "accepted"),
            (check.largest_admissible + unit, "rejected"),
        ):
            changed = with_value(gains, check, value)
            if changed is not None:
                again = checked(changed, limits, gamma)[check.id, check.joint]
                assert (again.value, again.verdict) == (value, verdict)


@pytest.mark.parametrize(("kv", "largest"), [("0.2", "0.2"), ("0.22", "0.22"), ("0.2230", "0.2224")])
def test_the_largest_admissible_has_the_digits_that_were_written(kv: str, largest: str) -> None:
    limits = limits_of(["50", "150", "15"], ["0", "40.28", "1.81"], "0.406")
    check = check_19(gains_of(["1"] * 3, [kv] * 3), limits, gamma_of(gains_of(["1"], ["1"])))[0]
    assert check.largest_admissible == Fraction(largest)
    assert places_of(check.largest_admissible) == len(largest) - 2


def test_more_digits_where_the_written_ones_allow_nothing_positive() -> None:
    """0.01/γ_2 = 0.00949…: neither 1 nor 0.1 passes, so the answer takes digits of its own."""
    limits = limits_of(["50"], ["0"], "0.01")
    for kv in ("1", "0.1"):
        check = check_19(gains_of(["1"], [kv]), limits, gamma_of(gains_of(["1"], ["1"])))[0]
        assert (check.largest_admissible, places_of(check.largest_admissible)) == (Fraction(94, 10_000), 4)


@pytest.mark.parametrize("budget", ["0", "-3"])
def test_nothing_passes_where_gravity_takes_the_whole_torque(budget: str) -> None:
    limits = limits_of([str(5 + int(budget))], ["5"], "1")
    for check in (*check_10p(*_simple(limits)), *check_10(*_simple(limits))):
        assert check.verdict == "rejected"
        assert check.largest_admissible is None
        assert check.limit is not None
        assert check.limit.upper <= 0


def _simple(limits: Limits) -> tuple[GainSet, Limits, Tree | None]:
    gains = gains_of(["0.5"], ["0.5"])
    return gains, limits, gamma_of(gains)


@pytest.mark.parametrize("m", [1, 2, 3, 50])
@pytest.mark.parametrize("places", [43, 120, 400])
def test_many_digits_neither_stall_nor_blur(m: int, places: int) -> None:
    text = f"0.{'2' * places}"
    limits = limits_of(["50", "150", "15"], ["0", "40.28", "1.81"], "0.406")
    gains = gains_of([text] * 3, [text] * 3, m)
    for check in checked(gains, limits).values():
        unit = Fraction(1, 10**places)
        assert check.largest_admissible is not None
        assert check.limit is not None
        assert check.limit.lower - 2 * unit <= check.largest_admissible <= check.limit.upper


# --- on the border ---------------------------------------------------------------------------------

SQUARES = st.sampled_from([1, 4, 9])
POSITIVE = st.fractions(min_value=Fraction(1, 1000), max_value=1000, max_denominator=1000)


@given(SQUARES, POSITIVE, st.sampled_from(["hyperbolic", "tanh", "algebraic"]), st.integers(0, 80))
def test_19_and_10p_are_strict(n: int, limit: Fraction, family: str, digits: int) -> None:
    """γ = 1 and √n is whole: the border is rational, and only what is below it passes."""
    m = 1 if family == "hyperbolic" else None
    budget = limit * isqrt(n)
    below_it = limit - limit / 10 ** (digits + 1)
    limits = Limits((budget + 7,) * n, (Fraction(7),) * n, budget, tuple(map(str, range(n))))
    for value, verdict in ((limit, "rejected"), (below_it, "accepted")):
        gains = GainSet("set", m, (value / 3,) * n, (value * 2 / 3,) * n, family)
        for check in check_10p(gains, limits, gamma_of(gains)):
            assert (check.value, check.verdict) == (value, verdict)
        gains = GainSet("set", m, (value,) * n, (value,) * n, family)
        for check in check_19(gains, limits, gamma_of(gains)):
            assert (check.value, check.verdict) == (value, verdict)
            assert check.limit == Enclosure.exact(limit)
            assert check.margin == limit - value


@given(SQUARES, POSITIVE, st.integers(1, 30), st.integers(1, 30), st.integers(0, 80))
def test_10_admits_its_border(n: int, unit: Fraction, a: int, b: int, digits: int) -> None:
    """Norms of Pythagorean pairs are rational, so the border of (10) is, for m = 1."""
    torque, gravity = max(a, b) + 1, min(a, b)
    pad = (Fraction(0),) * (n - 1)
    limits = Limits((torque * unit, *pad), (gravity * unit, *pad), None, tuple(str(i) for i in range(n)))
    border = (torque - gravity) * unit / isqrt(n)
    for value, verdict in ((border, "accepted"), (border * (1 + Fraction(1, 10**digits)), "rejected")):
        gains = GainSet("set", 1, (value / 4,) * n, (value * 3 / 4,) * n)
        (check,) = check_10(gains, limits, gamma_of(gains))
        assert (check.value, check.verdict) == (value, verdict)
        assert check.margin is not None
        assert (check.margin >= 0) == (verdict == "accepted")


def test_10_on_a_border_between_irrational_norms() -> None:
    """√8 − √2 = √2, and √2/√2 = 1: the norms are irrational, the border 1 is not."""
    limits = limits_of(["2", "2"], ["1", "1"], None)
    for kp, verdict in (("0.5", "accepted"), ("0.50000000000000000000000000000000000000001", "rejected")):
        gains = gains_of([kp, "0.1"], ["0.5", "0.1"], 1)
        (check,) = check_10(gains, limits, gamma_of(gains))
        assert check.verdict == verdict
    assert check_10(gains_of(["0.5"] * 2, ["0.5"] * 2, 1), limits, ("num", "1"))[0].margin == 0


def test_10_at_the_printed_bound() -> None:
    """(21 − 0)/(√4 · 1.05) = 10, though 1.05 is no binary fraction."""
    limits = limits_of(["21", "0", "0", "0"], ["0"] * 4, None)
    gains = gains_of(["9.5"] * 4, ["0.5"] * 4)
    (check,) = check_10(gains, limits, gamma_of(gains, "printed"))
    assert (check.verdict, check.margin, check.largest_admissible) == ("accepted", 0, 10)


@given(st.integers(1, 12), POSITIVE, POSITIVE, st.sampled_from([-1, 0, 1]), st.integers(1, 200))
def test_the_smaller_root_is_the_border(n: int, a: Fraction, b: Fraction, side: int, digits: int) -> None:
    """Norms a > b and γ = (a − b)/k√n with √n rational: exactly on the border, and a little beside it."""
    assume(a != b)
    n = n * n
    border = abs(a - b) / isqrt(n)
    value = border * (1 + Fraction(side, 10**digits))
    bound = norms(max(a, b) ** 2, min(a, b) ** 2, n, ("num", "1"))
    assert bound.admits(value) == (side <= 0) if value > 0 else True
    larger = (a + b) / isqrt(n)
    assert not bound.admits(larger)


def test_two_roots_that_balls_do_not_tell_apart_at_first() -> None:
    """Norms 1 and 10^-60: the border is 1 − 10^-60, and 1 + 10^-60 solves the same quadratic."""
    tiny = Fraction(1, 10**60)
    bound = norms(Fraction(1), tiny**2, 1, ("num", "1"))
    assert bound.admits(1 - tiny)
    for value in (1 - tiny / 2, Fraction(1), 1 + tiny):
        assert not bound.admits(value)


# --- what cannot be decided ------------------------------------------------------------------------


def test_an_unbounded_function_meets_no_bound() -> None:
    gains = gains_of(["0.8"], ["0.4"], None, "linear")
    for check in checked(gains, limits_of(["50"], ["0"], "1")).values():
        assert (check.verdict, check.limit, check.margin, check.largest_admissible) == (
            "rejected",
            None,
            None,
            None,
        )
        assert "unbounded" in check.reason


def test_without_a_limit_nothing_is_decided() -> None:
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


def test_the_printed_bounds_are_those_of_the_paper() -> None:
    """γ_1 = 1, γ_2 = 1.05, γ_3 = 1.11 (Table 2); the last two are below the true ones."""
    assert [PRINTED_GAMMA[m] for m in (1, 2, 3)] == [1, Fraction("1.05"), Fraction("1.11")]
    for m, printed in PRINTED_GAMMA.items():
        assert hyperbolic_constants(m).gamma.lower >= printed
        assert gamma_of(gains_of(["1"], ["1"], m), "printed") == ("num", str(printed))


@pytest.mark.parametrize(("m", "family"), [(4, "hyperbolic"), (None, "arctan")])
def test_the_paper_prints_no_other_bound(m: int | None, family: str) -> None:
    with pytest.raises(InputError, match="prints no γ"):
        gamma_of(gains_of(["1"], ["1"], m, family), "printed")


@pytest.mark.parametrize("check", [check_10, check_10p, check_19])
def test_a_verdict_is_exact_for_the_largest_member(
    check: Callable[[GainSet, Limits, Tree | None], list[Check]],
) -> None:
    gains = gains_of(["1.5"] * 3, ["0.1"] * 3, 10_000)
    limits = limits_of(["50", "150", "15"], ["0", "40.28", "1.81"], "0.406")
    assert {result.verdict for result in check(gains, limits, gamma_of(gains))} <= {"accepted", "rejected"}


def test_beyond_the_members_that_the_checker_knows_nothing_is_decided() -> None:
    limits = limits_of(["50", "150", "15"], ["0", "40.28", "1.81"], "0.406")
    for check in checked(gains_of(["1.5"] * 3, ["0.1"] * 3, 100_000), limits).values():
        assert (check.verdict, check.largest_admissible) == ("undecided", None)
        assert "the checker gives no verdict" in check.reason


@given(cases(), st.sampled_from(["hyperbolic", "arctan", "tanh", "algebraic", "linear"]))
def test_every_verdict_is_that_of_a_statement_and_its_proof(
    case: tuple[GainSet, Limits], family: str
) -> None:
    base, limits = case
    gains = GainSet("set", base.m if family == "hyperbolic" else None, base.kp, base.kv, family)
    for check in checked(gains, limits).values():
        result = check.judgement
        assert result is not None
        assert result.proof is not None
        again = verify(result.statement, result.proof)
        assert (again.verdict, again.grade) == (result.shown, result.grade)
        assert check.verdict == {"proved": "accepted", "refuted": "rejected"}[again.verdict]


def test_squares_are_taken_out_of_roots() -> None:
    for text in ("8", "1/2", "9/4", "0", "162577/100", str(2 * 2003**2)):
        with precision(200):
            assert abs(ball(root(Fraction(text))) ** 2 - to_arb(Fraction(text))) < 1e-40
    assert root(Fraction(8)) == ("mul", ("num", "2"), ("sqrt", ("num", "2")))
    assert root(Fraction(9, 4)) == ("num", "3/2")
    assert root(Fraction(2 * 2003**2))[2] != ("sqrt", ("num", str(2 * 2003**2)))
