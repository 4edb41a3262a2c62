"""What the evaluation of P needs of an arithmetic, beyond sums and products: balls, or spans."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import Any

from flint import arb

from lyapcheck.check.loop.span import Span

Value = Any


@dataclass(frozen=True)
class Ring:
    """Values under +, − and ×.

    Args:
        value: the one for a ball.
        square: x², never below 0 where it encloses.
    """

    value: Callable[[arb], Value]
    square: Callable[[Value], Value]


@dataclass(frozen=True)
class Arithmetic(Ring):
    """Enclosures under +, −, × and ÷, with what those operators cannot say.

    Args:
        meet: what lies in two enclosures of the same quantity.
        positive: whether all of an enclosure is proved to be above 0.
    """

    meet: Callable[[Value, Value], Value]
    positive: Callable[[Value], bool]

    def positive_definite(self, rows: list[list[Value]]) -> bool:
        """Whether every symmetric matrix inside is positive definite; ``False`` says nothing.

        Elimination: a symmetric matrix is positive definite exactly when all its pivots are positive.

        Args:
            rows: the entries on and below the diagonal; they are overwritten.
        """
        n = len(rows)
        for k in range(n):
            pivot = rows[k][k]
            if not self.positive(pivot):
                return False
            for i in range(k + 1, n):
                factor = rows[i][k] / pivot
                for j in range(k + 1, i):
                    rows[i][j] = rows[i][j] - factor * rows[j][k]
                rows[i][i] = rows[i][i] - self.square(rows[i][k]) / pivot
        return True


def _square_of(x: arb) -> arb:
    """The square of a ball, which a product with itself would make too wide."""
    low, high = x.lower(), x.upper()
    if low <= 0 <= high:
        return arb(0).union(low * low).union(high * high)
    return (low * low).union(high * high)


BALLS = Arithmetic(lambda x: x, _square_of, arb.intersection, lambda x: bool(x > 0))
SPANS = Arithmetic(Span.of, Span.square, Span.meet, lambda x: x.positive)
