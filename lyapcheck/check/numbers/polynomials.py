"""Signs of one polynomial with rational coefficients on an interval, decided exactly by Sturm's theorem.

A polynomial is a ``fmpq_poly``; an end of ``None`` stands for infinity on that side.

References: ``sturm1829``; ``basu2006algorithms``, section 2.2.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from fractions import Fraction
from itertools import pairwise
from math import isqrt, prod
from typing import NoReturn

from flint import arb, fmpq, fmpq_mpoly, fmpq_poly

End = Fraction | None


def rational(value: Fraction | int) -> fmpq:
    """The same number for flint."""
    return fmpq(value.numerator, value.denominator)


def fraction(value: fmpq) -> Fraction:
    """The same number from flint."""
    return Fraction(int(value.p), int(value.q))


def rational_root(square: Fraction) -> Fraction | None:
    """The square root of a number, where it is rational."""
    if square < 0:
        return None
    root = Fraction(isqrt(square.numerator), isqrt(square.denominator))
    return root if root**2 == square else None


def signum(value: Fraction | fmpq) -> int:
    """−1, 0 or 1."""
    return int(value > 0) - int(value < 0)


def univariate(polynomial: fmpq_mpoly, index: int) -> fmpq_poly:
    """A polynomial in which one generator alone occurs."""
    result = [fmpq(0)] * (1 + polynomial.degrees()[index])
    for exponents, c in polynomial.to_dict().items():
        result[int(exponents[index])] = c
    return fmpq_poly(result)


def sign_at(poly: fmpq_poly, point: Fraction) -> int:
    """The sign of a polynomial at a rational point."""
    return signum(poly(rational(point)))


def count_roots(poly: fmpq_poly, low: End, high: End) -> int:
    """The number of distinct roots strictly between low and high of a polynomial other than 0, by Sturm."""
    if not poly:
        raise ValueError("the zero polynomial vanishes everywhere")
    if poly.degree() == 0:
        return 0
    free = _scaled(poly // poly.gcd(poly.derivative()))  # with the same distinct roots, each once
    chain = [free, free.derivative()]  # every member scaled by a positive number only
    while chain[-1].degree() > 0:
        chain.append(-_scaled(chain[-2] % chain[-1]))
    chain = [member for member in chain if member]
    at_high = 1 if high is not None and sign_at(poly, high) == 0 else 0
    return _changes(chain, low, -1) - _changes(chain, high, 1) - at_high


def nonnegative_on(poly: fmpq_poly, low: End, high: End) -> bool:
    """Whether ``poly >= 0`` on the closed interval from low to high; never undecided."""
    if not poly or _positive_by_coefficients(poly, low, high):
        return True
    if low is not None and low == high:
        return sign_at(poly, low) >= 0
    # the product of the square-free factors of odd multiplicity changes sign where the polynomial does
    odd = (factor for factor, multiplicity in poly.factor_squarefree()[1] if multiplicity % 2)
    point = inner_point(poly, low, high)
    return sign_at(poly, point) >= 0 and count_roots(prod(odd, start=fmpq_poly([1])), low, high) == 0


def positive_on(
    poly: fmpq_poly, low: End, high: End, open_low: bool = False, open_high: bool = False
) -> bool:
    """Whether ``poly > 0`` on the interval, with open ends where said; never undecided."""
    if not poly:
        return False
    ends = [end for end, is_open in ((low, open_low), (high, open_high)) if end is not None and not is_open]
    if any(sign_at(poly, end) <= 0 for end in ends):
        return False
    if low is not None and low == high:
        return True
    if _positive_by_coefficients(poly, low, high):
        return True
    return sign_at(poly, inner_point(poly, low, high)) > 0 and count_roots(poly, low, high) == 0


def inner_point(poly: fmpq_poly, low: End, high: End) -> Fraction:
    """A rational point strictly inside the interval at which a non-zero polynomial is not zero."""
    for step in range(1, poly.degree() + 3):
        if low is not None and high is not None:
            point = low + (high - low) * Fraction(1, step + 1)
        elif low is not None:
            point = low + step
        else:
            point = high - step if high is not None else Fraction(step)
        if sign_at(poly, point):
            return point
    raise ArithmeticError("a non-zero polynomial has more roots than its degree")


def _positive_by_coefficients(poly: fmpq_poly, low: End, high: End) -> bool:
    """A quick sufficient test on [low, ∞): in powers of (x - low) no coefficient is negative.

    It means >= 0 on the closed half-line and > 0 on the open one.
    """
    if low is None or high is not None:
        return False
    return all(c >= 0 for c in poly(fmpq_poly([rational(low), 1])).coeffs())


def _changes(chain: list[fmpq_poly], end: End, side: int) -> int:
    if end is None:
        signs = [signum(member.leading_coefficient()) * (side ** member.degree()) for member in chain]
    else:
        signs = [sign_at(member, end) for member in chain]
    signs = [sign for sign in signs if sign]
    return sum(a != b for a, b in pairwise(signs))


def _scaled(poly: fmpq_poly) -> fmpq_poly:
    """The polynomial divided by the positive size of its content, to keep coefficients short."""
    if not poly:
        return poly
    return poly / fmpq(abs(poly.numer().content()), poly.denom())


# --- A real number known to lie between two exact rationals.

MOST_BITS = 1 << 18
"""Balls reach e^(e^x); exact rationals of that size would fill the memory."""


@dataclass(frozen=True)
class Enclosure:
    """The closed interval ``[lower, upper]`` with exact rational ends that holds one real number.

    Soundness: the caller guarantees that the number is inside. All operations only widen the interval.
    """

    lower: Fraction
    upper: Fraction

    def __post_init__(self) -> None:
        if self.lower > self.upper:
            raise ValueError(f"enclosure ends out of order: {self.lower} > {self.upper}")

    def __repr__(self) -> str:
        ends = (arb(fmpq(x.numerator, x.denominator)) for x in (self.lower, self.upper))
        return f"<Enclosure: {next(ends).union(next(ends)).str(10, more=True)}>"

    @classmethod
    def exact(cls, value: Fraction | int) -> Enclosure:
        return cls(Fraction(value), Fraction(value))

    @classmethod
    def from_arb(cls, ball: arb) -> Enclosure:
        """The ends of a finite ball, exactly; raises ``ValueError`` where they cannot be written."""
        if not ball.is_finite():
            raise ValueError(f"a ball without finite ends encloses nothing useful: {ball}")
        return cls(dyadic(ball.lower()), dyadic(ball.upper()))

    def to_arb(self) -> arb:
        return ball_of(self.lower).union(ball_of(self.upper))

    @property
    def width(self) -> Fraction:
        return self.upper - self.lower

    @property
    def mid(self) -> Fraction:
        return (self.lower + self.upper) / 2

    @property
    def float_lower(self) -> float:
        """The largest double that is not above ``lower``."""
        try:
            value = float(self.lower)  # the nearest
        except OverflowError:
            value = math.inf if self.lower > 0 else -math.inf
        fits = value == -math.inf or (value != math.inf and Fraction(value) <= self.lower)
        return value if fits else math.nextafter(value, -math.inf)

    @property
    def float_upper(self) -> float:
        """The smallest double that is not below ``upper``."""
        return 0.0 - Enclosure(-self.upper, -self.lower).float_lower

    @property
    def side(self) -> tuple[float, float]:
        """Two doubles with the interval between them."""
        return self.float_lower, self.float_upper

    def __bool__(self) -> NoReturn:
        raise TypeError("an enclosure has no truth value; compare its ends")


def dyadic(point: arb) -> Fraction:
    """The exact value of a ball of radius zero; ``ValueError`` if it has above ``MOST_BITS`` places."""
    mantissa, exponent = (int(part) for part in point.man_exp())
    if abs(exponent) > MOST_BITS:
        raise ValueError(f"a number of about 2^{exponent} is too large or too small to write down")
    return Fraction(mantissa << exponent) if exponent >= 0 else Fraction(mantissa, 1 << -exponent)


def ball_of(value: Fraction | int) -> arb:
    """A ball of the current precision that contains a rational number."""
    return arb(fmpq(value.numerator, value.denominator))


def root_above(value: Fraction) -> Fraction:
    """A rational not below the square root, within 10⁻¹² of it."""
    scale = 10**24
    scaled = -((-value.numerator * scale) // value.denominator)
    root = math.isqrt(scaled)
    return Fraction(root if root * root == scaled else root + 1, 10**12)
