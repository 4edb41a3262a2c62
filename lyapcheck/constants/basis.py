"""The functions of which polynomials are sums, at many states: products a joint, or sines of sums of angles.

For parallel axes the sines and cosines of sums k·q are fewer and do not lose that the angles add up; for a
general arm the products are far fewer.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from fractions import Fraction
from itertools import product
from typing import Protocol

import numpy as np
from numpy.typing import NDArray

from lyapcheck._types import Array
from lyapcheck.constants.harmonics import Harmonic

Rows = list[dict[int, Fraction]]
_MOST_SUMS = 20_000


class Values(Protocol):
    """The functions at some states."""

    values: Array

    def bent(self, turn: Array) -> tuple[Array, Array]:
        """Middle and radius of what the functions are beyond their linear part, where they turn that far.

        Args:
            turn: how far at most in rad, not above π; one number a function.
        """

    def slopes(self, i: int) -> Array:
        """Their derivatives with respect to q_i."""


class Basis(Protocol):
    """Functions of coordinates p with q = back p, where back is whole and of determinant ±1.

    ``frequency`` bounds how fast each turns with each coordinate, (functions, n).
    """

    frequency: Array
    back: Array

    def at(self, p: Array) -> Values:
        """The functions at coordinates (count, n)."""


def basis_of(entries: Sequence[Mapping[Harmonic, Fraction]], n: int) -> tuple[Basis, Rows]:
    """A basis for some polynomials, and each of them as its numbers by the row of the function."""
    result = sorted({wave for entry in entries for wave in entry}) or [(0,) * n]
    if sum(2 ** sum(factor > 0 for factor in wave) for wave in result) > _MOST_SUMS:
        rows = {wave: row for row, wave in enumerate(result)}
        return Products(np.array(result, dtype=np.intp)), [
            {rows[w]: x for w, x in e.items()} for e in entries
        ]
    sums = [_sums(entry, n) for entry in entries]
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
    """cos(k·p) and sin(k·p)."""

    def __init__(self, multiples: Array, sine: NDArray[np.bool_], back: Array) -> None:
        self.multiples, self.sine, self.back = multiples, sine, back
        self.frequency: Array = np.abs(multiples)

    def at(self, p: Array) -> Values:
        """The functions at coordinates (count, n)."""
        return _SumsAt(self, p @ self.multiples.T)


class _SumsAt:
    def __init__(self, basis: Sums, angle: Array) -> None:
        sine, cosine = np.sin(angle), np.cos(angle)
        self.values: Array = np.where(basis.sine, sine, cosine)
        self._turned = np.where(basis.sine, cosine, -sine)
        self._multiples = basis.multiples

    def bent(self, turn: Array) -> tuple[Array, Array]:
        """v cos d + u sin d at the distance d, v itself and u its slope: what is left of it without u d."""
        least = np.cos(turn)
        radius = np.abs(self.values) * 0.5 * (1 - least) + np.abs(self._turned) * (turn - np.sin(turn))
        return self.values * 0.5 * (1 + least), radius

    def slopes(self, i: int) -> Array:
        return np.asarray(self._turned * self._multiples[:, i])


class Products:
    """Products of one factor a joint."""

    def __init__(self, harmonics: NDArray[np.intp]) -> None:
        self.harmonics = harmonics
        self.frequency: Array = ((harmonics + 1) // 2).astype(np.float64)
        self.back: Array = np.eye(harmonics.shape[1])

    def at(self, p: Array) -> Values:
        """The functions at coordinates (count, n)."""
        return _ProductsAt(self.harmonics, p)


class _ProductsAt:
    def __init__(self, harmonics: NDArray[np.intp], q: Array) -> None:
        self._harmonics, n = harmonics, q.shape[1]
        self._basis = _factors(q, int(harmonics.max()))
        self._factors = [self._basis[harmonics[:, i], :, i].T for i in range(n)]
        self.values: Array = np.prod(self._factors, axis=0)

    def bent(self, turn: Array) -> tuple[Array, Array]:
        """Along any line the second derivative is at most the square of the frequency."""
        return self.values, 0.5 * turn * turn

    def slopes(self, i: int) -> Array:
        basis = self._basis[:, :, i]
        codes = np.arange(len(basis))
        turned = np.where(codes % 2, np.minimum(codes + 1, len(basis) - 1), np.maximum(codes - 1, 0))
        sign = np.where(codes % 2, 1.0, -1.0) * ((codes + 1) // 2)
        slope = (basis[turned] * sign[:, None])[self._harmonics[:, i]].T
        others = [factor for j, factor in enumerate(self._factors) if j != i]
        return np.asarray(slope * np.prod(others, axis=0) if others else slope)


def _factors(q: Array, last: int) -> Array:
    """1, sin q, cos q, sin 2q, cos 2q …, up to at least the factor ``last`` and always to a cosine."""
    rows = [np.ones_like(q)]
    for k in range(1, (last + 1) // 2 + 1):
        rows += [np.sin(k * q), np.cos(k * q)]
    return np.stack(rows)


def _sums(entry: Mapping[Harmonic, Fraction], n: int) -> dict[tuple[Harmonic, int], Fraction]:
    """The polynomial in cos(k·q), marked 0, and sin(k·q), marked 1; each k leads with a positive entry."""
    total: dict[tuple[Harmonic, int], Fraction] = {}
    for wave, value in entry.items():
        partial: dict[tuple[Harmonic, int], Fraction] = {((0,) * n, 0): value}
        for i, factor in enumerate(wave):
            if factor:
                partial = _times(partial, i, (factor + 1) // 2, factor % 2 == 1)
        for key, x in partial.items():
            total[key] = total.get(key, Fraction(0)) + x
    return {key: x for key, x in total.items() if x}


def _times(
    terms: Mapping[tuple[Harmonic, int], Fraction], i: int, k: int, sine: bool
) -> dict[tuple[Harmonic, int], Fraction]:
    """The product with sin(k q_i) or cos(k q_i), i beyond all angles so far: the sum and the difference."""
    result: dict[tuple[Harmonic, int], Fraction] = {}
    for (multiples, odd), x in terms.items():
        for step, sign in ((k, 1), (-k, -1)):
            place = (*multiples[:i], step, *multiples[i + 1 :])
            # cos a cos b and sin a cos b keep the kind; cos a sin b = ½(sin(a+b) − sin(a−b));
            # sin a sin b = ½(cos(a−b) − cos(a+b))
            kind = odd ^ int(sine)
            number = x / 2 * (1 if not sine else (-sign if odd else sign))
            if not any(multiples) and step < 0:
                place, number = (*multiples[:i], k, *multiples[i + 1 :]), (-number if kind else number)
            result[place, kind] = result.get((place, kind), Fraction(0)) + number
    return {key: x for key, x in result.items() if x}
