"""The model in float64, many states at once."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from fractions import Fraction
from typing import Any

import numpy as np

from lyapcheck._types import Array
from lyapcheck.robots.plant import RobotModel

_BLOCK = 4096
"""States evaluated together: what they need then stays in the cache."""
Rows = list[Any]


class NumericModel:
    """M, C and g of an arm at many states at once, in float64.

    Args:
        model: the arm.
        parameters: exact values of uncertain parameters. Default: nominal.

    Soundness: rounded to nearest without bounds. Good for search and simulation, never for a verdict.
    """

    def __init__(self, model: RobotModel, parameters: Mapping[str, Fraction] | None = None) -> None:
        self._model = model.fixed(**dict(parameters or {}))
        self.n = model.n
        self.viscous: Array = np.array([float(number.value) for number in model.viscous])

    def mass(self, q: Array) -> Array:
        """M(q), kg·m²: (..., n) angles in rad to (..., n, n)."""
        return self._filled(lambda sin, cos: self._model.at(sin, cos, float).mass(), (self.n, self.n), q)

    def coriolis(self, q: Array, x: Array) -> Array:
        """C(q, x), kg·m²/s: (..., n) angles in rad and rates in rad/s to (..., n, n)."""

        def rows(sin: list[Any], cos: list[Any], *rates: Any) -> Rows:
            return self._model.at(sin, cos, float).coriolis(rates)

        return self._filled(rows, (self.n, self.n), *np.broadcast_arrays(q, x))

    def christoffel(self, q: Array) -> Array:
        """The Christoffel symbols c_ijk, kg·m²: (..., n) angles in rad to (..., n, n, n)."""
        return np.stack([self.coriolis(q, unit) for unit in np.eye(self.n)], axis=-1)

    def gravity(self, q: Array) -> Array:
        """g(q), N·m: (..., n) to (..., n)."""
        return self._filled(lambda sin, cos: self._model.at(sin, cos, float).gravity(), (self.n,), q)

    def potential(self, q: Array) -> Array:
        """The potential energy, J: (..., n) to (...)."""
        return self._filled(lambda sin, cos: self._model.at(sin, cos, float).potential(), (), q)

    def _filled(self, rows: Callable[..., Any], shape: tuple[int, ...], q: Array, *more: Array) -> Array:
        """What the rows give at all states, block by block."""
        flat, *others = (np.asarray(x, dtype=np.float64).reshape(-1, self.n).T for x in (q, *more))
        result = np.empty((*shape, flat.shape[1]))
        for start in range(0, flat.shape[1], _BLOCK):
            block = slice(start, start + _BLOCK)
            sin, cos = list(np.sin(flat[:, block])), list(np.cos(flat[:, block]))
            entries = rows(sin, cos, *(column for other in others for column in other[:, block]))
            for place in np.ndindex(shape):
                entry = entries
                for i in place:
                    entry = entry[i]
                result[(*place, block)] = entry
        return np.moveaxis(result, -1, 0).reshape((*np.shape(q)[:-1], *shape))
