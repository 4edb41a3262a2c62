"""Sums and products of doubles with about 100 correct bits, for floats, NumPy arrays and CasADi graphs alike.

A pair (hi, lo) stands for the unevaluated sum hi + lo with |lo| at most half a unit in the last place of hi.
The error terms are exact in IEEE arithmetic while nothing over- or underflows; on the way to an underflow
they lose bits of lo only. A CasADi graph must be built with ``exact_graph`` around it, because CasADi would
otherwise simplify the error terms to zero.

References: T. J. Dekker, Numerische Mathematik 18 (1971) 224-242.
"""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import contextmanager
from fractions import Fraction
from typing import Any

Pair = tuple[Any, Any]

ONE: Pair = (1.0, 0.0)
_SPLITTER = 134217729.0  # 2^27 + 1


def pair_of(value: Fraction) -> Pair:
    """The pair nearest to a rational number."""
    hi = float(value)
    return hi, float(value - Fraction(hi))


def quick_sum(a: Any, b: Any) -> Pair:
    """a + b with its rounding error, for |a| >= |b|."""
    s = a + b
    return s, b - (s - a)


def exact_sum(a: Any, b: Any) -> Pair:
    """a + b with its rounding error."""
    s = a + b
    t = s - a
    return s, (a - (s - t)) + (b - t)


def exact_product(a: Any, b: Any) -> Pair:
    """a · b with its rounding error."""
    p = a * b
    a_hi, a_lo = _split(a)
    b_hi, b_lo = _split(b)
    return p, ((a_hi * b_hi - p) + a_hi * b_lo + a_lo * b_hi) + a_lo * b_lo


def _split(a: Any) -> Pair:
    c = _SPLITTER * a
    hi = c - (c - a)
    return hi, a - hi


def add(x: Pair, y: Pair) -> Pair:
    """x + y."""
    s, e = exact_sum(x[0], y[0])
    return quick_sum(s, e + (x[1] + y[1]))


def multiply(x: Pair, y: Pair) -> Pair:
    """x · y."""
    p, e = exact_product(x[0], y[0])
    return quick_sum(p, e + (x[0] * y[1] + x[1] * y[0]))


def square(x: Pair) -> Pair:
    """x²."""
    p = x[0] * x[0]
    hi, lo = _split(x[0])
    return quick_sum(p, ((hi * hi - p) + 2.0 * hi * lo) + lo * lo + 2.0 * x[0] * x[1])


def divide(x: Pair, y: Pair) -> Pair:
    """x / y, by one step of long division."""
    q = x[0] / y[0]
    p, e = exact_product(q, y[0])
    rest = (x[0] - p) - e + (x[1] - q * y[1])
    return quick_sum(q, rest / y[0])


def negative(x: Pair) -> Pair:
    """-x."""
    return -x[0], -x[1]


def scale(x: Pair, factor: Any) -> Pair:
    """x times a power of two."""
    return x[0] * factor, x[1] * factor


def square_root(x: Pair, sqrt: Any) -> Pair:
    """√x of a positive pair, by one step of Newton's method."""
    root = sqrt(x[0])
    p, e = exact_product(root, root)
    return quick_sum(root, ((x[0] - p) - e + x[1]) / (2.0 * root))


def horner(z: Pair, coefficients: tuple[Pair, ...], tail: Any) -> Pair:
    """c0 + z (c1 + z (... + z tail)), the tail in plain doubles."""
    total: Pair = (tail, 0.0)
    for coefficient in reversed(coefficients):
        total = add(coefficient, multiply(z, total))
    return total


class Powers:
    """Powers of one base in [0, 1]: repeated squaring, done once for all exponents up to the largest."""

    def __init__(self, base: Pair, largest: int) -> None:
        self._squares = [base]
        for _ in range(largest.bit_length() - 2):
            self._squares.append(square(self._squares[-1]))

    def times(self, start: Pair, exponent: int) -> Pair:
        """``start · base**exponent``; large factors belong into ``start``: an underflow then comes last.

        The highest power goes in as two halves: by itself it may underflow where the product does not.
        """
        top = exponent.bit_length() - 1
        if top < 1:
            return multiply(start, self._squares[0]) if exponent else start
        result, half = start, self._squares[top - 1]
        for k in range(top):
            if exponent >> k & 1:
                result = multiply(result, self._squares[k])
        return multiply(multiply(result, half), half)


@contextmanager
def exact_graph() -> Iterator[None]:
    """Build CasADi expressions as they are written inside; the global setting is put back after."""
    import casadi as ca

    before = ca.GlobalOptions.getSimplificationOnTheFly()
    ca.GlobalOptions.setSimplificationOnTheFly(False)
    try:
        yield
    finally:
        ca.GlobalOptions.setSimplificationOnTheFly(before)
