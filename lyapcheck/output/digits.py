"""Numbers in decimals: rounded to the safe side, enclosed, or the digits that are certain.

``at_most`` and ``at_least`` are the only way to print a number next to a word of proof.
"""

from __future__ import annotations

import decimal
import math
from decimal import Decimal
from fractions import Fraction
from typing import TypeAlias

from flint import arb

from lyapcheck.check.numbers.polynomials import Enclosure

SHOWN = 4
"""Significant digits that people see, the same in every command."""
NONE = "—"
LARGE = 1e12
"""From here on numbers of floating point are written with an exponent."""
PLAIN = range(-6, 15)
"""Powers of ten whose numbers are written without an exponent."""
Exact: TypeAlias = "Fraction | int | float | arb | Enclosure"


def at_most(x: Exact, digits: int = SHOWN) -> str:
    """Return the shortest decimal of ``digits`` significant digits that is not below ``x``.

    Args:
        x: a number, or a ball or an enclosure, whose upper end counts.
        digits: 1 or more.

    Raises:
        ValueError: ``x`` is not a number.

    Example:
        >>> at_most(Fraction(2, 3)), at_most(2.5), at_most(-Fraction(2, 3), 2)
        ('0.6667', '2.5', '-0.66')
    """
    return _safe(x, digits, upward=True)


def at_least(x: Exact, digits: int = SHOWN) -> str:
    """Return the shortest decimal of ``digits`` significant digits that is not above ``x``.

    The lower end of a ball or an enclosure counts; see ``at_most`` for the rest.

    Example:
        >>> at_least(Fraction(2, 3)), at_least(10**20 + 1), at_least(Fraction(1, 3 * 10**9), 2)
        ('0.6666', '1e+20', '3.3e-10')
    """
    return _safe(x, digits, upward=False)


def shown(value: float | None, form: str) -> str:
    """A number of floating point in a form; a dash where there is none, or a sign of infinity.

    Example:
        >>> shown(2.5, ".2f"), shown(float("nan"), ".2f"), shown(float("-inf"), ".2f"), shown(1e300, ".2f")
        ('2.50', '—', '-∞', '1e+300')
    """
    if value is None or math.isnan(value):
        return NONE
    if math.isinf(value):
        return "∞" if value > 0 else "-∞"
    return format(value, form if abs(value) < LARGE else ".4g")


def decimals(number: Enclosure, digits: int) -> tuple[str, str]:
    """Decimal strings of ``digits`` significant digits, rounded outward, that enclose the number.

    A number that is known exactly and short enough is written as it is: ``("1", "1")``.
    """
    places = _places(number, digits)
    scale = Fraction(10) ** places
    low, high = math.floor(number.lower * scale), math.ceil(number.upper * scale)
    if number.width == 0 and low == high:
        text = scaled_text(low, places)
        return (text.rstrip("0").rstrip(".") if "." in text else text,) * 2
    return scaled_text(low, places), scaled_text(high, places)


def ends(number: Enclosure, digits: int) -> dict[str, str]:
    """The same by their names, for programs."""
    low, high = decimals(number, digits)
    return {"lower": low, "upper": high}


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
            return scaled_text(low, places)
    return "[{}, {}]".format(*written)


def _safe(x: Exact, digits: int, *, upward: bool) -> str:
    """A decimal on one side of a number; a sign of infinity where no decimal is on that side."""
    if digits < 1:
        raise ValueError(f"{digits} significant digits; use 1 or more")
    value = _end(x, upward)
    if isinstance(value, float):
        return "∞" if value > 0 else "-∞"
    if value == 0:
        return "0"
    result = significant(value, digits, decimal.ROUND_CEILING if upward else decimal.ROUND_FLOOR)
    # with an exponent only where the number is very large or small
    return f"{result:f}" if result.adjusted() in PLAIN else f"{result:e}"


def significant(value: Fraction, digits: int, rounding: str) -> Decimal:
    """The number in so many significant digits, without zeros at its end, rounded as ``decimal`` says."""
    context = decimal.Context(digits, rounding, decimal.MIN_EMIN, decimal.MAX_EMAX)
    return context.divide(Decimal(value.numerator), Decimal(value.denominator)).normalize(context)


def _end(x: Exact, upward: bool) -> Fraction | float:
    """The end that counts, exactly, or an infinity.

    Raises:
        ValueError: ``x`` is not a number.
    """
    if isinstance(x, Enclosure):
        return x.upper if upward else x.lower
    if isinstance(x, arb):
        if x.is_nan():
            raise ValueError("a ball that is not a number has no decimal")
        if not x.is_finite():
            # the infinity that such a ball reaches on that side
            if x.mid().is_finite():
                return math.inf if upward else -math.inf
            return math.inf if x > 0 else -math.inf
        ends = Enclosure.from_arb(x)
        return ends.upper if upward else ends.lower
    if isinstance(x, float) and not math.isfinite(x):
        if math.isnan(x):
            raise ValueError("nan has no decimal")
        return x
    return Fraction(x)


def _places(number: Enclosure, digits: int) -> int:
    """The decimal places that ``digits`` significant digits reach, at the larger end; never below 0."""
    return max(0, digits - integer_digits(max(abs(number.lower), abs(number.upper))))


def integer_digits(value: Fraction) -> int:
    """The exponent e with 10^(e-1) <= value < 10^e (1 for zero)."""
    return significant(value, 1, decimal.ROUND_DOWN).adjusted() + 1


def scaled_text(scaled: int, places: int) -> str:
    """The integer ``scaled`` times 10^-places, written out in full."""
    if places == 0:
        return str(scaled)
    sign, digits = "-" if scaled < 0 else "", str(abs(scaled)).rjust(places + 1, "0")
    return f"{sign}{digits[:-places]}.{digits[-places:]}"
