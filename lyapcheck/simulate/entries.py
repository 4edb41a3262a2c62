"""How large the entries of M and g and the Christoffel symbols of an arm can be, at any angles.

Each is a sum of harmonics a cos(k·q) + b sin(k·q), and at most Σ (a² + b²)^½ in size.
"""

from __future__ import annotations

from fractions import Fraction

from flint import fmpq_mpoly

from lyapcheck.check.numbers.enclosure import root_above
from lyapcheck.check.numbers.harmonics import harmonics
from lyapcheck.robots.plant import Plant
from lyapcheck.robots.trig import to_terms

Row = tuple[Fraction, ...]


def mass_sizes(model: Plant) -> tuple[Row, ...]:
    """At least sup |M_ij(q)| for each entry, (n, n), kg·m²; nominal parameters."""
    return tuple(tuple(_size(entry, model.n) for entry in row) for row in model.fixed().mass)


def gravity_sizes(model: Plant) -> Row:
    """At least sup |g_i(q)|, (n,), N·m."""
    return tuple(_size(entry, model.n) for entry in model.fixed().gravity)


def coriolis_squares(model: Plant) -> Row:
    """At least Σ_jk sup |c_ijk(q)|² for each i, so that |(C(q, x) y)_i| is at most its root times ‖x‖ ‖y‖."""
    symbols = model.fixed().christoffel
    return tuple(
        sum((_size(entry, model.n) ** 2 for row in layer for entry in row), Fraction(0)) for layer in symbols
    )


def _size(poly: fmpq_mpoly, n: int) -> Fraction:
    pairs = harmonics(to_terms(poly), n).values()
    return sum(
        (max(abs(a), abs(b)) if not a or not b else root_above(a * a + b * b) for a, b in pairs), Fraction(0)
    )
