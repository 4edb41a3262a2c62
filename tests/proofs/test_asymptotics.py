"""How γ_m, ρ_m and L_m grow with m: the proof script, and the same bounds straight from the constants."""

from fractions import Fraction

import pytest

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
