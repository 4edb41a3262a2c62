"""The closed loop of a gain set on an arm as exact data for the checker, and what shows M(q) ≻ 0 there."""

from __future__ import annotations

from contextlib import suppress
from fractions import Fraction
from typing import TYPE_CHECKING

from lyapcheck.check.kinds.inertia import Bisection, Links, Mass
from lyapcheck.check.loop.closed_loop import ClosedLoop
from lyapcheck.check.loop.states import Arm
from lyapcheck.robots.dynamics import TooManyTerms
from lyapcheck.robots.trig import to_terms

if TYPE_CHECKING:
    from lyapcheck.control.gains import GainSet
    from lyapcheck.robots.plant import Plant


def closed_loop_of(
    gains: GainSet, model: Plant, eps0: Fraction, *, ranges: bool = False, coupling: tuple[Fraction, ...] = ()
) -> ClosedLoop:
    """(11) with V of (13), or of y = w − εΛh where a diagonal of Λ is given, at one ε₀.

    Args:
        model: the arm; its parameters range where it has some.
        eps0: ε₀.
        ranges: whether the friction of joints ranges.
        coupling: diagonal of Λ.
    """
    mass = mass_of(model)
    # what M does not depend on, gravity for one, is no side of the boxes
    first = 2 * model.n
    used = {
        k for row in mass for entry in row for powers, _ in entry for k, p in enumerate(powers[first:]) if p
    }
    return ClosedLoop(
        arm=Arm(mass, tuple(number.value for number in model.viscous)),
        family=gains.family,
        m=gains.m,
        kp=tuple(gains.kp),
        kv=tuple(gains.kv),
        eps0=eps0,
        parameters=tuple(
            number.bounds if place in used else (number.value, number.value)
            for place, number in enumerate(model.parameters.values())
        ),
        viscous=tuple(number.bounds for number in model.viscous) if ranges else (),
        coupling=coupling,
    )


# --- What shows that M(q) is positive definite: the links of an arm where they are known, else boxes.


_LINKS: dict[Mass, Links] = {}
"""The links of arms that were looked at, by the M(q) that they make."""


def mass_of(robot: Plant) -> Mass:
    """M(q) as statements have it."""
    return tuple(tuple(tuple(to_terms(entry)) for entry in row) for row in robot.mass)


def remember(robot: Plant) -> None:
    """Keep the links of an arm for statements that have only its M(q)."""
    fixed = robot.fixed()
    if fixed.chain is not None:
        # a mass matrix that is too long to be written out is in no statement
        with suppress(TooManyTerms):
            _LINKS[mass_of(fixed)] = Links(fixed.chain.links)


def mass_proof(mass: Mass) -> Bisection | Links:
    """How M ≻ 0 is to be shown."""
    return _LINKS.get(mass, Bisection())
