"""Numbers of the oracle, ``Fraction`` or interval of many digits; elementary functions; the family h_m.

An interval around 0 that 1,000 digits do not tell from 0 is taken for 0; large arguments are not judged so.
"""

from fractions import Fraction
from functools import lru_cache
from math import isqrt

from mpmath import mp, mpf

DIGITS, MORE = 60, 1_000
TINY = mpf(10) ** -800
SPARE = 4
"""Decimal digits by which every result is widened."""
MAX_BITS = 200_000
LARGEST, MODERATE = mpf(10) ** 1000, 700
LARGEST_M = 60


class Undefined(Exception):
    """The expression certainly has no value."""


class Unsure(Exception):
    """The arithmetic cannot tell."""


class Num:
    """A real number between ``low`` and ``high``."""

    __slots__ = ("high", "low")

    def __init__(self, low, high):
        self.low, self.high = low, high

    def __add__(self, other):
        other = lifted(other)
        return made(self.low + other.low, self.high + other.high)

    __radd__ = __add__

    def __neg__(self):
        return Num(-self.high, -self.low)

    def __sub__(self, other):
        return self + (-other)

    def __rsub__(self, other):
        return -self + other

    def __mul__(self, other):
        other = lifted(other)
        ends = [a * b for a in (self.low, self.high) for b in (other.low, other.high)]
        return made(min(ends), max(ends))

    __rmul__ = __mul__


def lifted(value):
    """Any number as an interval."""
    if isinstance(value, Num):
        return value
    near = mpf(value.numerator) / value.denominator
    return Num(near - _width(near), near + _width(near))


def interval(low, high):
    """A number somewhere between two rationals."""
    return Num(lifted(low).low, lifted(high).high)


def made(low, high):
    """An interval widened by what rounding may have cost."""
    if not (mp.isfinite(low) and mp.isfinite(high)):
        raise Unsure
    low, high = low - _width(low), high + _width(high)
    if mp.dps >= MORE and low <= 0 <= high and max(-low, high) < TINY:
        return Fraction(0)
    return Num(low, high)


def _width(end):
    return abs(end) * mpf(10) ** (SPARE - mp.dps)


def sign(value):
    """The sign of a number; raises ``Unsure`` where it is too close to 0."""
    if not isinstance(value, Num):
        return (value > 0) - (value < 0)
    if value.low > 0 or value.high < 0:
        return 1 if value.low > 0 else -1
    raise Unsure


def divide(a, b):
    """The quotient; ``Undefined`` by 0."""
    if sign(b) == 0:
        raise Undefined("division by 0")
    if not isinstance(a, Num) and not isinstance(b, Num):
        return Fraction(a) / b
    b = lifted(b)
    low, high = 1 / b.high, 1 / b.low
    return Num(low - _width(low), high + _width(high)) * a


def power(base, k):
    """``base`` multiplied k times; 1 for k = 0."""
    if k == 0:
        return Fraction(1)
    if not isinstance(base, Num):
        if max(base.numerator.bit_length(), base.denominator.bit_length()) * k <= MAX_BITS:
            return base**k
        base = lifted(base)
    if k % 2 == 0 and base.low < 0 < base.high:
        return made(mpf(0), max(-base.low, base.high) ** k)
    return made(*sorted((base.low**k, base.high**k)))


# Elementary functions, each with its domain -----------------------------------------------------------------

AT_ZERO = {"exp": 1, "cos": 1, "cosh": 1, "sin": 0, "tan": 0, "sinh": 0, "tanh": 0, "atan": 0, "asin": 0}


def apply(name, x):
    """A function of a number; ``Undefined`` outside the domain, ``Unsure`` where it may be."""
    if x == 0 and name in AT_ZERO:
        return Fraction(AT_ZERO[name])
    return BY_NAME[name](x) if name in BY_NAME else _monotone(name, lifted(x))


def _monotone(name, x):
    _moderate(x, name)
    ends = sorted(getattr(mp, name)(end) for end in (x.low, x.high))
    if name == "cosh" and x.low < 0 < x.high:
        ends[0] = mpf(1)
    return made(*ends)


def _moderate(x, name):
    most = MODERATE if mp.dps >= MORE and name in ("exp", "sinh", "cosh", "tanh") else LARGEST
    if max(abs(x.low), abs(x.high)) > most:
        raise Unsure


def _absolute(x):
    if isinstance(x, Num) and x.low < 0 < x.high:
        return made(mpf(0), max(-x.low, x.high))
    return -x if (x.low < 0 if isinstance(x, Num) else x < 0) else x


