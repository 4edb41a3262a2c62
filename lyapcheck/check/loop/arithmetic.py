"""What the evaluation of P needs of an arithmetic, beyond sums and products: balls, or spans."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import Any

from flint import arb

# --- Intervals with two ends, for boxes so wide that balls are too coarse.
#
# A product of balls a ± r and b ± s has the radius |a|s + |b|r + rs, the exact range one of |a|s + |b|r: for
# wide balls that is much. Spans give the exact range of every operation, at several times the cost.


class Span:
    """All reals between two points.

    Soundness: for x in the first and y in the second span, x ∘ y lies in the result, for every ∘ here; ends
    are rounded outward by taking the outer end of each ball.
    """

    __slots__ = ("high", "low")

    def __init__(self, low: arb, high: arb) -> None:
        self.low = low
        self.high = high

    @classmethod
    def of(cls, value: arb) -> Span:
        return cls(value.lower(), value.upper())

    def __add__(self, other: Span) -> Span:
        return Span((self.low + other.low).lower(), (self.high + other.high).upper())

    def __sub__(self, other: Span) -> Span:
        return Span((self.low - other.high).lower(), (self.high - other.low).upper())

    def __mul__(self, other: Span) -> Span:
        a, b = self.low * other.low, self.low * other.high
        c, d = self.high * other.low, self.high * other.high
        return Span(
            a.lower().min(b.lower()).min(c.lower().min(d.lower())),
            a.upper().max(b.upper()).max(c.upper().max(d.upper())),
        )

    def __truediv__(self, other: Span) -> Span:
        """The quotient by a positive span; everything where the divisor may be 0."""
        if not other.low > 0:
            return Span(arb("-inf"), arb("inf"))
        return self * Span((1 / other.high).lower(), (1 / other.low).upper())

    def square(self) -> Span:
        """x², which is never negative."""
        a, b = self.low * self.low, self.high * self.high
        large = a.upper().max(b.upper())
        if self.low <= 0 <= self.high:
            return Span(arb(0), large)
        return Span(a.lower().min(b.lower()), large)

    def meet(self, other: Span) -> Span:
        """The values in both, for two enclosures of the same quantity."""
        return Span(self.low.max(other.low), self.high.min(other.high))

    @property
    def positive(self) -> bool:
        """Whether all of it is proved to be above 0; an end that is not a number proves nothing."""
        return bool(self.low > 0)


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
