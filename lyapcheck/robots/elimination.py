"""Linear equations with a symmetric positive definite matrix, in any arithmetic."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from typing import Any

Vector = Sequence[Any]
Named = Callable[[Vector], list[Any]]


def solve_definite(matrix: Sequence[Vector], right: Vector, names: Named = list) -> list[Any]:
    """x with matrix · x = right, by LDLᵀ without square roots, in any arithmetic.

    Args:
        matrix: (n, n).
        right: (n,).
        names: of values that are used more than once.

    Soundness: with M not definite the pivots vanish or change sign; property 2.1 is decided elsewhere.
    """
    lower, pivots = _ldl(matrix, names)
    x = list(right)
    n = len(x)
    for i in range(n):
        for k in range(i):
            x[i] = x[i] - lower[i][k] * x[k]
        (x[i],) = names([x[i]])
    x = [a / d for a, d in zip(x, pivots, strict=True)]
    for i in reversed(range(n)):
        for k in range(i + 1, n):
            x[i] = x[i] - lower[k][i] * x[k]
        (x[i],) = names([x[i]])
    return x


def _ldl(matrix: Sequence[Vector], names: Named) -> tuple[list[list[Any]], list[Any]]:
    """Rows of L left of its diagonal, and the pivots."""
    lower: list[list[Any]] = []
    pivots: list[Any] = []
    for i, row in enumerate(matrix):
        scaled: list[Any] = []  # L_ik d_k
        for k in range(i):
            rest = row[k]
            for j in range(k):
                rest = rest - scaled[j] * lower[k][j]
            scaled += names([rest])
        lower.append([names([a / d])[0] for a, d in zip(scaled, pivots, strict=False)])
        pivot = row[i]
        for a, b in zip(scaled, lower[i], strict=True):
            pivot = pivot - a * b
        pivots += names([pivot])
    return lower, pivots
