"""Numbers of few decimal digits, for statements that people read; rounded to the side that is safe."""

from __future__ import annotations

import math
from fractions import Fraction

from lyapcheck.files.decimals import significant_down, significant_up

DIGITS = 6
TICKS = 10**6
"""Times are multiples of 1/TICKS s."""


def as_written(value: Fraction | float) -> Fraction:
    """A number as it is written: 0.1 is 1/10, and not the double beside it."""
    return value if isinstance(value, Fraction) else Fraction(str(float(value)))


def short_below(value: Fraction) -> Fraction:
    """A number ≥ 0 rounded down to `DIGITS` significant digits."""
    return significant_down(value, DIGITS)


def short_above(value: Fraction) -> Fraction:
    """A number ≥ 0 rounded up to `DIGITS` significant digits."""
    return significant_up(value, DIGITS)


def tick_after(time: Fraction) -> Fraction:
    """A time in s rounded up."""
    return Fraction(math.ceil(time * TICKS), TICKS)
