"""The algebraic saturation x/√(1 + x²)."""

from __future__ import annotations

from fractions import Fraction

from flint import arb

from lyapcheck.check.numbers import balls
from lyapcheck.check.numbers.members import Member, require_single


def create(m: int | None) -> Member:
    """h = x/√(1 + x²); γ = 1 in the limit, ρ = L = 1 at 0."""
    require_single("algebraic", m)
    return Member(h, dh, potential, gamma=Fraction(1), rho=Fraction(1), L=Fraction(1), d2h=d2h, bends=bends)


def h(x: arb) -> arb:
    """x/√(1 + x²), rising."""
    return balls.odd_range(lambda a: a / (1 + a * a).sqrt(), (), x)


def dh(x: arb) -> arb:
    """(1 + x²)^(−3/2), falling away from 0."""
    return balls.even_range(lambda a: 1 / ((1 + a * a) * (1 + a * a).sqrt()), (), x)


def d2h(x: arb) -> arb:
    """−3x(1 + x²)^(−5/2)."""
    (place,) = bends()
    return balls.odd_range(_d2h, ((place, _d2h(place)),), x)


def bends() -> tuple[arb, ...]:
    """Where h'' is least."""
    return (arb(1) / 2,)


def _d2h(a: arb) -> arb:
    return -3 * a / ((1 + a * a) ** 2 * (1 + a * a).sqrt())


def potential(x: arb) -> arb:
    """√(1 + x²) − 1, without cancellation, rising away from 0."""
    return balls.even_range(lambda a: a * a / (1 + (1 + a * a).sqrt()), (), x)
