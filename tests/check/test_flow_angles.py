"""Pendulums: systems with sines and cosines, angles on the circle, and steps of LaSalle's theorem."""

from dataclasses import replace
from fractions import Fraction as F
from random import Random

import pytest

from lyapcheck.check.kinds.flow import known_of_sine
from lyapcheck.check.kinds.implies import Product, Squares, SumOfSquares
from lyapcheck.check.refusal import Refused
from lyapcheck.check.verify import verify
from lyapcheck.claims import converges_to, cos, enters, global_, implies, local, reals, sin, system, var
from lyapcheck.claims.procedures import propose
from lyapcheck.verdicts import Verdict
from tests.helpers.shares import one_in
from tests.helpers.stated import verdict
from tests.oracle.flows import flow
from tests.oracle.stability import value

t, w, x, y, z, a, b = map(var, "twxyzab")
PENDULUM = system({"t": w, "w": -sin(t) - w})
E = w**2 / 2 + 1 - cos(t)
V = E + w * sin(t) / 2
U = E + t**2 / 4 + t * w / 2 + w**2 / 4
D = w**2 / 2 - cos(t) - 1
SWING_UP = system({"t": w, "w": -sin(t) - w * D})
STIFF = system({"t": w, "w": sin(t) - 2 * t - w})
SPRING = w**2 / 2 + t**2 - (1 - cos(t))
TURNING = system({"x": y, "y": -x - y})


def swing_up(parts, loop=SWING_UP):
    return converges_to(loop, D**2 / 2, parts, grows=F(1, 4), less=4)


TRUE = {
    "rests": converges_to(PENDULUM, E, [w, sin(t)], grows=F(1, 2)),
    "with constants": converges_to(
        system({"t": w, "w": -a * sin(t) - b * w}, constants="a b"),
        w**2 / 2 + a * (1 - cos(t)),
        [w, a * sin(t)],
        grows=F(1, 2),
        less=2,
    ),
    "rests by a strict V": converges_to(PENDULUM, V, [w, sin(t)], grows=F(1, 4), less=2),
    "downwards by a strict V": local(PENDULUM, V, region=F(1, 2) >= V, within=3),
    "downwards in steps": local(PENDULUM, E, region=F(3, 2) >= E, within=F(7, 2), rest=[w, sin(t)]),
    "downwards, no angle": local(PENDULUM, U - w**2 / 4, region=F(1, 2) >= U - w**2 / 4, within=2),
    "swing up": swing_up([w * D, sin(t) * D, (1 - cos(t)) * D**2]),
    "a spring beside gravity": global_(STIFF, SPRING + t * w / 4, grows=F(1, 8)),
    "the spring in a step": global_(STIFF, SPRING, grows=F(1, 2), rest=[w]),
    "a linear system in steps": global_(TURNING, x**2 + y**2, rest=[y, x]),
    "brought to a speed": enters(system({"t": w, "w": -w - sin(t)}), w**2, region=w**2 <= 3, less=4),
}


@pytest.mark.parametrize("name", one_in(5, TRUE))
def test_pendulums(name):
    statement = TRUE[name]
    assert verdict(statement) == "proved"
    assert flow(statement, Random(1)) is None


