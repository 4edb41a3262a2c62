"""The matrices of a robot as expressions for a proof script."""

from __future__ import annotations

from collections.abc import Sequence
from fractions import Fraction
from typing import TYPE_CHECKING

from lyapcheck.claims.case import lacking
from lyapcheck.claims.expressions import Expr, cos, diff, expr, sin, total, var
from lyapcheck.claims.products import Matrix, Vector, vector
from lyapcheck.control import arm_limits

if TYPE_CHECKING:
    from lyapcheck.robots import RobotModel
    from lyapcheck.robots.dynamics import ArmAtAngles


def mass_matrix(robot: RobotModel) -> Matrix:
    """M(q) in the variables q1, …, qn and the uncertain numbers of the robot by name."""
    return _place(robot).mass()


def coriolis_matrix(robot: RobotModel, x: Sequence[Expr]) -> Matrix:
    """C(q, x) of the Christoffel symbols."""
    return _place(robot).coriolis(x)


def gravity_vector(robot: RobotModel) -> Vector:
    """g(q)."""
    return _place(robot).gravity()


def rate_of(a: Matrix, w: Sequence[Expr]) -> Matrix:
    """dA(q)/dt along q̇ = w."""
    return [[total(diff(entry, f"q{k + 1}") * w[k] for k in range(len(w))) for entry in row] for row in a]


def _place(robot: RobotModel) -> ArmAtAngles:
    """The polynomials, written out, at the angles q1, …, qn."""
    q = vector("q", robot.n)
    sines, cosines = [sin(angle) for angle in q], [cos(angle) for angle in q]
    parameters = {name: var(name) for name in robot.parameters}
    return robot.dynamics.polynomials.at(sines, cosines, parameters, expr)


def torque_limits(robot: RobotModel) -> list[Fraction]:
    """τmax of each joint, N·m; of one with a range the least.

    Raises:
        Lacking: the robot has none for some joint.
    """
    result = [number.bounds[0] for number in robot.torque_limit if number is not None]
    if len(result) < robot.n:
        raise lacking("needs a torque limit for every joint; add it to the arm file")
    return result


def gravity_bounds(robot: RobotModel) -> list[Fraction]:
    """k_gi of each joint for all values of the ranges, N·m: printed by the source, else computed."""
    return list(arm_limits.gravity_bounds(robot))
