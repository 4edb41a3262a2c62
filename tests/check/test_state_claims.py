"""Claims about every state of an arm: what proves and what refutes them, and changed certificates."""

from dataclasses import replace
from fractions import Fraction

import pytest
from hypothesis import given
from hypothesis import strategies as st

from lyapcheck.answers.check.run import paper_case_data
from lyapcheck.check.refusal import Refused
from lyapcheck.check.verify import verify
from lyapcheck.claims import above, below, damping_below, decreasing, gamma, largest_with, sqrt
from lyapcheck.claims.claim import Case, Lacking
from lyapcheck.claims.procedures import propose
from lyapcheck.control.gains import GainSet
from lyapcheck.robots import load
from lyapcheck.verdicts import Verdict
from tests.helpers.shares import one_in

F = Fraction
CASE = Case(*paper_case_data(2))
BOUND = F("0.406") / sqrt(3) / gamma(2)
STATEMENT = damping_below(CASE.robot, CASE.gains, BOUND)


def planar(eps0, kv="0.2", **options):
    """A claim about the two-joint arm."""
    gains = GainSet("g", 2, (F(40), F(4)), (F(kv), F(kv)))
    return decreasing(load("reyes-kelly2"), gains, eps0, **options)


@pytest.mark.parametrize(
    ("eps0", "verdict", "method"),
    one_in(
        3, [("0.005", "proved", "norms"), ("0.05", "proved", "branch and bound"), ("3", "refuted", "a state")]
    ),
)
def test_a_growing_eps0_is_decided_by_norms_then_boxes_then_against(eps0, verdict, method):
    decision = propose(planar(eps0))
    assert decision.verdict.value == verdict
    assert method in decision.method
    assert verify(planar(eps0), decision.proof).verdict == verdict


def test_what_cannot_be_decided_says_what_to_try():
    assert "positive" in propose(planar(-1)).reason
    frictionless = replace(planar("0.01"), viscous=((F(0), F(0)),) * 2)
    assert propose(frictionless).verdict is Verdict.UNDECIDED


def test_gains_of_another_arm_or_an_unbounded_h_are_lacking():
    with pytest.raises(Lacking, match="3 joints"):
        decreasing(load("pendulum1"), CASE.gains, "0.1")
    with pytest.raises(Lacking, match="unbounded"):
        decreasing(load("pendulum1"), GainSet("pd", None, (F(1),), (F(1),), family="linear"), "0.1")


# A bound of the damping that is said to be necessary --------------------------------------------------------


@pytest.fixture(scope="module")
def against():
    return propose(STATEMENT)


def test_gains_within_the_bound_are_scaled_until_they_break_it():
    small = replace(STATEMENT, kv=(F(1, 100),) * 3)
    assert F(propose(small).witness["point"]["factor of K_v"]) > 20


@pytest.mark.parametrize(
    "change", [{"kv": (F(0),) * 3}, {"kp": (F(1),)}, {"bound": ("var", "x")}, {"viscous": ()}]
)
def test_a_statement_that_says_nothing_is_refused(against, change):
    with pytest.raises(Refused):
        verify(replace(STATEMENT, **change), against.proof)


def test_an_arm_without_friction_leaves_it_open():
    assert propose(replace(STATEMENT, viscous=((F(0), F(0)),) * 3)).verdict is Verdict.UNDECIDED


# Decimal bounds ---------------------------------------------------------------------------------------------


@given(st.fractions(-100, 100), st.integers(0, 9))
def test_rounding_goes_outward_by_less_than_one_unit(value, digits):
    unit = F(1, 10**digits)
    slack = F(1, 10**30)
    assert value <= above(value, digits) < value + unit + slack
    assert value - unit - slack < below(value, digits) <= value


def test_the_largest_number_with_a_property():
    assert float(largest_with(lambda x: x**2 < 2)) == pytest.approx(2**0.5, rel=1e-5)
    assert largest_with(lambda x: x**2 < 2) ** 2 < 2
    assert float(largest_with(lambda x: x < F(1, 1000))) == pytest.approx(1e-3, rel=1e-5)
    assert largest_with(lambda x: False) is None
