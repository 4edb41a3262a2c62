"""A real number known to lie between two exact rationals."""

from __future__ import annotations

import math
from dataclasses import dataclass
from fractions import Fraction
from typing import NoReturn

from flint import arb, fmpq

MOST_BITS = 1 << 18
"""Balls reach e^(e^x); exact rationals of that size would fill the memory."""


@dataclass(frozen=True)
class Enclosure:
    """The closed interval ``[lower, upper]`` with exact rational ends that holds one real number.

    Soundness: whoever makes an enclosure vouches that the number lies inside; everything here only widens.
    """

    lower: Fraction
    upper: Fraction

    def __post_init__(self) -> None:
        if self.lower > self.upper:
            raise ValueError(f"enclosure ends out of order: {self.lower} > {self.upper}")

    @classmethod
    def exact(cls, value: Fraction | int) -> Enclosure:
        """The enclosure of a number that is known exactly."""
        return cls(Fraction(value), Fraction(value))

    @classmethod
    def from_arb(cls, ball: arb) -> Enclosure:
        """The ends of a finite ball, exactly; raises ``ValueError`` where they cannot be written."""
        if not ball.is_finite():
            raise ValueError(f"a ball without finite ends encloses nothing useful: {ball}")
        return cls(dyadic(ball.lower()), dyadic(ball.upper()))

    def to_arb(self) -> arb:
        """A ball that contains the whole interval."""
        return ball_of(self.lower).union(ball_of(self.upper))

    @property
    def width(self) -> Fraction:
        """``upper - lower``."""
        return self.upper - self.lower

    @property
    def mid(self) -> Fraction:
        """The middle of the interval."""
        return (self.lower + self.upper) / 2

    @property
    def float_lower(self) -> float:
        """The largest double that is not above ``lower``."""
        value = _nearest_double(self.lower)
        return value if _not_above(value, self.lower) else math.nextafter(value, -math.inf)

    @property
    def float_upper(self) -> float:
        """The smallest double that is not below ``upper``."""
        return 0.0 - Enclosure(-self.upper, -self.lower).float_lower

    def __bool__(self) -> NoReturn:
        raise TypeError("an enclosure has no truth value; compare its ends")


def dyadic(point: arb) -> Fraction:
    """The exact rational value of a ball of radius zero.

    Raises:
        ValueError: it would take more than ``MOST_BITS`` binary places to write it down.
    """
    mantissa, exponent = (int(part) for part in point.man_exp())
    if abs(exponent) > MOST_BITS:
        raise ValueError(f"a number of about 2^{exponent} is too large or too small to write down")
    return Fraction(mantissa << exponent) if exponent >= 0 else Fraction(mantissa, 1 << -exponent)


def ball_of(value: Fraction | int) -> arb:
    """A ball of the current precision that contains a rational number."""
    return arb(fmpq(value.numerator, value.denominator))


def _nearest_double(value: Fraction) -> float:
    try:
        return float(value)
    except OverflowError:
        return math.inf if value > 0 else -math.inf


def _not_above(value: float, bound: Fraction) -> bool:
    return value == -math.inf or (value != math.inf and Fraction(value) <= bound)


def root_above(value: Fraction) -> Fraction:
    """A rational not below the square root, within 10⁻¹² of it."""
    scale = 10**24
    scaled = -((-value.numerator * scale) // value.denominator)
    root = math.isqrt(scaled)
    return Fraction(root if root * root == scaled else root + 1, 10**12)
