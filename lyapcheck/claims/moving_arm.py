"""Properties of M(q) and C(q, w) of one robot as statements, for all values of its uncertain numbers."""

from __future__ import annotations

from typing import TYPE_CHECKING

from lyapcheck.check.kinds.coriolis import (
    CoriolisAtRest,
    MassSymmetric,
    RateLessTwiceCoriolis,
    RateOfMass,
)
from lyapcheck.check.statement import Ends
from lyapcheck.search.inertia import mass_of

if TYPE_CHECKING:
    from lyapcheck.robots import RobotModel


def ranges_of(robot: RobotModel) -> tuple[Ends, ...]:
    """The range of each uncertain number, in the order in which polynomials have them."""
    return tuple(number.bounds for number in robot.parameters.values())


def mass_symmetric(robot: RobotModel) -> MassSymmetric:
    """M(q) = M(q)ᵀ."""
    return MassSymmetric(mass_of(robot), ranges_of(robot))


def coriolis_at_rest(robot: RobotModel) -> CoriolisAtRest:
    """C(q, 0) = 0, C by Christoffel symbols."""
    return CoriolisAtRest(mass_of(robot), ranges_of(robot), ())


def rate_of_mass(robot: RobotModel) -> RateOfMass:
    """Ṁ(q) = C(q, q̇) + C(q, q̇)ᵀ, and both are symmetric."""
    return RateOfMass(mass_of(robot), ranges_of(robot), ())


def rate_less_twice_coriolis(robot: RobotModel) -> RateLessTwiceCoriolis:
    """½ q̇ᵀ[Ṁ − 2C]q̇ = 0, and Ṁ − 2C is skew-symmetric."""
    return RateLessTwiceCoriolis(mass_of(robot), ranges_of(robot), ())
