"""Definiteness of symmetric rational matrices, decided by their characteristic polynomials."""

from __future__ import annotations

from collections.abc import Sequence
from fractions import Fraction

from flint import fmpq_mat

from lyapcheck.check.numbers.polynomials import rational

Rows = Sequence[Sequence[Fraction | int]]


def is_positive_semidefinite(rows: Rows) -> bool:
    """Whether xᵀAx ≥ 0 for all x, for a symmetric A.

    Its eigenvalues are real, and the coefficients of det(λI + A) are the sums of their products. Where none
    of these is negative the polynomial has no positive root, and so A no negative eigenvalue.
    """
    n = len(rows)
    opposite = fmpq_mat(n, n, [rational(-Fraction(x)) for row in rows for x in row])
    return all(c >= 0 for c in opposite.charpoly().coeffs())
