"""Symmetric 3 × 3 matrices of rationals."""

from __future__ import annotations

from fractions import Fraction


def positive_semidefinite(a: list[list[Fraction]]) -> bool:
    """All principal minors of a symmetric 3 × 3 matrix are non-negative."""
    pairs = [a[i][i] * a[k][k] - a[i][k] ** 2 for i, k in ((0, 1), (0, 2), (1, 2))]
    cofactors = (pairs[2], a[1][2] * a[0][2] - a[0][1] * a[2][2], a[0][1] * a[1][2] - a[0][2] * a[1][1])
    determinant = sum(x * y for x, y in zip(a[0], cofactors, strict=True))
    return min(*(a[i][i] for i in range(3)), *pairs, determinant) >= 0
