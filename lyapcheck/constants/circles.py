"""Matrices whose entries are trigonometric polynomials of degree 2 in each of some angles, on grids.

With 1, cos, sin, cos 2·, sin 2· of each angle such a polynomial is one array of coefficients, that five
equally spaced angles a circle determine. On a grid one angle after the other is put in: that is cheap.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from lyapcheck._types import Array

TERMS = 5
NODES = 2 * np.pi * np.arange(TERMS) / TERMS
_SQUARES = np.array([0.0, 1.0, 1.0, 4.0, 4.0])
_CONSTANT = 1e-12
"""Times the size of the matrices: what an angle that changes less than this changes is left to rounding."""
_BLOCK = 100_000
"""Doubles that are held at a time."""


def basis(angles: Array) -> Array:
    """1, cos, sin, cos 2·, sin 2· of angles, (..., 5)."""
    a = np.asarray(angles)
    return np.stack([np.ones_like(a), np.cos(a), np.sin(a), np.cos(2 * a), np.sin(2 * a)], axis=-1)


_FROM_NODES: Array = np.asarray(np.linalg.inv(basis(NODES)), dtype=np.float64)


@dataclass(frozen=True, eq=False)
class Circles:
    """A matrix (rows, columns) of such polynomials.

    Args:
        coefficients: one axis of five an angle, then rows and columns.
        angles: which of the arm's angles these are, counted from 0; it does not depend on the others.
        size: the largest Frobenius norm at a node.
    """

    coefficients: Array
    angles: tuple[int, ...]
    size: float

    @classmethod
    def through(cls, value: Callable[[Array], Array], n: int) -> Circles:
        """The polynomials with these values, matrices (count, rows, columns) at postures (count, n).

        The first of the n angles must not matter.
        """
        grid = np.stack(np.meshgrid(*[NODES] * (n - 1), indexing="ij"), axis=-1).reshape(-1, n - 1)
        values = value(np.pad(grid, ((0, 0), (1, 0))))
        size = float(np.sqrt(np.max(np.sum(values**2, axis=(1, 2)))))
        result = values.reshape((TERMS,) * (n - 1) + values.shape[1:])
        for axis in range(n - 1):
            result = _put(_FROM_NODES, result, axis)
        kept = tuple(range(1, n))
        for angle in reversed(range(1, n)):
            moved = np.moveaxis(result, angle - 1, 0)
            if np.sqrt(np.sum(moved[1:] ** 2)) <= _CONSTANT * size:
                result, kept = moved[0], tuple(k for k in kept if k != angle)
        return cls(result, kept, size)

    def bent(self, axis: int) -> Circles:
        """The second derivatives by one of the angles."""
        shape = [1] * self.coefficients.ndim
        shape[axis] = TERMS
        return replace(self, coefficients=-self.coefficients * _SQUARES.reshape(shape))

    def spread(self, half: Array) -> Circles:
        """(1 − ½ r_k² ∂²/∂q_k²) of them for all angles, given the r_k."""
        coefficients = self.coefficients
        for axis, growth in enumerate(1 + 0.5 * np.multiply.outer(np.asarray(half) ** 2, _SQUARES)):
            shape = [1] * coefficients.ndim
            shape[axis] = TERMS
            coefficients = coefficients * growth.reshape(shape)
        return replace(self, coefficients=coefficients)

    def times(self, factor: Array) -> Circles:
        """The product with a matrix (columns, columns), whose values are as exact as those of the factors."""
        return replace(self, coefficients=self.coefficients @ factor)

    def on(self, first: Array, counts: Sequence[int]) -> Iterator[tuple[NDArray[np.intp], Array]]:
        """Values at all points of grids over the last angles, for some values of the first ones.

        Args:
            first: rad, (count, angles that are not the last).
            counts: of equally spaced points from 0 on, one for each of the last angles.

        Yields:
            Some places in ``first``, and for each all values of its grid, (places, points, rows, columns).
        """
        grids = [basis(2 * np.pi * np.arange(count) / count) for count in counts]
        for places, part in _at(self.coefficients, first, np.arange(len(first))):
            points = int(np.prod(np.maximum(counts, TERMS))) if counts else 1
            block = max(1, _BLOCK // (points * part.shape[-1] * part.shape[-2]))
            weights, flat = basis(first[places, -1]), part.reshape(TERMS, -1)
            for start in range(0, len(places), block):
                chosen = places[start : start + block]
                result, rows = weights[start : start + block] @ flat, len(chosen)
                for grid in grids:
                    result = grid @ result.reshape(rows, TERMS, -1)
                    rows *= len(grid)
                yield chosen, result.reshape(len(chosen), -1, *part.shape[-2:])


def _at(tensor: Array, first: Array, places: NDArray[np.intp]) -> Iterator[tuple[NDArray[np.intp], Array]]:
    """Places with the same angles but for the last one, and the tensor at those angles."""
    if first.shape[1] == 1:
        yield places, tensor
        return
    for value in np.unique(first[:, 0]):
        same = first[:, 0] == value
        yield from _at(np.tensordot(basis(value), tensor, 1), first[same, 1:], places[same])


def _put(matrix: Array, tensor: Array, axis: int) -> Array:
    """One axis of a tensor multiplied by a matrix."""
    return np.moveaxis(np.tensordot(matrix, tensor, (1, axis)), 0, axis)
