"""The hyperbolic family by definition: h_m, its derivative, U_m; γ_m, ρ_m, L_m by a search."""

from __future__ import annotations

from fractions import Fraction
from functools import lru_cache
from typing import Any

from mpmath import mp, mpf

from tests.statement_fuzz.oracle import exact
from tests.statement_fuzz.oracle.functions import apply
from tests.statement_fuzz.oracle.numbers import Num, Unsure, Value, divide, power

ACCURATE = mpf(10) ** -50
LARGEST = 60


def member(kind: str, m: int, x: Value) -> Value:
    """h_m = s^(2m−1) c/(1 + s^(2m)), h_m' and U_m = ln(1 + s^(2m))/(2m), with s = sinh x, c = cosh x."""
    if m > LARGEST:
        raise Unsure
    s, c = _plain(apply("sinh", x)), _plain(apply("cosh", x))
    bottom = power(s, 2 * m) + Fraction(1)
    if kind == "h":
        return divide(power(s, 2 * m - 1) * c, bottom)
    if kind == "potential":
        return apply("log", bottom) * Fraction(1, 2 * m)
    slope = power(s, 2 * m) + power(s, 2 * m - 2) * power(c, 2) * Fraction(2 * m - 1)
    top = slope * bottom - power(s, 4 * m - 2) * power(c, 2) * Fraction(2 * m)
    return divide(top, power(bottom, 2))


def _plain(value: Value) -> Value:
    """A number without its exact form, which would grow long."""
    return value if isinstance(value, Fraction) else Num(value.low, value.high)


def constant(kind: str, m: int) -> Value:
    """γ_m = sup h_m, ρ_m = sup |h_m'|, L_m = sup h_m(x)/x; all 1 for m = 1."""
    if m == 1:
        return Fraction(1)
    if m > LARGEST:
        raise Unsure
    near = _largest(kind, m)
    return Num(near - ACCURATE, near + ACCURATE, exact.atom(kind, m))


@lru_cache(maxsize=256)
def _largest(kind: str, m: int) -> Any:
    with mp.workdps(110):

        def size(x: Any) -> Any:
            s, c = mp.sinh(x), mp.cosh(x)
            bottom = 1 + s ** (2 * m)
            if kind == "rho":
                slope = s ** (2 * m) + (2 * m - 1) * s ** (2 * m - 2) * c**2
                return abs((slope * bottom - 2 * m * s ** (4 * m - 2) * c**2) / bottom**2)
            result = s ** (2 * m - 1) * c / bottom
            return result / x if kind == "L" else result

        # the peaks of |h'| are at distances ~1/m from asinh(1)
        with mp.workdps(20):
            grid = [mpf(k) / 200 for k in range(1, 1200)]
            best = max(grid, key=size)
        low, high = best - mpf(1) / 200, best + mpf(1) / 200
        for _ in range(340):
            third = (high - low) / 3
            if size(low + third) < size(high - third):
                low = low + third
            else:
                high = high - third
        return size((low + high) / 2)
