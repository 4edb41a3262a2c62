"""What shows that M(q) is positive definite: the links of an arm where they are known, else boxes."""

from __future__ import annotations

from contextlib import suppress
from typing import TYPE_CHECKING

from lyapcheck.check.kinds.inertia import Bisection, Links, Mass
from lyapcheck.robots.dynamics import TooManyTerms
from lyapcheck.robots.trig import to_terms

if TYPE_CHECKING:
    from lyapcheck.robots.plant import Plant

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
