"""Numbers of few decimal digits, for statements that people read; rounded to the side that is safe."""

from __future__ import annotations

import math
from fractions import Fraction

DIGITS = 6
TICKS = 10**6
"""Times are multiples of 1/TICKS s."""


def as_written(value: Fraction | float) -> Fraction:
    """A number as it is written: 0.1 is 1/10, and not the double beside it."""
    return value if isinstance(value, Fraction) else Fraction(str(float(value)))


def short_below(value: Fraction) -> Fraction:
    """A number ≥ 0 rounded down to `DIGITS` significant digits."""
    unit = _unit(value)
    return math.floor(value / unit) * unit


def short_above(value: Fraction) -> Fraction:
    """A number ≥ 0 rounded up to `DIGITS` significant digits."""
    unit = _unit(value)
    return math.ceil(value / unit) * unit


def tick_after(time: Fraction) -> Fraction:
    """A time in s rounded up."""
    return Fraction(math.ceil(time * TICKS), TICKS)


def _unit(value: Fraction) -> Fraction:
    """What the last of the significant digits counts."""
    magnitude = math.floor(math.log10(value)) if value else 0
    return Fraction(10) ** (magnitude + 1 - DIGITS)
