"""How large the entries of M and g and the Christoffel symbols of an arm can be, at any angles.

Each is a polynomial in sines and cosines; its Fourier sum is at most |mean| + Σ |other coefficients| in size.
"""

from __future__ import annotations

from fractions import Fraction
from itertools import product

from lyapcheck.robots import RobotModel
from lyapcheck.robots.trig import evaluate_all, to_terms
from lyapcheck.simulate.fourier import Fourier, constant, cosine, sine, size

Row = tuple[Fraction, ...]


def mass_sizes(model: RobotModel) -> tuple[Row, ...]:
    """At least sup |M_ij(q)| for each entry, kg·m²; nominal parameters."""
    return tuple(tuple(map(size, row)) for row in model.mass_at(*_circle(model.n), constant))


def gravity_sizes(model: RobotModel) -> Row:
    """At least sup |g_i(q)|, N·m."""
    return tuple(map(size, model.gravity_at(*_circle(model.n), constant)))


def coriolis_squares(model: RobotModel) -> Row:
    """At least Σ_jk sup |c_ijk(q)|² for each i, so that |(C(q, x) y)_i| is at most its root times ‖x‖ ‖y‖."""
    values, joints = [x for part in _circle(model.n) for x in part], range(model.n)
    values += [constant(number.value) for number in model.parameters.values()]
    rows = [[to_terms(model.christoffel[i][j][k]) for j, k in product(joints, joints)] for i in joints]
    sizes = [map(size, evaluate_all(row, values, constant)) for row in rows]
    return tuple(sum((size**2 for size in row), Fraction(0)) for row in sizes)


def _circle(n: int) -> tuple[list[Fourier], list[Fourier]]:
    angles = [f"q{i + 1}" for i in range(n)]
    return [sine(q) for q in angles], [cosine(q) for q in angles]
