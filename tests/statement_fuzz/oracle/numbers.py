"""Numbers of the oracle: a ``Fraction``, or an interval of 60 digits that may know an exact form as well."""

from __future__ import annotations

from collections.abc import Callable
from fractions import Fraction
from typing import Any

from mpmath import mp, mpf

from tests.statement_fuzz.oracle import exact
from tests.statement_fuzz.oracle.exact import Polynomial, TooLong

DIGITS = 60
SPARE = 4
"""Decimal digits by which every result is widened."""
MAX_BITS = 200_000


class Undefined(Exception):
    """The expression certainly has no value."""


class Unsure(Exception):
    """The arithmetic cannot tell."""


class Num:
    """What is known of a real number: it lies in [low, high], and ``form`` is it exactly, if there is one."""

    __slots__ = ("form", "high", "low")

    def __init__(self, low: Any, high: Any, form: Polynomial | None = None) -> None:
        self.low, self.high, self.form = low, high, form if exact.KEPT[0] else None

    def __add__(self, other: Any) -> Value:
        other = lifted(other)
        return made(self.low + other.low, self.high + other.high, both(exact.add, self, other))

    __radd__ = __add__

    def __neg__(self) -> Value:
        return Num(-self.high, -self.low, None if self.form is None else exact.scale(self.form, Fraction(-1)))

    def __sub__(self, other: Any) -> Value:
        return self + (-other)

    def __rsub__(self, other: Any) -> Value:
        return -self + other

    def __mul__(self, other: Any) -> Value:
        other = lifted(other)
        ends = [a * b for a in (self.low, self.high) for b in (other.low, other.high)]
        return made(min(ends), max(ends), both(exact.mul, self, other))

    __rmul__ = __mul__


Value = Fraction | Num


def lifted(value: Value) -> Num:
    """Any number as an interval."""
    if isinstance(value, Num):
        return value
    near = mpf(value.numerator) / value.denominator
    wide = _width(near)
    return Num(near - wide, near + wide, exact.constant(value))


def interval(low: Fraction, high: Fraction, form: Polynomial | None) -> Num:
    """A number somewhere between two rationals."""
    return Num(lifted(low).low, lifted(high).high, form)


def made(low: Any, high: Any, form: Polynomial | None) -> Value:
    """An interval widened by what rounding may have cost; a rational number where the form is one."""
    if form is not None and (value := exact.as_rational(form)) is not None:
        return value
    if not (mp.isfinite(low) and mp.isfinite(high)):
        raise Unsure
    return Num(low - _width(low), high + _width(high), form)


def _width(end: Any) -> Any:
    return abs(end) * mpf(10) ** (SPARE - mp.dps)


def both(operation: Callable[..., Polynomial], *numbers: Num) -> Polynomial | None:
    """An operation on exact forms, if all are known."""
    if not exact.KEPT[0] or any(number.form is None for number in numbers):
        return None
    try:
        return operation(*(number.form for number in numbers))
    except TooLong:
        return None


def sign(value: Value) -> int:
    """The sign of a number.

    Raises:
        Unsure: it is too close to zero.
    """
    if isinstance(value, Fraction):
        return (value > 0) - (value < 0)
    if value.low > 0:
        return 1
    if value.high < 0:
        return -1
    if value.form is not None and not value.form:
        return 0
    raise Unsure


def not_negative(value: Value) -> bool:
    """Whether a number is >= 0, where an interval that touches 0 from above says so as well."""
    return True if isinstance(value, Num) and value.low >= 0 else sign(value) >= 0


def divide(a: Value, b: Value) -> Value:
    """The quotient.

    Raises:
        Undefined: the divisor is zero.
        Unsure: it may be.
    """
    if sign(b) == 0:
        raise Undefined("division by 0")
    if isinstance(a, Fraction) and isinstance(b, Fraction):
        return a / b
    b = lifted(b)
    return a * Num(*_outward(1 / b.high, 1 / b.low), both(exact.inverse, b))


def _outward(low: Any, high: Any) -> tuple[Any, Any]:
    return low - _width(low), high + _width(high)


def power(base: Value, k: int) -> Value:
    """``base`` multiplied k times; 1 for k = 0."""
    if k == 0:
        return Fraction(1)
    if isinstance(base, Fraction):
        bits = max(base.numerator.bit_length(), base.denominator.bit_length())
        if bits * k <= MAX_BITS:
            return base**k
        base = lifted(base)
        base = Num(base.low, base.high)
    if k > 1 and k % 2 == 0 and base.low < 0 < base.high:
        top = max(-base.low, base.high) ** k
        return made(mpf(0), top, _power_form(base.form, k))
    ends = sorted((base.low**k, base.high**k))
    return made(*ends, _power_form(base.form, k))


def _power_form(form: Polynomial | None, k: int) -> Polynomial | None:
    if form is None or k > 12 or not exact.KEPT[0]:
        return None
    try:
        result = exact.constant(Fraction(1))
        for _ in range(k):
            result = exact.mul(result, form)
    except TooLong:
        return None
    return result
