"""The model as CasADi expressions."""

from __future__ import annotations

from collections.abc import Mapping
from fractions import Fraction

import casadi as ca

from lyapcheck.robots.model import RobotModel

Parameters = Mapping[str, ca.SX] | None


def mass(model: RobotModel, q: ca.SX, parameters: Parameters = None) -> ca.SX:
    """M(q), (n, n) in kg·m², for a column q of joint angles in rad."""
    return _matrix(model.mass_at(*_circle(model, q), _lift, parameters))


def coriolis(model: RobotModel, q: ca.SX, x: ca.SX, parameters: Parameters = None) -> ca.SX:
    """C(q, x) of the Christoffel symbols, (n, n) in kg·m²/s, for columns q in rad and x in rad/s."""
    rates = [x[i] for i in range(model.n)]
    return _matrix(model.coriolis_at(*_circle(model, q), rates, _lift, parameters))


def gravity(model: RobotModel, q: ca.SX, parameters: Parameters = None) -> ca.SX:
    """g(q), (n, 1) in N·m."""
    return ca.vertcat(*model.gravity_at(*_circle(model, q), _lift, parameters))


def potential(model: RobotModel, q: ca.SX, parameters: Parameters = None) -> ca.SX:
    """The potential energy, J."""
    return model.potential_at(*_circle(model, q), _lift, parameters)


def viscous(model: RobotModel) -> ca.DM:
    """B, (n, n) in N·m·s/rad, at nominal values."""
    return ca.diag(ca.DM([float(number.value) for number in model.viscous]))


def _circle(model: RobotModel, q: ca.SX) -> tuple[list[ca.SX], list[ca.SX]]:
    joints = range(model.n)
    return [ca.sin(q[i]) for i in joints], [ca.cos(q[i]) for i in joints]


def _lift(value: Fraction) -> ca.SX:
    return ca.SX(float(value))


def _matrix(rows: list[list[ca.SX]]) -> ca.SX:
    return ca.vertcat(*[ca.horzcat(*row) for row in rows])
