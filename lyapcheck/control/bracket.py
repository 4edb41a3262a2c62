"""A real number between two integers over a common denominator, and its digits."""

from __future__ import annotations

from fractions import Fraction

from lyapcheck.files.decimals import scaled_text


class Bracket:
    """The closed interval [low/den, high/den], den > 0, that holds one real number.

    Soundness: whoever makes a bracket vouches that the number lies inside.
    """

    __slots__ = ("_decimals", "_digits", "den", "high", "low")

    def __init__(self, low: int, high: int, den: int) -> None:
        self.low, self.high, self.den = low, high, den
        self._digits: dict[int, str] = {}
        self._decimals: dict[int, tuple[str, str]] = {}

    def __eq__(self, other: object) -> bool:
        if not isinstance(other, Bracket):
            return NotImplemented
        return (self.lower, self.upper) == (other.lower, other.upper)

    def __hash__(self) -> int:
        return hash((self.lower, self.upper))

    def __repr__(self) -> str:
        return f"Bracket({self.low}, {self.high}, {self.den})"

    @classmethod
    def exact(cls, value: Fraction) -> Bracket:
        """The bracket of a number that is known exactly."""
        return cls(value.numerator, value.numerator, value.denominator)

    @property
    def lower(self) -> Fraction:
        """The lower end."""
        return Fraction(self.low, self.den)

    @property
    def upper(self) -> Fraction:
        """The upper end."""
        return Fraction(self.high, self.den)

    @property
    def width(self) -> Fraction:
        """``upper - lower``."""
        return Fraction(self.high - self.low, self.den)

    def side(self, value: Fraction) -> int:
        """Where a rational lies: -1 below the number for certain, 1 above it, 0 within the bracket."""
        scaled = value.numerator * self.den
        if scaled < self.low * value.denominator:
            return -1
        return 1 if scaled > self.high * value.denominator else 0

    def decimals(self, digits: int) -> tuple[str, str]:
        """Decimal strings of so many significant digits, rounded outward; short exact numbers as they are."""
        if digits not in self._decimals:
            self._decimals[digits] = self._rounded(digits)
        return self._decimals[digits]

    def _rounded(self, digits: int) -> tuple[str, str]:
        places = self._places(digits)
        scale = 10**places
        low, high = self.low * scale // self.den, -(-self.high * scale // self.den)
        if self.low == self.high and low == high:
            return (_shortest(low, places),) * 2
        return scaled_text(low, places), scaled_text(high, places)

    def correct_digits(self, digits: int) -> str:
        """The leading digits of the number, at most so many and all correct: cut off, never rounded.

        ``[lower, upper]`` where not even one digit is certain.
        """
        if digits not in self._digits:
            self._digits[digits] = self._correct_digits(digits)
        return self._digits[digits]

    def _correct_digits(self, digits: int) -> str:
        written = self.decimals(digits)
        if written[0] == written[1]:
            return written[0]
        for shown in range(digits, 0, -1):
            places = self._places(shown)
            low, high = (_truncated(end * 10**places, self.den) for end in (self.low, self.high))
            if low == high and low != 0:
                return scaled_text(low, places)
        return "[{}, {}]".format(*written)

    def _places(self, digits: int) -> int:
        """The decimal places that so many significant digits reach, at the larger end; never below 0."""
        size = max(abs(self.low), abs(self.high))
        if size == 0:
            return max(0, digits - 1)
        if size >= self.den:
            return max(0, digits - len(str(size // self.den)))
        zeros = 0
        while size * 10 < self.den:
            size, zeros = size * 10, zeros + 1
        return digits + zeros


def _truncated(numerator: int, denominator: int) -> int:
    whole = abs(numerator) // denominator
    return -whole if numerator < 0 else whole


def _shortest(scaled: int, places: int) -> str:
    """The decimal without zeros that say nothing."""
    text = scaled_text(scaled, places)
    return text.rstrip("0").rstrip(".") if "." in text else text
