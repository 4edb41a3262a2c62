"""Matrices of exact rationals as NumPy arrays of objects."""

from __future__ import annotations

from collections.abc import Iterable
from fractions import Fraction
from typing import Any

import numpy as np
from flint import fmpq
from numpy.typing import NDArray

Exact = NDArray[Any]
"""Entries are fmpq."""


def exact(rows: Iterable[Iterable[Fraction | int]]) -> Exact:
    """The matrix with these entries."""
    return np.array([[_fmpq(Fraction(x)) for x in row] for row in rows], dtype=object)


def zeros(rows: int, columns: int) -> Exact:
    """Nothing but zeros."""
    return exact([[0] * columns] * rows)


def unit(n: int) -> Exact:
    """The unit matrix."""
    return exact([[int(i == k) for k in range(n)] for i in range(n)])


def cross(a: Exact) -> Exact:
    """The matrix of a × ·."""
    zero = fmpq(0)
    x, y, z = a
    return np.array([[zero, -z, y], [z, zero, -x], [-y, x, zero]], dtype=object)


def rounded(matrix: Exact) -> NDArray[np.float64]:
    """The nearest doubles."""
    return matrix.astype(np.float64)


def _fmpq(value: Fraction) -> fmpq:
    return fmpq(value.numerator, value.denominator)
