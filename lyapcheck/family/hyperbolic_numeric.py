"""h_m, h_m', U_m and h_m(x)/x in doubles, within 4 units in the last place for all x and all m up to 1000.

Powers up to 2m magnify a relative error 2m times, so sinh x and its powers are carried as pairs of doubles.
Each form has two branches, joined at sinh|x| = 1:

- near: s = x · (sinh x)/x from its Taylor series, and powers of s <= 1;
- far: r = 1/sinh|x| from e^(-|x|), which never overflows, and powers of r <= 1.

The zero of h' gets its own expansion, see ``hyperbolic_peak``. Factors that exceed 1 are multiplied in before
the small ones, so that a result in the subnormal range is rounded once and at the end.
"""

from __future__ import annotations

from collections.abc import Callable
from fractions import Fraction
from math import factorial
from typing import Any

from lyapcheck.family.arithmetic import Arithmetic
from lyapcheck.family.double_double import (
    ONE,
    Pair,
    Powers,
    add,
    divide,
    exact_product,
    exact_sum,
    horner,
    multiply,
    negative,
    pair_of,
    scale,
    square,
    square_root,
)
from lyapcheck.family.hyperbolic_peak import dh_at_peak

BORDER = 0.8813735870195430
"""The double nearest to asinh 1, where the branches meet."""

_BEYOND = 400.0
"""From here on r² = 1/sinh² is zero in doubles."""

_LN2 = (0.693147180559890330187045037746429443359375, 5.497923018708371174e-14)
"""ln 2: its first 42 bits, of which 1000 times are exact, and the rest."""

_LN2_HIGH, _LN2_LOW = 0.6931471805599453, 2.3190468138462996e-17

Value = Any
Form = Callable[[Arithmetic, int, Any], Value]


def _pairs(count: int, term: Callable[[int], int]) -> tuple[Pair, ...]:
    return tuple(pair_of(Fraction(1, term(k))) for k in range(count))


_SINHC = _pairs(4, lambda k: factorial(2 * k + 1))
_SINHC_TAIL = tuple(1.0 / factorial(2 * k + 1) for k in range(4, 13))
_EXP = _pairs(7, factorial)
_EXP_TAIL = tuple(1.0 / factorial(k) for k in range(7, 19))


class Near:
    """sinh x and what is made of it, for |x| up to the border."""

    def __init__(self, of: Arithmetic, m: int, x: Any) -> None:
        z = exact_product(x, x)
        self.sinhc = horner(z, _SINHC, _polynomial(_SINHC_TAIL, z[0]))
        s = multiply(self.sinhc, (x, 0.0))
        self.s2 = square(s)
        self.powers = Powers(self.s2, m)
        self.p = self.powers.times(ONE, m)
        self.of, self.m, self.x = of, m, x

    def secant(self) -> Pair:
        """(sinh x)/x · cosh x / (1 + s^(2m)) · s^(2m-2)."""
        cosh = square_root(add(ONE, self.s2), self.of.sqrt)
        start = divide(multiply(self.sinhc, cosh), add(ONE, self.p))
        return self.powers.times(start, self.m - 1)

    def h(self) -> Pair:
        """x times the secant."""
        return multiply(self.secant(), (self.x, 0.0))

    def dh(self) -> Pair:
        """(2m-1 + 2m s² - s^(2m)) / (1 + s^(2m))² · s^(2m-2)."""
        m = self.m
        bracket = add(add((2.0 * m - 1, 0.0), multiply((2.0 * m, 0.0), self.s2)), negative(self.p))
        return self.powers.times(divide(bracket, square(add(ONE, self.p))), m - 1)

    def potential(self) -> Pair:
        """ln(1 + s^(2m)) / (2m)."""
        return log1p(self.of, self.p) / (2.0 * self.m), 0.0


class Far:
    """1/sinh a and what is made of it, for a = |x| from the border on."""

    def __init__(self, of: Arithmetic, m: int, a: Any) -> None:
        e, half = _exp_negative(of, of.smaller(a, _BEYOND))
        t2 = scale(square(e), half * half)
        self.above, self.below = add(ONE, t2), add(ONE, negative(t2))
        self.r = scale(divide(e, self.below), 2.0 * half)
        self.r2 = square(self.r)
        self.powers = Powers(self.r2, m)
        self.q = self.powers.times(ONE, m)
        self.of, self.m, self.a = of, m, a

    def h(self) -> Pair:
        """coth a / (1 + r^(2m))."""
        return divide(self.above, multiply(self.below, add(ONE, self.q)))

    def secant(self) -> Pair:
        """h(a)/a."""
        return self.h()[0] / self.a, 0.0

    def dh(self) -> Pair:
        """((2m-1) r^(2m) + 2m r^(2m-2) - 1) / (1 + r^(2m))² · r²."""
        m = self.m
        weight = add((2.0 * m, 0.0), multiply((2.0 * m - 1, 0.0), self.r2))
        bracket = add(self.powers.times(weight, m - 1), (-1.0, 0.0))
        away = divide(bracket, square(add(ONE, self.q)))
        value = multiply(multiply(away, self.r), self.r)
        return dh_at_peak(self.of, m, self.a, value[0]), 0.0

    def potential(self) -> Pair:
        """ln sinh a + ln(1 + r^(2m)) / (2m), where ln sinh a is a - ln 2 for large a."""
        log_sinh = -self.of.log(self.r[0]) - self.r[1] / self.r[0]
        near = log_sinh + log1p(self.of, self.q) / (2.0 * self.m)
        return self.of.where(self.a > 40.0, (self.a - _LN2_HIGH) - _LN2_LOW, near), 0.0


def log1p(of: Arithmetic, p: Pair) -> Any:
    """ln(1 + p) of a pair 0 <= p <= 1, by the logarithm alone."""
    w, rest = exact_sum(1.0, p[0])
    return of.log(w) + (rest + p[1]) / w


def _exp_negative(of: Arithmetic, a: Any) -> tuple[Pair, Any]:
    """e^(-a) as a pair in [0.7, 1.42] and a power of two, for 0.5 < a < 600."""
    k = of.nearest(a * 1.4426950408889634)
    g = exact_sum(k * _LN2[0] - a, k * _LN2[1])
    return horner(g, _EXP, _polynomial(_EXP_TAIL, g[0])), of.two_to(-k)


def _polynomial(coefficients: tuple[float, ...], z: Any) -> Any:
    total: Any = coefficients[-1]
    for coefficient in reversed(coefficients[:-1]):
        total = coefficient + z * total
    return total
