"""Properties of the loop and of V, from facts in one variable about h."""

from dataclasses import replace
from fractions import Fraction

import pytest

from lyapcheck.check.kinds.loop_property import FACTS, Facts, LoopProperty, facts_of
from lyapcheck.check.refusal import Refused
from lyapcheck.check.verify import verify
from lyapcheck.claims import cosh, dh, exp, expr, h, log, loop_property, potential, tanh, var
from lyapcheck.claims.procedures import propose
from tests.helpers.shares import but

pytestmark = pytest.mark.usefixtures("in_this_process")


def test_which_facts_a_property_rests_on():
    """One that were left out would make the property follow from less."""
    statement = {name: LoopProperty(name, *LINEAR) for name in FACTS}
    result = {
        name: {fact for fact, _ in facts_of(one, (Fraction(1),) * FACTS[name][0])}
        for name, one in statement.items()
    }
    slope = "h' is the derivative of h"
    sign = {slope, "h(−x) = −h(x)", "0 < h(x) for x > 0"}
    definite = {"U' = h", "U(0) = 0", *sign}
    assert result == {
        "the origin is the only equilibrium": {*sign, "the loop that the controller closes"},
        "the origin is an equilibrium": {*sign, "the loop that the controller closes"},
        "V is positive definite": definite,
        "V is bounded below by a positive definite function": definite,
        "V is bounded above by a positive definite function": definite,
        "V is radially unbounded": {
            slope,
            "U' = h",
            "h(−x) = −h(x)",
            "c ≤ h(x) from some x on",
            "h ≤ γ",
            "−γ ≤ h",
        },
        "V is continuously differentiable": {
            "U' = h",
            slope,
            "h' ≤ ρ",
            "−ρ ≤ h'",
            "|h(x)| ≤ L|x|",
        },
    }


T = tanh(var("x"))
SLOPE = 1 - T**2
U = log(cosh(var("x")))
LINEAR = (("var", "x"), ("num", "1"), ("div", ("pow", ("var", "x"), 2), ("num", "2")))
X = var("x")
FAILS = {
    "U does not belong to h": ("V is positive definite", (T, SLOPE, 2 * U)),
    "U(0) is not 0": ("V is positive definite", (T, SLOPE, U + 1)),
    "h is not odd": ("V is positive definite", (exp(X) - 1, exp(X), exp(X) - X - 1)),
    "h has the other sign": ("V is positive definite", (-T, -SLOPE, -U)),
    "h vanishes": ("V is bounded below by a positive definite function", (0 * X, 0 * X, 0 * X)),
    "h vanishes elsewhere": (
        "the origin is the only equilibrium",
        (X**3 - X, 3 * X**2 - 1, X**4 / 4 - X**2 / 2),
    ),
    "the force turns away from 0": ("the origin is an equilibrium", (-T, -SLOPE, -U)),
    "V is bounded": ("V is radially unbounded", (X / (1 + X**2) ** 2, X, -1 / (1 + X**2) / 2)),
    "h comes down to 0": ("V is radially unbounded", (X / (1 + X**2), X, log(1 + X**2) / 2)),
    "h is not bounded": ("V is radially unbounded", (X, expr(1), X**2 / 2)),
    "h rises on one side only": ("V is radially unbounded", (exp(X) / (1 + exp(X)), X, log(1 + exp(X)))),
    "h' is not bounded": ("V is continuously differentiable", (X**3, 3 * X**2, X**4 / 4)),
    "h' is something else": ("V is continuously differentiable", (T, 2 * SLOPE, U)),
    "U is something else": ("V is continuously differentiable", (T, SLOPE, 2 * U)),
}


@pytest.mark.parametrize("name", FAILS)
def test_a_property_is_not_proved_where_a_fact_fails(name):
    decision = propose(loop_property(*FAILS[name]))
    assert decision.verdict.value in ("refuted", "undecided")


@pytest.mark.parametrize("m", but((2,), (1, 2, 12)))
@pytest.mark.parametrize("name", FACTS)
def test_every_property_is_proved_for_h_m(name, m):
    """Also where h_m of large numbers is not a double any more."""
    decision = propose(loop_property(name, (h(m, X), dh(m, X), potential(m, X))))
    assert decision.verdict.value == "proved", decision.reason


def test_a_property_with_other_numbers_or_fewer_proofs_is_refused():
    statement = loop_property("V is radially unbounded", (T, SLOPE, U))
    proof = propose(statement).proof
    assert verify(statement, proof).verdict == "proved"
    forged = [replace(proof, proofs=proof.proofs[:-1]), replace(proof, numbers=proof.numbers[:-1])]
    forged += [
        replace(proof, numbers=(*proof.numbers[:k], number, *proof.numbers[k + 1 :]))
        for k, number in ((0, Fraction(2)), (0, Fraction(-1)), (0, Fraction(0)), (2, Fraction(1, 2)))
    ]
    forged.append(
        replace(proof, proofs=(*proof.proofs[:2], proof.proofs[3], proof.proofs[2], *proof.proofs[4:]))
    )
    for one in forged:
        with pytest.raises(Refused):
            verify(statement, one)


def test_only_the_equilibrium_depends_on_the_torque():
    with pytest.raises(Refused, match="for the equilibrium of"):
        verify(loop_property("V is positive definite", (T, SLOPE, U), desired=True), Facts((), ()))
