"""Bounded controllers: gravity beside a function, functions at another argument, and refusals of both."""

from dataclasses import replace

import pytest

from lyapcheck.check.kinds.stability import Stable
from lyapcheck.check.kinds.stable_arm import StableArm
from lyapcheck.check.refusal import Refused
from lyapcheck.claims import any_vector, companion, constant_goal, var
from lyapcheck.claims import log as logarithm
from lyapcheck.claims.procedures import propose
from tests.helpers.stated import verdict, why

x = var("x")
SATURATED, PLUS, PID = (
    companion(f"{name}.py") for name in ("saturated_pd_gravity_goal", "spd_plus", "nonlinear_pid")
)
REGULATOR = SATURATED.regulator(SATURATED.any_function)[2]
SINGLE = PLUS.regulator(PLUS.any_function)


@pytest.mark.parametrize(("statement", "letter"), [(REGULATOR, "Tf"), (SINGLE, "c")])
def test_what_has_no_derivative_is_no_part_of_V(statement, letter):
    """Probes and increases."""
    argument = statement.argument
    more = ("add", argument.energy, ("dot", ("vec", letter), ("vec", "e")))
    assert verdict(statement) == "proved"
    assert why(Stable(replace(argument, energy=more)))


def test_a_function_of_something_else_is_refused_with_the_repair():
    goal = constant_goal()
    e, w, (K, H) = goal.e, goal.w, goal.gains("K H")
    for of in (e + w, 2 * K @ e, -e, K @ (H @ e), goal.M @ e, any_vector("y"), K @ e - H @ w):
        with pytest.raises(ValueError, match=r"goal\.increase\(name, f, K @ e - D @ w\)"):
            goal.entrywise("f", of)
    f = goal.entrywise("f", K @ e)
    for to in (e - H @ w, K @ e, K @ e - w, K @ e - 2 * H @ w, 2 * K @ e - H @ w, K @ e - H @ w + w, H @ w):
        with pytest.raises(ValueError, match="an increase is of a function of this goal"):
            goal.increase("c", f, to)
    with pytest.raises(ValueError, match="the function is of e itself"):
        goal.increase("c", f, K @ e + H @ e)
    with pytest.raises(ValueError, match="a level is a gain of this goal"):
        goal.entrywise("k", w, level=H)
    with pytest.raises(ValueError, match="a level is a gain of this goal"):
        goal.entrywise("k", e, level=goal.M)


@pytest.mark.parametrize(
    "change",
    [{"gain": "M"}, {"gain": "e"}, {"level": "nothing"}, {"of": "w"}, {"name": "TL"}, {"name": "x_y"}],
)
def test_functions_of_an_attacker_are_refused(change):
    system = REGULATOR.argument.system
    first = replace(system.functions[0], **change)
    new = replace(system, functions=(first, *system.functions[1:]))
    with pytest.raises(Refused):
        Stable(replace(REGULATOR.argument, system=new)).require_well_formed()


@pytest.mark.parametrize(
    "change",
    [
        *({"function": "f"}, {"of": "e"}, {"of": "nothing"}, {"gain": "M"}, {"gain": ""}),
        *({"name": "h"}, {"name": "s"}),
    ],
)
def test_increases_of_an_attacker_are_refused(change):
    system = SINGLE.argument.system
    new = replace(system, increases=tuple(replace(one, **change) for one in system.increases))
    with pytest.raises(Refused):
        Stable(replace(SINGLE.argument, system=new)).require_well_formed()


def test_a_function_that_falls_has_no_increases():
    """x/(1 + x²) has the sign of x, and is smaller far away than near."""

    def bent(goal, of):
        energy = logarithm(1 + x**2) / 2
        return goal.function("h", of, x / (1 + x**2), energy, gamma=1, rho=1, secant=1, low="1/8", start=1)

    named = dict(PLUS.regulator(bent).obligations())
    assert propose(named["h: 0 < f'"]).verdict.value == "refuted"


def test_numbers_of_an_arm_that_are_no_bounds():
    claims = SATURATED.proof.claims
    good, weak = (claims[name].statement(None) for name in ("P.pelican", "weak"))
    assert verdict(good) == "proved"
    ((name, number),) = good.numbers
    assert name == "f_load"
    assert why(StableArm(good.argument, good.arm, good.gains, ((name, number / 4),)))
    assert "condition 1" in why(weak)
    functions = good.argument.system.functions
    first = replace(functions[0], member=replace(functions[0].member, steep=None))
    system = replace(good.argument.system, functions=(first, *functions[1:]))
    with pytest.raises(Refused, match="is no such bound"):
        replace(good, argument=replace(good.argument, system=system)).require_well_formed()
