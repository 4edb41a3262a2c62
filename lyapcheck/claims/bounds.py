"""Rational bounds that a proof script states about numbers and robots; the claims made with them are decided.

What these functions hand back is a proposal: a claim that uses a wrong one is refuted or stays open.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable
from fractions import Fraction

from flint import ctx

from lyapcheck.check.certificates.rules.trigonometric import largest, lowest
from lyapcheck.check.enclosure import Enclosure
from lyapcheck.check.functions import ball
from lyapcheck.claims.expressions import Expr, expr

BITS = 128
DIGITS = 4
HALVINGS = 60


def above(value: object, digits: int = DIGITS) -> Fraction:
    """The decimal number of so many places that is at least a number, and nearest to it."""
    with ctx.workprec(BITS):
        upper = Enclosure.from_arb(ball(expr(value).tree)).upper
    return _ceiling(upper * 10**digits) / Fraction(10**digits)


def below(value: object, digits: int = DIGITS) -> Fraction:
    """The decimal number of so many places that is at most a number, and nearest to it."""
    return -above(-expr(value), digits)


def entry_sizes(entries: Iterable[Expr]) -> list[Fraction]:
    """For each polynomial in sines and cosines a number that its absolute value does not exceed."""
    return [largest(entry.tree) for entry in entries]


def entry_floors(entries: Iterable[Expr]) -> list[Fraction]:
    """For each polynomial in sines and cosines a number that it does not fall below."""
    return [lowest(entry.tree) for entry in entries]


def largest_with(holds: Callable[[Fraction], bool], start: object = 1) -> Fraction | None:
    """The largest positive number, to six digits, up to which a condition that is lost once holds.

    Args:
        holds: the condition; true for every smaller positive number where it is true.
        start: where to begin.

    Returns:
        ``None`` where the condition is met neither by ``start`` nor by its halves.
    """
    low = Fraction(expr(start).tree[1])
    for _ in range(HALVINGS):
        if holds(low):
            break
        low /= 2
    else:
        return None
    high = 2 * low
    while high - low > low / 10**6:
        middle = (low + high) / 2
        low, high = (middle, high) if holds(middle) else (low, middle)
    return low.limit_denominator(_ceiling(10**7 / low))


def _ceiling(value: Fraction) -> int:
    return -(-value.numerator // value.denominator)
