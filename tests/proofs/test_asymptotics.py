"""How γ_m, ρ_m and L_m grow with m: the proof script, and the same bounds straight from the constants."""

from __future__ import annotations

from fractions import Fraction

import pytest
from flint import arb

from lyapcheck.check.numbers.balls import hyperbolic_constants, precision
from lyapcheck.claims import exp, for_all, log, run_proof, var
from lyapcheck.claims.procedures import propose
from lyapcheck.family.asymptotes import gamma_less_than

pytestmark = pytest.mark.usefixtures("in_this_process")

MEMBERS = (*range(1, 13), 50, 100, 317, 1000)


@pytest.fixture(scope="module")
def result():
    return run_proof("asymptotics.py", MEMBERS)


def test_every_claim_is_proved_for_small_and_large_m(result):
    assert {row.decision.verdict.value for row in result.claims} == {"proved"}
    assert {row.m for row in result.claims} == set(MEMBERS)


@pytest.mark.slow
def test_every_claim_about_all_m_is_proved_at_once():
    rows = run_proof("every_m.py", (2,)).claims
    assert {row.decision.verdict.value for row in rows} == {"proved"}
    assert {row.m for row in rows} == {None}


@pytest.mark.slow
def test_the_bounds_hold_for_m_up_to_1000():
    with precision(160):
        root2, asinh1 = arb(2).sqrt(), (1 + arb(2).sqrt()).log()
        for m in range(2, 1001):
            outcome = hyperbolic_constants(m, 30)
            gamma, rho, secant = (value.to_arb() for value in (outcome.gamma, outcome.rho, outcome.L))
            step = arb(4 * m).log() / m
            excess = gamma / root2 - 1 + (1 + arb(4 * m).log()) / (4 * m)
            assert gamma_less_than(m, Fraction(2))
            assert step**2 * 3 / 32 < excess < step**2 / 6
            assert m - Fraction(1, 2) < outcome.rho.lower < outcome.rho.upper < m
            assert arb(-3) / (4 * m * m) < rho - (arb(2 * m - 1) / 2 + arb(9) / (16 * m)) < 0
            fall = (1 + root2 / asinh1) / 4
            excess = secant * asinh1 / root2 - 1 + fall * (1 + (m / fall).log()) / m
            assert step**2 / 5 < excess < step**2 / 3
            assert secant < root2 / asinh1


def test_the_second_order_term_of_gamma_lies_between_the_two_that_are_claimed():
    """At m = 1000 it is 0.102 (ln 4m/m)²: above 3/32, and a bound of 1/10 would be false."""
    with precision(160):
        step = arb(4000).log() / 1000
        share = hyperbolic_constants(1000, 30).gamma.to_arb() / arb(2).sqrt()
        excess = share - 1 + (1 + arb(4000).log()) / 4000
        assert step**2 * 3 / 32 < excess
        assert excess > step**2 / 10


def test_rho_comes_as_close_to_its_expansion_as_is_claimed():
    """The distance times m² tends to 3/4: no smaller constant would do, and −1/2 and 9/16 are right."""
    for m in (100, 1000, 10_000, 100_000):
        rho = hyperbolic_constants(m, 40).rho.mid
        scaled = (m - Fraction(1, 2) + Fraction(9, 16 * m) - rho) * m * m
        assert 0 < Fraction(3, 4) - scaled < Fraction(6, 5 * m)


@pytest.mark.parametrize(
    ("share", "last", "verdict"),
    [("3/32", 1, "proved"), ("1/10", 1, "undecided"), ("3/32", "0.9", "refuted"), ("1/8", 1, "refuted")],
)
def test_no_false_bound_is_proved_for_every_m(share, last, verdict):
    """h_m²/2 at sinh^(2m) x = 4m: the term of (ln 4m/m)² tends to 3/32, that of 1/(4m) is 1."""
    x = var("x")
    u, step = exp(4 * log(x) / x), 4 * log(x) / x
    terms = 1 - log(x) / x - Fraction(last) / x + step**2 * Fraction(share)
    value = (1 + 1 / u) / 2 * (x / (x + 1)) ** 2
    outcome = propose(for_all(terms**2 < value, 8)).verdict.value
    assert outcome == verdict


def test_the_bounds_for_every_m_are_those_of_the_largest_members():
    """γ_m, ρ_m and L_m themselves keep to what the claims E say, up to m = 100,000."""
    with precision(200):
        for m in (2, 3, 1000, 100_000):
            outcome = hyperbolic_constants(m, 40)
            step, terms = arb(4 * m).log() / m, 1 - (1 + arb(4 * m).log()) / (4 * m)
            share = outcome.gamma.to_arb() / arb(2).sqrt()
            assert terms + step**2 * 3 / 32 < share < terms + step**2 / 6
            high = Fraction(2 * m - 1, 2) + Fraction(9, 16 * m)
            assert high - Fraction(3, 4 * m**2) < outcome.rho.lower <= outcome.rho.upper < high
            limit = arb(2).sqrt() / arb(1).asinh()
            assert limit * (1 - step * 3 / 4) < outcome.L.to_arb() < limit


SAMPLES = [Fraction(k, 7) for k in range(1, 200, 9)]


@pytest.mark.parametrize("m", [12, 13, 40, 1000])
def test_the_pieces_of_the_bound_of_rho_are_the_slope(m):
    """h_m' of (8) at u = e^(−s/m) is what every_m.py bounds, and its polynomials enclose it where s ≤ m."""
    with precision(200):
        upper = arb(2 * m - 1) / 2 + arb(9) / (16 * m)
        for q in SAMPLES:
            s = arb(q.numerator) / q.denominator
            u, p = (-s / m).exp(), (-s).exp()
            slope = ((2 * m - 1) * p / u + 2 * m * p - p**2 / u) / (1 + p) ** 2
            same = (2 * m + (s / m).exp() * (2 * m - 1 - p)) / (4 * (s / 2).cosh() ** 2)
            assert slope.overlaps(same)
            assert slope < upper
            if q <= m:
                top = 2 * m + (1 + s / m + s**2 / m**2) * (2 * m - 2 + s)
                assert same < top / (4 * (1 + s**2 / 4 + s**4 / 48)) < upper
            else:
                assert same < 4 * m * (1 - arb(m)).exp() < upper


def test_a_witness_is_a_number_that_can_be_shown():
    """e^(e^x) is above 2 everywhere; a state of that is found, and none of a million digits is tried."""
    x = var("x")
    outcome = propose(for_all(exp(exp(x)) <= 2, 0))
    assert outcome.verdict.value == "refuted"
    assert all(len(end) < 2000 for side in ("left", "right") for end in outcome.witness[side])
    assert propose(for_all(exp(exp(x)) <= 2, 20, 40)).verdict.value == "undecided"
