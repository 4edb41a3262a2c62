"""Decimals as they are written: the exact rational value and the digits the writer chose."""

from __future__ import annotations

import re
from collections.abc import Iterable
from dataclasses import dataclass
from decimal import ROUND_CEILING, ROUND_FLOOR
from fractions import Fraction
from functools import lru_cache

from lyapcheck.output.digits import scaled_text, significant

TYPE_CHECKING = False  # so that nothing is imported that is not used
if TYPE_CHECKING:
    from typing import Any, Self

LARGEST_EXPONENT = 15
"""Decimals beyond 10^±15 are outside every physical range; doubles could not tell some apart."""
RANGE = f"must be between 1e-{LARGEST_EXPONENT} and 1e{LARGEST_EXPONENT} in size"
LONGEST = 1000
"""Characters of a decimal; what is longer was not written by anyone who meant it."""

DECIMAL = re.compile(r"[+-]?(\d{1,30}(\.\d{0,30})?|\.\d{1,30})(e[+-]?\d{1,2})?", re.IGNORECASE | re.ASCII)
"""What an option takes for an exact number."""


class Written(Fraction):
    """An exact rational that remembers the text it was read from."""

    __slots__ = ("places", "text")
    text: str
    places: int
    """Digits after the decimal point, as written: ``0.50`` has two, ``5e-3`` has three, ``28`` none."""

    def __repr__(self) -> str:
        return self.text

    def __copy__(self) -> Self:
        return self

    def __deepcopy__(self, memo: dict[int, Any]) -> Self:
        return self

    def __reduce__(self) -> Any:
        return (written, (self.text,))


@dataclass(frozen=True)
class NotFinite:
    """A number of a file that has no finite exact value here: ``nan``, ``inf``, or one beyond all sizes."""

    text: str
    rule: str = "must be a finite decimal number"

    def __repr__(self) -> str:
        return self.text


def written(text: str) -> Written | NotFinite:
    """The exact value of a TOML float."""
    plain = text.replace("_", "")
    if not re.match(r"[+-]?\d", plain):
        return NotFinite(text)
    if len(plain) > LONGEST:
        return NotFinite(text, f"must have at most {LONGEST} characters")
    _, _, exponent = plain.lower().partition("e")
    if abs(int(exponent or 0)) > LARGEST_EXPONENT:
        return NotFinite(text, RANGE)
    return exact_decimal(plain)


def exact_decimal(text: str) -> Written:
    """The value of a decimal of reasonable length that is known to be one."""
    whole, _, part = text.partition(".")
    plain = part.isdecimal()  # without an exponent; Fraction takes four times as long to read a text
    value = Written(int(whole + part), 10 ** len(part)) if plain else Written(text)
    value.text, value.places = text, len(part)
    if not plain:
        mantissa, _, exponent = text.lower().partition("e")
        value.places = max(0, len(mantissa.partition(".")[2]) - int(exponent or 0))
    return value


def of_physical_size(value: Fraction | int) -> bool:
    """Whether a value is 0 or between 10^-15 and 10^15 in size."""
    bits = value.numerator.bit_length() - value.denominator.bit_length()
    if abs(bits) < LARGEST_EXPONENT:  # 2^15 is far within; the exact comparison takes longer
        return True
    size, largest = abs(Fraction(value)), 10**LARGEST_EXPONENT
    return size == 0 or Fraction(1, largest) <= size <= largest


def places_of(value: Fraction | int) -> int:
    """Digits after the decimal point that the writer of a value used; integers have none."""
    return value.places if isinstance(value, Written) else 0


def decimal_texts(values: Iterable[Fraction | None]) -> list[str | None]:
    """Exact numbers for programs; ``None`` stays ``None``."""
    return [None if value is None else decimal_text(value) for value in values]


def round_down(value: Fraction, places: int) -> Fraction:
    """The largest decimal with so many places that is not above ``value``."""
    scale = 10**places
    return Fraction((value.numerator * scale) // value.denominator, scale)


def significant_down(value: Fraction, digits: int) -> Fraction:
    """The largest decimal of so many significant digits that is not above a number ≥ 0."""
    return Fraction(significant(value, digits, ROUND_FLOOR))


def significant_up(value: Fraction, digits: int) -> Fraction:
    """The smallest decimal of so many significant digits that is not below a number ≥ 0."""
    return Fraction(significant(value, digits, ROUND_CEILING))


def decimal_text(value: Fraction | int, places: int | None = None) -> str:
    """The value as a terminating decimal where it has one, as a fraction otherwise.

    With ``places`` the decimal is padded with zeros to that many places.
    """
    numerator, denominator = value.numerator, value.denominator
    needed = _terminating_places(denominator)
    if needed is None:
        return f"{numerator}/{denominator}"
    digits = max(needed, places or 0)
    return scaled_text(numerator * 10**digits // denominator, digits)


@lru_cache(maxsize=256)
def _terminating_places(denominator: int) -> int | None:
    twos = (denominator & -denominator).bit_length() - 1
    rest, fives = denominator >> twos, 0
    while rest % 5 == 0:
        rest, fives = rest // 5, fives + 1
    return max(twos, fives) if rest == 1 else None
