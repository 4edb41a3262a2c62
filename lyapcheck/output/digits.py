"""Enclosures in decimals: rounded outward, or the digits that are certain."""

from __future__ import annotations

import math
from fractions import Fraction

from lyapcheck.check.numbers.enclosure import Enclosure


def decimals(number: Enclosure, digits: int) -> tuple[str, str]:
    """Decimal strings of ``digits`` significant digits, rounded outward, that enclose the number.

    A number that is known exactly and short enough is written as it is: ``("1", "1")``.
    """
    places = _places(number, digits)
    scale = Fraction(10) ** places
    low, high = math.floor(number.lower * scale), math.ceil(number.upper * scale)
    if number.width == 0 and low == high:
        return (_shortest(low, places),) * 2
    return _decimal(low, places), _decimal(high, places)


def correct_digits(number: Enclosure, digits: int) -> str:
    """The leading digits of the number, at most ``digits`` and all correct: cut off, never rounded.

    The bracket ``[lower, upper]`` where not even one digit is certain.
    """
    written = decimals(number, digits)
    if written[0] == written[1]:
        return written[0]
    for shown in range(digits, 0, -1):
        places = _places(number, shown)
        low, high = (math.trunc(end * Fraction(10) ** places) for end in (number.lower, number.upper))
        if low == high and low != 0:
            return _decimal(low, places)
    return "[{}, {}]".format(*written)


def _places(number: Enclosure, digits: int) -> int:
    """The decimal places that ``digits`` significant digits reach, at the larger end; never below 0."""
    return max(0, digits - _integer_digits(max(abs(number.lower), abs(number.upper))))


def _integer_digits(value: Fraction) -> int:
    """The exponent e with 10^(e-1) <= value < 10^e (1 for zero)."""
    if value == 0:
        return 1
    bits = value.numerator.bit_length() - value.denominator.bit_length()
    guess = math.floor((bits - 1) * math.log10(2))
    while Fraction(10) ** guess <= value:
        guess += 1
    return guess


def _shortest(scaled: int, places: int) -> str:
    """``_decimal`` without zeros that say nothing."""
    text = _decimal(scaled, places)
    return text.rstrip("0").rstrip(".") if "." in text else text


def _decimal(scaled: int, places: int) -> str:
    """The integer ``scaled`` times 10^-places, written out in full."""
    if places == 0:
        return str(scaled)
    sign, digits = "-" if scaled < 0 else "", str(abs(scaled)).rjust(places + 1, "0")
    return f"{sign}{digits[:-places]}.{digits[-places:]}"
