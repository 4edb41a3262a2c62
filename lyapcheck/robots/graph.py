"""The model as CasADi expressions."""

from __future__ import annotations

from collections.abc import Mapping
from fractions import Fraction

import casadi as ca

from lyapcheck.robots.chain import solve_definite
from lyapcheck.robots.plant import RobotModel

Parameters = Mapping[str, ca.SX] | None


def mass(model: RobotModel, q: ca.SX, parameters: Parameters = None) -> ca.SX:
    """M(q), (n, n) in kg·m², for a column q of joint angles in rad."""
    return matrix(model.at(*_circle(model, q), _lift, parameters).mass())


def coriolis(model: RobotModel, q: ca.SX, x: ca.SX, parameters: Parameters = None) -> ca.SX:
    """C(q, x) of the Christoffel symbols, (n, n) in kg·m²/s, for columns q in rad and x in rad/s."""
    rates = [x[i] for i in range(model.n)]
    return matrix(model.at(*_circle(model, q), _lift, parameters).coriolis(rates))


def gravity(model: RobotModel, q: ca.SX, parameters: Parameters = None) -> ca.SX:
    """g(q), (n, 1) in N·m."""
    result: ca.SX = ca.vertcat(*model.at(*_circle(model, q), _lift, parameters).gravity())
    return result


def potential(model: RobotModel, q: ca.SX, parameters: Parameters = None) -> ca.SX:
    """The potential energy, J."""
    result: ca.SX = model.at(*_circle(model, q), _lift, parameters).potential()
    return result


def viscous(model: RobotModel) -> ca.DM:
    """B, (n, n) in N·m·s/rad, at nominal values."""
    return ca.diag(ca.DM([float(number.value) for number in model.viscous]))


def solve(matrix: ca.SX, right: ca.SX) -> ca.SX:
    """x (n, 1) with matrix · x = right, for a symmetric positive definite matrix (n, n)."""
    rows = [ca.horzsplit(row) for row in ca.vertsplit(matrix)]
    result: ca.SX = ca.vertcat(*solve_definite(rows, ca.vertsplit(right)))
    return result


def _circle(model: RobotModel, q: ca.SX) -> tuple[list[ca.SX], list[ca.SX]]:
    joints = range(model.n)
    return [ca.sin(q[i]) for i in joints], [ca.cos(q[i]) for i in joints]


def _lift(value: Fraction) -> ca.SX:
    return ca.SX(float(value))


def matrix(rows: list[list[ca.SX]]) -> ca.SX:
    """The matrix of some rows."""
    return ca.vertcat(*[ca.horzcat(*row) for row in rows])