FALSE = {
    "upright": local(PENDULUM, V, region=F(5, 2) >= V, within=5),
    "upright in steps": local(PENDULUM, E, region=E <= 2, within=5, rest=[w, sin(t)]),
    "driven": converges_to(system({"t": w, "w": -sin(t) + w}), E, [w, sin(t)], grows=F(1, 2)),
    "undamped": converges_to(system({"t": w, "w": -sin(t)}), E, [w, sin(t)], grows=F(1, 2)),
    "undamped, downwards": local(system({"t": w, "w": -sin(t)}), E, region=E <= 1, within=3, rest=[w]),
    "all to the bottom": converges_to(PENDULUM, E, [w, sin(t), 1 - cos(t)], grows=F(1, 2)),
    "all to the top": converges_to(PENDULUM, E, [w, sin(t), 1 + cos(t)], grows=F(1, 2)),
    "in the wrong order": converges_to(PENDULUM, E, [sin(t), w], grows=F(1, 2)),
    "energy for all": swing_up([w * D, sin(t) * D, D]),
    "energy at once": swing_up([D]),
    "swung down": swing_up([w * D], system({"t": w, "w": -sin(t) + w * D})),
    "a soft spring": global_(
        system({"t": w, "w": 2 * sin(t) - t - w}),
        w**2 / 2 + t**2 / 2 - 2 * (1 - cos(t)),
        grows=F(1, 8),
        less=9,
    ),
    "a rest that is not seen": local(PENDULUM, E, region=E <= 2, within=5, rest=[w]),
    "no damping": global_(system({"x": y, "y": -x}), x**2 + y**2, rest=[y, x]),
    "constant torque": converges_to(system({"t": w, "w": 2 - sin(t) - w}), E, [w], grows=F(1, 2)),
    "a torque too small to matter": converges_to(
        system({"t": w, "w": F(1, 1000) - sin(t) - w}), E, [w, sin(t)], grows=F(1, 2)
    ),
    "too slow": enters(system({"t": w, "w": 2 - w - sin(t)}), w**2, region=w**2 <= 3, less=4),
    "a motion from the border": local(
        system({"x": x * (x - 1) * (x - 2) * (x - F(5, 4)) + 0 * y, "y": -y}),
        x**2 + y**2,
        region=x**2 + y**2 <= F(3, 2),
        within=2,
        rest=[x, y],
    ),
}


@pytest.mark.parametrize("name", one_in(4, FALSE))
def test_what_a_pendulum_does_not_do_is_not_proved(name):
    assert propose(FALSE[name]).verdict is Verdict.UNDECIDED


@pytest.mark.parametrize("name", ["swung down", "driven", "undamped", "constant torque", "all to the top"])
def test_the_oracle_sees_it(name):
    assert any(flow(FALSE[name], Random(k)) for k in range(4))


def test_no_rest_attracts_all_on_a_circle():
    result = propose(global_(PENDULUM, E, grows=F(1, 2), rest=[w, sin(t)]))
    assert "t: have no single rest that attracts all" in result.reason


def test_a_minimum_on_the_border_of_the_region_is_no_part_of_it():
    """From x = 2, a minimum of V, a motion goes to 3; dV/dt <= 0 where V <= 1 is not enough."""
    bowl = x**2 * (x - 2) ** 2 + x**2 * (3 - x) / 4
    loop = system({"x": x * (x - 1) * (3 - x)})
    statement = local(loop, bowl, region=bowl <= 1, within=F(25, 4), rest=[x * (x - 2), x])
    obligations = dict(statement.obligations())
    fall = obligations.pop("fall")
    assert propose(fall).verdict is Verdict.REFUTED
    weaker = replace(fall, hypotheses=(*fall.hypotheses, bowl <= 1))
    assert propose(weaker).verdict is not Verdict.REFUTED
    assert Verdict.REFUTED not in {propose(one).verdict for one in obligations.values()}


def test_facts_of_the_sine_hold():
    """At many points, in an arithmetic of its own."""
    for relation in known_of_sine("t"):
        for k in range(-200, 201):
            assert value(relation.gap, {("var", "t"): k / 10}) >= -1e-12, (relation, k)
        assert abs(value(relation.gap, {("var", "t"): 0.0})) < 1e-12


# Equations and sines in sums of squares ---------------------------------------------------------------------


def test_a_factor_of_any_sign_is_for_equations_alone():
    statement = implies(reals("x", "y"), [x <= y, x >= y], x <= y)
    minus = Squares(((),), ((),), (F(-1),))
    proof = SumOfSquares(Squares((), (), ()), (Product(1, (), minus),))
    assert verify(statement, proof).verdict == "proved"
    for other in ([x <= y + 1, x >= y], [x >= y, x >= y], [x <= y + 1, x >= y + 1]):
        with pytest.raises(Refused):
            verify(implies(reals("x", "y"), other, x <= y), proof)
    with pytest.raises(Refused, match="not shown to be strict"):
        verify(implies(reals("x", "y"), [x <= y, x >= y], x < y), proof)


def test_a_hypothesis_with_a_sine_does_not_exclude_the_origin():
    """At x = 0 a cosine is 1, so 0 < cos x fails nowhere near it."""
    statement = implies(reals("x"), [cos(x) > 0], x**2 > 0)
    of_x = Squares((((0, 1),),), ((),), (F(1),))
    with pytest.raises(Refused, match="not shown to be strict"):
        verify(statement, SumOfSquares(Squares((), (), ()), (Product(None, (), of_x),)))
