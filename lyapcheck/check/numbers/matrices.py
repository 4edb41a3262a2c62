"""Positive definiteness of symmetric matrices: decided over ℚ by LDLᵀ, proved or left open in balls."""

from __future__ import annotations

from collections.abc import Sequence
from fractions import Fraction
from typing import TypeAlias

from flint import arb, fmpq, fmpq_mat

Rows: TypeAlias = Sequence[Sequence[Fraction | int]] | fmpq_mat


def pivots(rows: Rows) -> list[Fraction] | None:
    """The diagonal d of A = L diag(d) Lᵀ, exactly, for a symmetric rational A.

    A zero pivot is passed over when the rest of its column is zero; otherwise A is indefinite there (a 2×2
    minor is negative) and the answer is ``None``. By Sylvester's law of inertia the signs of d are the signs
    of the eigenvalues.

    Raises:
        ValueError: the matrix is not square or not symmetric.

    References: ``golub2013matrix``, section 4.1.
    """
    work = symmetric(rows)
    found: list[Fraction] = []
    for k in range(len(work)):
        pivot = work[k][k]
        if pivot == 0 and any(work[i][k] != 0 for i in range(k + 1, len(work))):
            return None
        found.append(pivot)
        if pivot != 0:
            _eliminate(work, k)
    return found


def is_positive_definite(rows: Rows) -> bool:
    """Decide xᵀAx > 0 for every x ≠ 0: all pivots are positive. The empty matrix is positive definite."""
    found = pivots(rows)
    return found is not None and all(pivot > 0 for pivot in found)


def is_positive_semidefinite(rows: Rows) -> bool:
    """Decide xᵀAx ≥ 0 for every x: no pivot is negative, and none is zero above something else."""
    found = pivots(rows)
    return found is not None and all(pivot >= 0 for pivot in found)


def negative_direction(rows: Rows) -> list[Fraction] | None:
    """A rational x with xᵀAx < 0, or ``None`` when A is positive semidefinite.

    The witness that a matrix is not positive semidefinite; anyone can replay it with one product.
    """
    a = symmetric(rows)
    n = len(a)
    basis = [[Fraction(int(i == j)) for j in range(n)] for i in range(n)]
    while basis:
        for x in basis:
            if form(a, x, x) < 0:
                return x
        x = max(basis, key=lambda v: form(a, v, v))
        length = form(a, x, x)
        if length == 0:
            return _isotropic_descent(a, basis)
        rest = [v for v in basis if v is not x]
        basis = [[vi - form(a, v, x) / length * xi for vi, xi in zip(v, x, strict=True)] for v in rest]
    return None


def balls_positive_definite(rows: Sequence[Sequence[arb]]) -> bool:
    """Whether every symmetric matrix inside a matrix of balls is positive definite; ``True`` only if proved.

    ``False`` says nothing: more precision or smaller balls may succeed. Only the lower triangle is read.

    Soundness: interval Cholesky encloses the factorisation of every symmetric matrix inside; a pivot ball
    that is not certainly positive, NaN included, ends in ``False``.
    """
    n = len(rows)
    work = [list(row) for row in rows]
    for k in range(n):
        if not work[k][k] > 0:
            return False
        for i in range(k + 1, n):
            factor = work[i][k] / work[k][k]
            for j in range(k + 1, i + 1):
                work[i][j] -= factor * work[j][k]
    return True


def symmetric(rows: Rows) -> list[list[Fraction]]:
    """The matrix as lists of fractions; raises ``ValueError`` unless it is square and symmetric."""
    if isinstance(rows, fmpq_mat):
        size = range(rows.nrows())
        exact = [[_fraction(rows[i, j]) for j in range(rows.ncols())] for i in size]
    else:
        exact = [[Fraction(entry) for entry in row] for row in rows]
    n = len(exact)
    if any(len(row) != n for row in exact):
        raise ValueError("the matrix must be square")
    if any(exact[i][j] != exact[j][i] for i in range(n) for j in range(i)):
        raise ValueError("the matrix must be symmetric")
    return exact


def form(a: Sequence[Sequence[Fraction]], x: Sequence[Fraction], y: Sequence[Fraction]) -> Fraction:
    """xᵀAy."""
    products = (xi * aij * yj for xi, row in zip(x, a, strict=True) for aij, yj in zip(row, y, strict=True))
    return sum(products, Fraction(0))


def _eliminate(work: list[list[Fraction]], k: int) -> None:
    """The Schur complement of pivot k, in place."""
    pivot_row = list(work[k])
    for i in range(k + 1, len(work)):
        factor = work[i][k] / pivot_row[k]
        if factor:
            for j in range(k + 1, len(work)):
                work[i][j] -= factor * pivot_row[j]


def _isotropic_descent(a: list[list[Fraction]], basis: list[list[Fraction]]) -> list[Fraction] | None:
    """A negative direction among vectors that all have xᵀAx = 0: x − sign(xᵀAy) y if xᵀAy ≠ 0."""
    for index, x in enumerate(basis):
        for y in basis[index + 1 :]:
            mixed = form(a, x, y)
            if mixed != 0:
                sign = 1 if mixed > 0 else -1
                return [xi - sign * yi for xi, yi in zip(x, y, strict=True)]
    return None


def _fraction(value: fmpq) -> Fraction:
    return Fraction(int(value.p), int(value.q))
