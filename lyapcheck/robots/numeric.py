"""The model in float64, batched: one table of shared monomials and one matrix product for many states."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from fractions import Fraction
from itertools import product
from typing import Any

import numpy as np
from flint import fmpq_mpoly

from lyapcheck._types import Array
from lyapcheck.robots import trig
from lyapcheck.robots.model import RobotModel

_SPARSE = 50_000
"""Entries from which on a coefficient matrix is kept without its zeros."""
_BLOCK = 4096
"""States evaluated together: the monomials of a small arm then stay in the cache."""


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
        pairs, triples = product(range(n), repeat=2), product(range(n), repeat=3)
        self._mass = _Table({(i, j): fixed.mass[i][j] for i, j in pairs}, n)
        self._christoffel = _Table({(i, j, k): fixed.christoffel[i][j][k] for i, j, k in triples}, n)
        self._gravity = _Table({(i,): fixed.gravity[i] for i in range(n)}, n)
        self._potential = _Table({(): fixed.potential}, n)

    def mass(self, q: Array) -> Array:
        """M(q), kg·m²: (..., n) angles in rad to (..., n, n)."""
        return self._filled(self._mass, q, (self.n, self.n))

    def christoffel(self, q: Array) -> Array:
        """The Christoffel symbols c_ijk, kg·m²: (..., n) angles in rad to (..., n, n, n)."""
        return self._filled(self._christoffel, q, (self.n,) * 3)

    def coriolis(self, q: Array, x: Array) -> Array:
        """C(q, x), kg·m²/s: (..., n) angles in rad and rates in rad/s to (..., n, n)."""
        angles, rates = (np.asarray(a, dtype=np.float64) for a in np.broadcast_arrays(q, x))
        flat, flat_rates = angles.reshape(-1, self.n), rates.reshape(-1, self.n)
        result = np.zeros((len(flat), self.n, self.n))
        for block in _blocks(len(flat)):
            columns, speed = self._christoffel.values(flat[block]), flat_rates[block].T
            for (i, j, k), column in self._christoffel.places.items():
                result[block, i, j] += columns[column] * speed[k]
        return result.reshape(*angles.shape, self.n)

    def gravity(self, q: Array) -> Array:
        """g(q), N·m: (..., n) to (..., n)."""
        return self._filled(self._gravity, q, (self.n,))

    def potential(self, q: Array) -> Array:
        """The potential energy, J: (..., n) to (...)."""
        return self._filled(self._potential, q, ())

    def _filled(self, table: _Table, q: Array, shape: tuple[int, ...]) -> Array:
        """All entries of the table at all states, those that vanish identically left at 0."""
        angles = np.asarray(q, dtype=np.float64)
        flat = angles.reshape(-1, self.n)
        result = np.zeros((len(flat), *shape))
        for block in _blocks(len(flat)):
            columns = table.values(flat[block])
            for place, column in table.places.items():
                index: Any = (block, *place)
                result[index] = columns[column]
        return result.reshape((*angles.shape[:-1], *shape))


class _Table:
    """Polynomials by place, as one coefficient matrix over their shared monomials."""

    def __init__(self, polys: Mapping[tuple[int, ...], fmpq_mpoly], n: int) -> None:
        nonzero = {place: tuple(trig.to_terms(poly)) for place, poly in polys.items() if poly != 0}
        distinct = list(dict.fromkeys(nonzero.values()))
        self.places = {place: distinct.index(terms) for place, terms in nonzero.items()}
        self._steps: list[tuple[int, int]] = []
        self._rows: dict[tuple[int, ...], int] = {(0,) * (2 * n): 0}
        terms = [(i, self._row(powers), c) for i, poly in enumerate(distinct) for powers, c in poly]
        dense = np.zeros((len(distinct), len(self._rows)))
        for i, row, coefficient in terms:
            dense[i, row] = float(coefficient)
        self._coefficients: Any = dense if dense.size < _SPARSE else _sparse(dense)

    def values(self, q: Array) -> Array:
        """The distinct polynomials, (count, states), at (states, n) angles."""
        generators = np.concatenate([np.sin(q.T), np.cos(q.T)])
        monomials = np.empty((len(self._rows), len(q)))
        monomials[0] = 1.0
        for row, (parent, generator) in enumerate(self._steps, start=1):
            np.multiply(monomials[parent], generators[generator], out=monomials[row])
        result: Array = self._coefficients @ monomials
        return result

    def _row(self, powers: Sequence[int]) -> int:
        """The row of a monomial; a new one is an earlier row times one generator."""
        key = tuple(powers)
        if key not in self._rows:
            last = max(i for i, power in enumerate(key) if power)
            parent = self._row((*key[:last], key[last] - 1, *key[last + 1 :]))
            self._rows[key] = len(self._rows)
            self._steps.append((parent, last))
        return self._rows[key]


def _sparse(dense: Array) -> Any:
    """The same matrix without its zeros: of six and seven joints nearly all of it."""
    from scipy.sparse import csr_array

    return csr_array(dense)


def _blocks(count: int) -> list[slice]:
    return [slice(start, start + _BLOCK) for start in range(0, count, _BLOCK)]
