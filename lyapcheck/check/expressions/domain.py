"""The values over which the variables of an expression range."""

from __future__ import annotations

from collections.abc import Mapping
from contextlib import suppress
from dataclasses import dataclass
from fractions import Fraction

from flint import arb, fmpq

from lyapcheck.check.expressions.expression import ExactAlgebra, Tree, Unsupported, ball, evaluate
from lyapcheck.check.numbers.polynomials import ball_of, rational


@dataclass(frozen=True)
class Interval:
    """The reals from ``low`` to ``high``, ends included unless said to be open; ``None`` is infinity."""

    low: Fraction | None = None
    high: Fraction | None = None
    open_low: bool = False
    open_high: bool = False

    def __contains__(self, x: Fraction) -> bool:
        above = self.low is None or self.low < x or (self.low == x and not self.open_low)
        return above and (self.high is None or x < self.high or (self.high == x and not self.open_high))

    def __str__(self) -> str:
        low = "" if self.low is None else f"{'above' if self.open_low else 'at least'} {self.low}"
        high = "" if self.high is None else f"{'below' if self.open_high else 'at most'} {self.high}"
        return " and ".join(filter(None, (low, high))) or "real"

    def signs(self) -> frozenset[int]:
        below = self.low is None or self.low < 0
        above = self.high is None or self.high > 0
        return frozenset(sign for sign, has in ((-1, below), (0, Fraction(0) in self), (1, above)) if has)


Domain = Mapping[str, Interval]
"""The interval of each variable; one that is not named ranges over all reals."""
REALS = Interval()
POSITIVE = Interval(low=Fraction(0), open_low=True)
NONNEGATIVE = Interval(low=Fraction(0))


# --- Whether a comparison holds at a point, or fails there, in balls, or exactly where they touch.
#
# References: ``johansson2017arb``.

Comparison = tuple[Tree, str, Tree]
"""``left operator right`` with the operator ``<=``, ``<`` or ``=``."""


def holds(comparison: Comparison, point: Mapping[str, Fraction]) -> bool | None:
    """Whether a comparison holds at a point; ``None`` where neither balls nor rational numbers decide it."""
    left, operator, right = comparison
    balls = {name: ball_of(value) for name, value in point.items()}
    result = sign_holds(ball(right, balls) - ball(left, balls), operator)
    if result is None:
        with suppress(Unsupported, ZeroDivisionError):
            exact = {name: rational(value) for name, value in point.items()}
            return sign_holds(evaluate(("add", right, ("neg", left)), exact, ExactAlgebra()), operator)
    return result


def sign_holds(gap: arb | fmpq, operator: str) -> bool | None:
    """Whether a comparison holds whose sides differ by a gap; ``None`` where its ball does not decide it."""
    if operator == "=":
        return False if gap > 0 or gap < 0 else True if gap == 0 else None
    strict = operator == "<"
    if gap > 0 or (not strict and gap >= 0):
        return True
    return False if gap < 0 or (strict and gap <= 0) else None
