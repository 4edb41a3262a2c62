"""Vectors and 3 × 3 matrices in any arithmetic, without the work that exact zeros and ones make.

An entry is an exact number, as a ``Fraction``, or a value of the arithmetic: a ball, an interval, a double,
an array of them, a polynomial, a node of a graph. Exact numbers stay exact until they meet a value.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from fractions import Fraction
from typing import Any

from flint import fmpq_mat

from lyapcheck.check.numbers.polynomials import rational

Entry = Any
Vector = Sequence[Entry]
Matrix = Sequence[Vector]
ZERO = Fraction(0)
LEVI_CIVITA = ((1, 2), (2, 0), (0, 1))
"""The rows j, k for which e_i = e_j × e_k."""


class Algebra:
    """Sums and products of entries, vectors (3,) and matrices (3, 3).

    Args:
        lift: turns an exact number into a value that contains it.
        tidy: brings a value into a form that stays short, such as the normal form of a polynomial.

    Soundness: with containing ``+``, ``-``, ``*`` and ``lift`` every result contains the exact one.
    """

    def __init__(
        self, lift: Callable[[Fraction], Entry], tidy: Callable[[Entry], Entry] | None = None
    ) -> None:
        self.lift = lift
        self._tidy = tidy

    def value(self, a: Entry) -> Entry:
        return self.lift(a) if isinstance(a, Fraction) else a

    def times(self, a: Entry, b: Entry) -> Entry:
        if isinstance(b, Fraction):
            a, b = b, a
        if not isinstance(a, Fraction) or isinstance(b, Fraction):
            return a * b
        if a == 0:
            return ZERO
        return b if a == 1 else -b if a == -1 else self.lift(a) * b

    def plus(self, a: Entry, b: Entry) -> Entry:
        if isinstance(a, Fraction) and isinstance(b, Fraction):
            return a + b
        if isinstance(a, Fraction):
            a, b = b, a
        if isinstance(b, Fraction):
            return a if b == 0 else a + self.lift(b)
        return a + b

    def minus(self, a: Entry, b: Entry) -> Entry:
        if isinstance(b, Fraction):
            return self.plus(a, -b)
        if isinstance(a, Fraction):
            return -b if a == 0 else self.lift(a) - b
        return a - b

    def dot(self, x: Vector, y: Vector) -> Entry:
        total: Entry = ZERO
        for a, b in zip(x, y, strict=True):
            total = self.plus(total, self.times(a, b))
        return total if self._tidy is None or isinstance(total, Fraction) else self._tidy(total)

    def cross(self, x: Vector, y: Vector) -> list[Entry]:
        return [self.minus(self.times(x[j], y[k]), self.times(x[k], y[j])) for j, k in LEVI_CIVITA]

    def add(self, *vectors: Vector) -> list[Entry]:
        total = list(vectors[0])
        for vector in vectors[1:]:
            total = [self.plus(a, b) for a, b in zip(total, vector, strict=True)]
        return total

    def scaled(self, factor: Entry, x: Vector) -> list[Entry]:
        return [self.times(factor, a) for a in x]

    def apply(self, a: Matrix, x: Vector) -> list[Entry]:
        return [self.dot(row, x) for row in a]

    def product(self, a: Matrix, b: Matrix) -> list[list[Entry]]:
        columns = transposed(b)
        return [[self.dot(row, column) for column in columns] for row in a]

    def congruent(self, a: Matrix, b: Matrix) -> list[list[Entry]]:
        return self.product(self.product(a, b), transposed(a))

    def outer(self, x: Vector, y: Vector) -> list[list[Entry]]:
        return [self.scaled(a, y) for a in x]

    def sum(self, *matrices: Matrix) -> list[list[Entry]]:
        return [self.add(*rows) for rows in zip(*matrices, strict=True)]

    def axial(self, a: Matrix) -> list[Entry]:
        """The t with tr([x]× A) = xᵀt for every x."""
        return [self.minus(a[j][k], a[k][j]) for j, k in LEVI_CIVITA]


def transposed(a: Matrix) -> list[list[Entry]]:
    """Aᵀ."""
    return [list(column) for column in zip(*a, strict=True)]


# --- Definiteness of symmetric rational matrices, decided by their characteristic polynomials.

Rows = Sequence[Sequence[Fraction | int]]


def is_positive_semidefinite(rows: Rows) -> bool:
    """Whether xᵀAx ≥ 0 for all x, for a symmetric A.

    Its eigenvalues are real, and the coefficients of det(λI + A) are the sums of their products. Where none
    of these is negative the polynomial has no positive root, and so A no negative eigenvalue.
    """
    n = len(rows)
    opposite = fmpq_mat(n, n, [rational(-Fraction(x)) for row in rows for x in row])
    return all(c >= 0 for c in opposite.charpoly().coeffs())
