"""Positive definiteness of symmetric interval matrices, proved elementwise over arrays."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray

from lyapcheck.intervals.interval import Interval

Rows = Sequence[Sequence[Interval]]


def positive_definite(matrix: Rows) -> NDArray[np.bool_]:
    """Where every symmetric matrix within the intervals is positive definite; False means not proved.

    Elimination without pivoting: a symmetric matrix is positive definite exactly when all its pivots are
    positive, and the pivots of every member lie in the interval pivots.

    Args:
        matrix: n × n intervals; only the entries on and below the diagonal are read.

    Soundness: outward rounding throughout; an undefined end is infinite and proves nothing.
    """
    n = len(matrix)
    rows = [list(row) for row in matrix]
    proved = np.ones(np.shape(rows[0][0].lo), dtype=np.bool_)
    for k in range(n):
        pivot = rows[k][k]
        proved = proved & (pivot.lo > 0)
        inverse = pivot.reciprocal()
        for i in range(k + 1, n):
            factor = rows[i][k] * inverse
            for j in range(k + 1, i):
                rows[i][j] = rows[i][j] - factor * rows[j][k]
            rows[i][i] = rows[i][i] - rows[i][k].square() * inverse
    return proved
