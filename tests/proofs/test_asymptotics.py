"""How γ_m, ρ_m and L_m grow with m: the proof script, and the same bounds straight from the constants."""

from fractions import Fraction

import pytest
from flint import arb

from lyapcheck.check.numbers.balls import hyperbolic_constants, precision
from lyapcheck.claims import exp, for_all, log, run_proof, var
from lyapcheck.claims.procedures import propose

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


def test_a_witness_is_a_number_that_can_be_shown():
    """e^(e^x) is above 2 everywhere; a state of that is found, and none of a million digits is tried."""
    x = var("x")
    outcome = propose(for_all(exp(exp(x)) <= 2, 0))
    assert outcome.verdict.value == "refuted"
    assert all(len(end) < 2000 for side in ("left", "right") for end in outcome.witness[side])
    assert propose(for_all(exp(exp(x)) <= 2, 20, 40)).verdict.value == "undecided"
