"""The model in float64, batched: one monomial table and one matrix product for any number of states."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from fractions import Fraction

import numpy as np
from flint import fmpq_mpoly
from numpy.typing import NDArray

from lyapcheck.robots import trig
from lyapcheck.robots.model import RobotModel

Array = NDArray[np.float64]
_BLOCK = 4096
"""States evaluated together: the monomial table of a small arm then stays in the cache."""


class NumericModel:
    """M, C and g of an arm at many states at once, in float64.

    Args:
        model: the arm.
        parameters: exact values of uncertain parameters; nominal where not given.

    Soundness: rounded to nearest without bounds; good for search and simulation, never for a verdict.
    """

    def __init__(self, model: RobotModel, parameters: Mapping[str, Fraction] | None = None) -> None:
        fixed = model.fixed(**dict(parameters or {}))
        n = self.n = fixed.n
        self.viscous: Array = np.array([float(number.value) for number in fixed.viscous])
        self._mass = _Table([fixed.mass[i][j] for i in range(n) for j in range(n)], n)
        symbols = [fixed.christoffel[i][j][k] for i in range(n) for j in range(n) for k in range(n)]
        self._christoffel = _Table(symbols, n)
        self._gravity = _Table([*fixed.gravity], n)
        self._potential = _Table([fixed.potential], n)

    def mass(self, q: Array) -> Array:
        """M(q), kg·m²: (..., n) angles in rad to (..., n, n)."""
        return self._mass(q).reshape(*q.shape, self.n)

    def christoffel(self, q: Array) -> Array:
        """The Christoffel symbols c_ijk, kg·m²: (..., n) angles in rad to (..., n, n, n)."""
        return self._christoffel(q).reshape(*q.shape, self.n, self.n)

    def coriolis(self, q: Array, x: Array) -> Array:
        """C(q, x), kg·m²/s: (..., n) angles in rad and rates in rad/s to (..., n, n)."""
        result: Array = np.matmul(self.christoffel(q), x[..., None, :, None])[..., 0]
        return result

    def gravity(self, q: Array) -> Array:
        """g(q), N·m: (..., n) to (..., n)."""
        return self._gravity(q)

    def potential(self, q: Array) -> Array:
        """The potential energy, J: (..., n) to (...)."""
        return self._potential(q)[..., 0]


class _Table:
    """Polynomials as one coefficient matrix over their shared monomials."""

    def __init__(self, polys: Sequence[fmpq_mpoly], n: int) -> None:
        self.n = n
        self.steps: list[tuple[int, int]] = []
        self._rows: dict[tuple[int, ...], int] = {(0,) * (2 * n): 0}
        entries = [
            (self._row(powers), column, value)
            for column, poly in enumerate(polys)
            for powers, value in poly.terms()
        ]
        self.coefficients = np.zeros((len(self._rows), len(polys)))
        for row, column, value in entries:
            self.coefficients[row, column] = float(trig.fraction(value))

    def _row(self, powers: Sequence[int]) -> int:
        """The row of a monomial; new ones are one generator times an earlier row."""
        key = tuple(int(power) for power in powers)
        if key not in self._rows:
            last = max(i for i, power in enumerate(key) if power)
            parent = self._row((*key[:last], key[last] - 1, *key[last + 1 :]))
            self._rows[key] = len(self._rows)
            self.steps.append((parent, last))
        return self._rows[key]

    def __call__(self, q: Array) -> Array:
        angles = np.asarray(q, dtype=np.float64)
        flat = angles.reshape(-1, self.n)
        result = np.empty((len(flat), self.coefficients.shape[1]))
        for start in range(0, len(flat), _BLOCK):
            result[start : start + _BLOCK] = self._block(flat[start : start + _BLOCK])
        return result.reshape(*angles.shape[:-1], -1)

    def _block(self, q: Array) -> Array:
        generators = np.concatenate([np.sin(q.T), np.cos(q.T)])
        monomials = np.empty((len(self._rows), len(q)))
        monomials[0] = 1.0
        for row, (parent, generator) in enumerate(self.steps, start=1):
            np.multiply(monomials[parent], generators[generator], out=monomials[row])
        product: Array = monomials.T @ self.coefficients
        return product
