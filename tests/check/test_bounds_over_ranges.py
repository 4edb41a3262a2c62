"""Bounds of motions for every arm in ranges: what is proved of narrow ones is refused of wider ones."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace
from fractions import Fraction as F
from typing import Any

import pytest

from lyapcheck.check.kinds.at_corners import MassAtCorners, RateAtCorners
from lyapcheck.check.kinds.inertia import Bisection, MassAbove
from lyapcheck.check.loop.closed_loop import ClosedLoop
from lyapcheck.check.loop.decay.margin import Margin
from lyapcheck.check.refusal import Refused
from lyapcheck.check.verify import verify
from tests.arena.extra import (
    LEVELS,
    PHASES,
    RANGED_LEVELS,
    RANGED_PHASES,
    RANGING,
    SETTLING,
    STAYS_WITHIN,
    STOPPING,
)
from tests.statement_fuzz.motions import found
from tests.statement_fuzz.oracle.kinds import objection

STATED = {
    "levels": (replace(SETTLING, **RANGING), RANGED_LEVELS, LEVELS),
    "phases": (replace(STAYS_WITHIN, **RANGING), RANGED_PHASES, PHASES),
}
WIDER: dict[str, Callable[[Any], Any]] = {
    "far less friction": lambda one: replace(one, viscous=((F(1, 10), F(6, 5)),)),
    "far more friction": lambda one: replace(one, viscous=((F(1), F(20)),)),
    "more inertia": lambda one: replace(one, parameters=((F(9, 10), F(6, 5)),)),
    "no inertia": lambda one: replace(one, parameters=((F(0), F(1)),)),
    "inertia that bends between the corners": lambda one: replace(
        one, mass=(((((0, 0, 2), F(1)),),),), parameters=((F(9, 10), F(1)),)
    ),
}


@pytest.mark.parametrize("kind", STATED)
def test_a_range_is_proved_and_wider_ones_are_refused(kind: str) -> None:
    statement, proof, of_one_arm = STATED[kind]
    assert verify(statement, proof).verdict == "proved"
    assert "0.9" in statement.text() or "9/10" in statement.text()
    assert any("constant in time" in one for one in statement.granted)
    for wider in WIDER.values():
        with pytest.raises(Refused):
            verify(wider(statement), proof)
    with pytest.raises(Refused):
        verify(statement, replace(proof, **_one_corner(proof)))
    assert verify(replace(statement, **_point(statement)), of_one_arm).verdict == "proved"


def _point(statement: Any) -> dict[str, Any]:
    """The arm at the corner that the proof for one arm is about."""
    return {"mass": SETTLING.mass, "parameters": (), "viscous": SETTLING.viscous}


def _one_corner(proof: Any) -> dict[str, Any]:
    """The same with a corner of which nothing is said."""
    if proof is RANGED_LEVELS:
        return {"decreasing": replace(proof.decreasing, rate=RateAtCorners(proof.decreasing.rate.each[:1]))}
    return {"lightness": (MassAtCorners((Bisection(),)),)}


def test_corners_decide_only_where_m_is_affine() -> None:
    mass, corners = RANGING["mass"], MassAtCorners((Bisection(),) * 2)
    above = MassAbove(mass, ((F(9, 10), F(1)),), F(1, 2))
    assert verify(above, corners).verdict == "proved"
    hollow = (((((0, 0, 2), F(1)), ((0, 0, 0), F(-1, 4))),),)
    with pytest.raises(Refused, match="affine"):
        verify(MassAbove(hollow, ((F(-1), F(1)),), F(0)), corners)  # positive at both ends, −1/4 at 0
    with pytest.raises(Refused, match="must be 2"):
        verify(above, MassAtCorners((Bisection(),)))
    many = ((((tuple([0, 0] + [int(i == k) for i in range(9)]), F(1)) for k in range(9)),),)
    nine = tuple(tuple(tuple(entry) for entry in row) for row in many)
    with pytest.raises(Refused, match="must not exceed 256"):
        verify(MassAbove(nine, ((F(1), F(2)),) * 9, F(0)), MassAtCorners((Bisection(),) * 512))


def test_friction_between_its_ends_is_paid_by_stiffness() -> None:
    """(1 − κ)K_p − ¼ ε₀ Δ, at the lower end of B: high friction is worst for stiffness, low for damping."""
    margin = Margin(_loop(((F(1), F(3)),)), F(1, 4), F(1, 4), F(1, 2), F(0), LEVELS.heaviest)
    assert margin.reduced.kp == (F(3, 4) - F(1, 5) * 2 / 4,)
    assert margin.reduced.friction == ((F(3, 4), F(3, 4)),)
    assert margin.viscous == (F(1),)
    assert not replace(margin, loop=_loop(((F(1), F(17)),))).reduced.admissible


def _loop(viscous: Any) -> ClosedLoop:
    arm = STATED["levels"][0]
    from lyapcheck.check.loop.states import Arm

    numbers = (arm.family, arm.m, arm.kp, arm.kv, arm.eps0)
    return ClosedLoop(Arm(arm.mass, (F(1),)), *numbers, parameters=arm.parameters, viscous=viscous)


def test_motions_to_rest_need_friction_and_inertia_throughout() -> None:
    from lyapcheck.check.kinds.stopping import EnergyFalls

    statement, proof = replace(STOPPING, **RANGING), EnergyFalls(Bisection())
    assert verify(statement, proof).verdict == "proved"
    for wrong in ({"viscous": ((F(0), F(1)),)}, {"parameters": ((F(-1, 10), F(1)),)}):
        with pytest.raises(Refused):
            verify(replace(statement, **wrong), proof)


@pytest.mark.slow
@pytest.mark.parametrize("in_phases", [False, True])
def test_no_arm_in_the_ranges_breaks_what_is_proved(in_phases: bool) -> None:
    """Motions of the oracle, of arms at the ends of the ranges and in the middle."""
    statement, proof = found(5, in_phases)
    assert verify(statement, proof).verdict == "proved"
    assert statement.parameters
    assert any(low < high for low, high in statement.viscous)
    for seed in range(8):
        assert objection(statement, seed) is None
