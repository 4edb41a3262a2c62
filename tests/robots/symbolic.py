"""The model as SymPy expressions with exact rational coefficients."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from fractions import Fraction

import sympy as sp

from lyapcheck.robots.plant import Plant

Parameters = Mapping[str, sp.Expr] | None


def mass(model: Plant, q: Sequence[sp.Expr], parameters: Parameters = None) -> sp.Matrix:
    """M(q), (n, n) in kg·m², for n joint angles."""
    return sp.Matrix(model.mass_at(*_circle(q), _lift, parameters))


def coriolis(
    model: Plant, q: Sequence[sp.Expr], x: Sequence[sp.Expr], parameters: Parameters = None
) -> sp.Matrix:
    """C(q, x) of the Christoffel symbols, (n, n) in kg·m²/s, for n angles and n rates."""
    return sp.Matrix(model.coriolis_at(*_circle(q), list(x), _lift, parameters))


def gravity(model: Plant, q: Sequence[sp.Expr], parameters: Parameters = None) -> sp.Matrix:
    """g(q), (n, 1) in N·m."""
    return sp.Matrix(model.gravity_at(*_circle(q), _lift, parameters))


def potential(model: Plant, q: Sequence[sp.Expr], parameters: Parameters = None) -> sp.Expr:
    """The potential energy, J."""
    return model.potential_at(*_circle(q), _lift, parameters)


def viscous(model: Plant) -> sp.Matrix:
    """B, (n, n) in N·m·s/rad, at nominal values."""
    return sp.diag(*[_lift(number.value) for number in model.viscous])


def _circle(q: Sequence[sp.Expr]) -> tuple[list[sp.Expr], list[sp.Expr]]:
    return [sp.sin(angle) for angle in q], [sp.cos(angle) for angle in q]


def _lift(value: Fraction) -> sp.Rational:
    return sp.Rational(value.numerator, value.denominator)
