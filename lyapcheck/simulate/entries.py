"""How large the entries of M and g and the Christoffel symbols of an arm can be, at any angles.

Each is a polynomial in sines and cosines; its Fourier sum is at most |mean| + Σ |other coefficients| in size.
"""

from __future__ import annotations

from fractions import Fraction
from itertools import product

from lyapcheck.check.fourier import Fourier
from lyapcheck.robots import RobotModel
from lyapcheck.robots.trig import evaluate_all

Row = tuple[Fraction, ...]


def mass_sizes(model: RobotModel) -> tuple[Row, ...]:
    """At least sup |M_ij(q)| for each entry, kg·m²; nominal parameters."""
    return tuple(tuple(map(_size, row)) for row in model.mass_at(*_circle(model.n), _lift))


def gravity_sizes(model: RobotModel) -> Row:
    """At least sup |g_i(q)|, N·m."""
    return tuple(map(_size, model.gravity_at(*_circle(model.n), _lift)))


def coriolis_squares(model: RobotModel) -> Row:
    """At least Σ_jk sup |c_ijk(q)|² for each i, so that |(C(q, x) y)_i| is at most its root times ‖x‖ ‖y‖."""
    values = model.point(*_circle(model.n), _lift)
    joints = range(model.n)
    rows = [
        [model.christoffel[i][j][k] for j, k in product(joints, joints) if model.christoffel[i][j][k] != 0]
        for i in joints
    ]
    sizes = [map(_size, evaluate_all(row, values, _lift)) for row in rows]
    return tuple(sum((size**2 for size in row), Fraction(0)) for row in sizes)


def _circle(n: int) -> tuple[list[Fourier], list[Fourier]]:
    half, zero = Fraction(1, 2), Fraction(0)
    angles = [f"q{i + 1}" for i in range(n)]
    sines = [Fourier({((q, 1),): (zero, -half), ((q, -1),): (zero, half)}) for q in angles]
    cosines = [Fourier({((q, 1),): (half, zero), ((q, -1),): (half, zero)}) for q in angles]
    return sines, cosines


def _lift(value: Fraction) -> Fourier:
    return Fourier({(): (value, Fraction(0))})


def _size(value: Fourier) -> Fraction:
    return abs(value.mean) + value.swing
