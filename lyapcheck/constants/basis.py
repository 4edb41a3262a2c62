"""The functions of which polynomials are sums, at many states: cosines and sines of sums of angles."""

from __future__ import annotations

from collections.abc import Sequence
from fractions import Fraction
from itertools import product

import numpy as np
from numpy.typing import NDArray

from lyapcheck._types import Array
from lyapcheck.check.numbers.harmonics import Harmonics

Rows = list[dict[int, Fraction]]


def basis_of(entries: Sequence[Harmonics], n: int) -> tuple[Sums, Rows]:
    """A basis for some polynomials, and each of them as its numbers by the row of the function."""
    sums = [{(k, odd): x for k, ab in entry.items() for odd, x in enumerate(ab) if x} for entry in entries]
    keys = sorted({key for entry in sums for key in entry}) or [((0,) * n, 0)]
    places = {key: row for row, key in enumerate(keys)}
    rows_of = [{places[key]: x for key, x in entry.items()} for entry in sums]
    sizes = np.zeros(len(keys))
    for entry_rows in rows_of:
        for row, x in entry_rows.items():
            sizes[row] += abs(float(x))
    multiples, back = _sheared(np.array([k for k, _ in keys], dtype=np.float64), sizes)
    return Sums(multiples, np.array([sine for _, sine in keys]) > 0, back), rows_of


def _sheared(multiples: Array, sizes: Array) -> tuple[Array, Array]:
    """Multiples of the coordinates q_i ± q_{i+1} in place of q_{i+1}, wherever the sums get shorter by that.

    On a torus such a change of coordinates is one to one.
    """
    n = multiples.shape[1]
    back = np.eye(n)
    for i, sign in product(range(n - 1), (-1.0, 1.0)):
        other = multiples.copy()
        other[:, i] += sign * multiples[:, i + 1]
        if sizes @ np.abs(other[:, i]) < 0.9 * (sizes @ np.abs(multiples[:, i])):
            shear = np.eye(n)
            shear[i + 1, i] = sign
            multiples, back = other, back @ shear
    return multiples, back


class Sums:
    """cos(k·p) and sin(k·p) of coordinates p with q = back p, where back is whole and of determinant ±1.

    ``frequency`` bounds how fast each turns with each coordinate, (functions, n).
    """

    def __init__(self, multiples: Array, sine: NDArray[np.bool_], back: Array) -> None:
        self.multiples, self.sine, self.back = multiples, sine, back
        self.frequency: Array = np.abs(multiples)

    def at(self, p: Array) -> SumsAt:
        """The functions at coordinates (count, n)."""
        return SumsAt(self, p @ self.multiples.T)


class SumsAt:
    """The functions at some states."""

    def __init__(self, basis: Sums, angle: Array) -> None:
        sine, cosine = np.sin(angle), np.cos(angle)
        self.values: Array = np.where(basis.sine, sine, cosine)
        self._turned = np.where(basis.sine, cosine, -sine)
        self._multiples = basis.multiples

    def bent(self, turn: Array) -> tuple[Array, Array]:
        """Middle and radius of what the functions are beyond their linear part, where they turn that far.

        v cos d + u sin d at the distance d, v itself and u its slope: what is left of it without u d.

        Args:
            turn: how far at most in rad, not above π; one number a function.
        """
        least = np.cos(turn)
        radius = np.abs(self.values) * 0.5 * (1 - least) + np.abs(self._turned) * (turn - np.sin(turn))
        return self.values * 0.5 * (1 + least), radius

    def slopes(self, i: int) -> Array:
        """Their derivatives with respect to the i-th coordinate."""
        return np.asarray(self._turned * self._multiples[:, i])
