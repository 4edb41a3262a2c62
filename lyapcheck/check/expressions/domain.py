"""The values over which the variables of an expression range."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from fractions import Fraction


@dataclass(frozen=True)
class Interval:
    """The reals from ``low`` to ``high``, ends included unless said to be open; ``None`` is infinity."""

    low: Fraction | None = None
    high: Fraction | None = None
    open_low: bool = False
    open_high: bool = False

    def signs(self) -> frozenset[int]:
        """The signs of its numbers."""
        below = self.low is None or self.low < 0
        above = self.high is None or self.high > 0
        starts = self.low is None or self.low < 0 or (self.low == 0 and not self.open_low)
        ends = self.high is None or self.high > 0 or (self.high == 0 and not self.open_high)
        found = [(-1, below), (0, starts and ends), (1, above)]
        return frozenset(sign for sign, has in found if has)


Domain = Mapping[str, Interval]
"""The interval of each variable; one that is not named ranges over all reals."""

REALS = Interval()
POSITIVE = Interval(low=Fraction(0), open_low=True)
NONNEGATIVE = Interval(low=Fraction(0))