def _root(x):
    if not (isinstance(x, Num) and x.low >= 0) and sign(x) < 0:
        raise Undefined("the root of a negative number")
    if not isinstance(x, Num):
        top, bottom = isqrt(x.numerator), isqrt(x.denominator)
        if top**2 == x.numerator and bottom**2 == x.denominator:
            return Fraction(top, bottom)
    x = lifted(x)
    return made(mp.sqrt(max(x.low, 0)), mp.sqrt(x.high))


def _logarithm(x):
    if sign(x) <= 0:
        raise Undefined("the logarithm of a number that is not positive")
    return Fraction(0) if x == 1 else _monotone("log", lifted(x))


def _circular(name, x):
    x = lifted(x)
    _moderate(x, name)
    at, reach = getattr(mp, name)((x.low + x.high) / 2), (x.high - x.low) / 2
    return made(max(at - reach, mpf(-1)), min(at + reach, mpf(1)))


def _tangent(x):
    if sign(apply("cos", x)) == 0:
        raise Undefined("the tangent where the cosine vanishes")
    x = lifted(x)
    if x.high - x.low > 3:
        raise Unsure
    return made(mp.tan(x.low), mp.tan(x.high))


def _arc(name, x):
    if sign(1 - _absolute(x)) < 0:
        raise Undefined("an arc of a number above 1")
    x = lifted(x)
    return made(*sorted(getattr(mp, name)(max(min(end, mpf(1)), mpf(-1))) for end in (x.low, x.high)))


BY_NAME = {
    **{"abs": _absolute, "sqrt": _root, "log": _logarithm, "tan": _tangent},
    **{name: lambda x, name=name: _circular(name, x) for name in ("sin", "cos")},
    **{name: lambda x, name=name: _arc(name, x) for name in ("asin", "acos")},
}


def pi():
    """π."""
    return made(+mp.pi, +mp.pi)


def ends(value):
    """The ends of a number as an interval."""
    wide = lifted(value)
    return wide.low, wide.high


# The family h_m ---------------------------------------------------------------------------------------------


def family(kind, m, x, lib):
    """h_m = s^(2m−1) c/(1 + s^(2m)) of s = sinh x, c = cosh x; its slope; U_m = ln(1 + s^(2m))/(2m)."""
    s, c = lib.sinh(x), lib.cosh(x)
    bottom = 1 + s ** (2 * m)
    if kind == "h":
        return s ** (2 * m - 1) * c / bottom
    if kind == "potential":
        return lib.log(bottom) / (2 * m)
    slope = s ** (2 * m) + (2 * m - 1) * s ** (2 * m - 2) * c**2
    return (slope * bottom - 2 * m * s ** (4 * m - 2) * c**2) / bottom**2


def member(kind, m, x):
    """The same of a number of the oracle."""
    if m > LARGEST_M:
        raise Unsure
    s, c = apply("sinh", x), apply("cosh", x)
    bottom = power(s, 2 * m) + Fraction(1)
    if kind == "h":
        return divide(power(s, 2 * m - 1) * c, bottom)
    if kind == "potential":
        return apply("log", bottom) * Fraction(1, 2 * m)
    slope = power(s, 2 * m) + power(s, 2 * m - 2) * power(c, 2) * Fraction(2 * m - 1)
    top = slope * bottom - power(s, 4 * m - 2) * power(c, 2) * Fraction(2 * m)
    return divide(top, power(bottom, 2))


def constant(kind, m):
    """γ_m = sup h_m, ρ_m = sup |h_m'|, L_m = sup h_m(x)/x; all 1 for m = 1."""
    if m == 1:
        return Fraction(1)
    if m > LARGEST_M:
        raise Unsure
    near = supremum(kind, m, mp.dps)
    return Num(near * (1 - mpf(10) ** (8 - mp.dps)), near * (1 + mpf(10) ** (8 - mp.dps)))


@lru_cache(maxsize=256)
def supremum(kind, m, digits):
    """The constant in so many digits: the best place of a grid, then a root of the derivative."""
    with mp.workdps(digits + 10):

        def size(x):
            value = family("dh" if kind == "rho" else "h", m, x, mp)
            return value / x if kind == "L" else abs(value)

        with mp.workdps(20):
            best = max((mpf(k) / 200 for k in range(1, 1200)), key=size)
        ends = best - mpf(1) / 200, best + mpf(1) / 200
        return size(mp.findroot(lambda x: mp.diff(size, x), ends, "anderson", maxsteps=200, verify=False))
