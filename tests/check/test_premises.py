"""Properties of the loop and of V, from the obligations of an argument that they follow from."""

from dataclasses import replace
from fractions import Fraction

import pytest

from lyapcheck.check.kinds.stability import PROPERTIES, Property, Stable
from lyapcheck.check.refusal import Refused
from lyapcheck.claims import (
    companion,
    cosh,
    dh,
    gamma,
    h,
    log,
    potential,
    property_of,
    rho,
    secant_bound,
    tanh,
    var,
)
from lyapcheck.claims.bounds import above
from lyapcheck.claims.claim import Case
from lyapcheck.claims.procedures import propose
from tests.helpers.shares import but

pytestmark = pytest.mark.usefixtures("in_this_process")

EVERY, AT_REST = companion("every_function.py"), companion("kelly_santibanez.py")
X = var("x")
T = tanh(X)
SLOPE = 1 - T**2
U = log(cosh(X))
NUMBERS = {"gamma": 2, "rho": 5, "secant": 3, "low": Fraction(1, 4), "start": Fraction(3, 2)}
"""Bounds that hold of every function here that is one of the class."""


def stated(name, trio, **numbers):
    """A property of the loop of (6), or of V, with h, h' and U."""
    value, slope, own = (one.tree for one in trio)
    functions = EVERY.MEMBERS["tanh"]
    if name == "the origin is the only equilibrium":
        stable = AT_REST.regulator(functions, friction="positive")[2]
    else:
        stable = (EVERY.tracking if name == "V is decrescent" else EVERY.regulator)(functions, "any")
    system = stable.argument.system
    more = {"value": value, "slope": slope, "potential": own, **NUMBERS, **numbers}
    changed = tuple(replace(f, member=replace(f.member, **more)) for f in system.functions)
    return Property(name, replace(stable.argument, system=replace(system, functions=changed)))


def test_which_obligations_a_property_rests_on():
    """One that were left out would make the property follow from less."""
    rest = {name: [one for one, _ in stated(name, (T, SLOPE, U)).obligations()] for name in PROPERTIES}
    of_h = ["f(−x) = −f(x)", "0 < f(x) for x > 0", "f' is the derivative of f", "U' = f", "U(0) = 0"]
    of_h += ["f' ≤ 5", "−5 ≤ f'", "f ≤ 2", "−2 ≤ f", "|f(x)| ≤ 3|x|", "1/4 ≤ f(x) for x ≥ 3/2"]

    def functions(*names):
        return [f"{name}: {fact}" for name in names for fact in of_h]

    definite = ["above", "above, minor 1", "above, coefficient of sum_Uh"]
    assert rest == {
        "the origin is the only equilibrium": ["origin", *functions("h", "k"), "rest", "rest, minor 1"],
        "the origin is an equilibrium": ["origin", *functions("h", "k")],
        "V is positive definite": ["V at the origin", *functions("h", "k"), *definite],
        "V is radially unbounded": ["V at the origin", *functions("h", "k"), *definite],
        "V is decrescent": [*functions("h", "k"), "below"],
        "V is continuously differentiable": functions("h", "k"),
    }


@pytest.mark.parametrize("m", but((2,), (1, 2, 12)))
@pytest.mark.parametrize("name", PROPERTIES)
def test_every_property_is_proved_for_h_m(name, m):
    """Also where h_m of large numbers is not a double any more."""
    bounds = {"gamma": above(gamma(m)), "rho": above(rho(m)), "secant": above(secant_bound(m))}
    statement = stated(name, (h(m, X), dh(m, X), potential(m, X)), **bounds)
    decision = propose(statement)
    assert decision.verdict.value == "proved", decision.reason


def test_a_property_that_the_argument_has_no_form_for_is_refused():
    strict = EVERY.regulator(EVERY.any_function, "any")
    for name in ("the origin is the only equilibrium", "V is decrescent"):
        with pytest.raises(Refused, match="has no form"):
            property_of(name, strict).require_well_formed()
    claims = companion("slotine_li.py").proof.claims.values()
    stated = [claim.statement(Case(1, 1)) for claim in claims]
    cascade = next(one for one in stated if isinstance(one, Stable) and one.argument.cascade)
    disturbed = next(one for one in stated if isinstance(one, Stable) and one.argument.system.disturbed)
    with pytest.raises(Refused, match="unknown torque"):
        property_of("the origin is an equilibrium", disturbed).require_well_formed()
    with pytest.raises(Refused, match="see e"):
        property_of("V is positive definite", cascade).require_well_formed()


def test_a_bound_of_V_that_is_none_proves_nothing():
    """Φ with λmin(K_p) where the sum of all k_pi U(e_i) is asked."""
    argument = EVERY.tracking(EVERY.any_function, "any").argument
    tight = replace(argument.upper, linear=(("sum_Uh", ("var", "Kp_min")),))
    for upper, verdict in ((argument.upper, "proved"), (tight, "undecided")):
        statement = Property("V is decrescent", replace(argument, upper=upper))
        assert propose(statement).verdict.value == verdict
