"""The inverse tangent."""

from __future__ import annotations

from fractions import Fraction

from flint import arb

from lyapcheck.check.numbers import balls
from lyapcheck.check.numbers.members import Member, require_single
from lyapcheck.check.numbers.polynomials import Enclosure


def create(m: int | None) -> Member:
    """h = arctan x; γ = π/2 in the limit, ρ = L = 1 at 0."""
    require_single("arctan", m)
    return Member(
        h, dh, potential, gamma=half_pi().upper, rho=Fraction(1), L=Fraction(1), d2h=d2h, bends=bends
    )


def h(x: arb) -> arb:
    """arctan x, rising."""
    return balls.odd_range(arb.atan, (), x)


def dh(x: arb) -> arb:
    """1/(1 + x²), falling away from 0."""
    return balls.even_range(lambda a: 1 / (1 + a * a), (), x)


def d2h(x: arb) -> arb:
    """−2x/(1 + x²)²."""
    (place,) = bends()
    return balls.odd_range(_d2h, ((place, _d2h(place)),), x)


def bends() -> tuple[arb, ...]:
    """Where h'' is least."""
    return (1 / arb(3).sqrt(),)


def _d2h(a: arb) -> arb:
    return -2 * a / (1 + a * a) ** 2


def potential(x: arb) -> arb:
    """x arctan x − ½ ln(1 + x²), rising away from 0."""
    return balls.even_range(lambda a: a * a.atan() - (a * a).log1p() / 2, (), x)


def half_pi() -> Enclosure:
    """π/2 at the precision in force."""
    return Enclosure.from_arb(arb.pi() / 2)
