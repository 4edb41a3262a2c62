"""The constants γ_m, ρ_m and L_m of the hyperbolic family, enclosed to any number of digits."""

from __future__ import annotations

from dataclasses import dataclass
from functools import lru_cache
from math import ceil, log

from flint import arb, ctx

from lyapcheck.check.numbers.critical import peak_of_h, peak_of_secant, peaks_of_dh, power
from lyapcheck.check.numbers.enclosure import Enclosure


@dataclass(frozen=True)
class Constants:
    """γ = sup h, ρ = sup |h'|, L = sup h(x)/x over x > 0, and the x at which each is reached.

    A supremum that is reached only in the limit x → ∞ has no place: ``None``.
    """

    m: int
    gamma: Enclosure
    rho: Enclosure
    L: Enclosure
    gamma_at: Enclosure | None
    rho_at: Enclosure | None
    L_at: Enclosure | None


@lru_cache(maxsize=4096)
def hyperbolic_constants(m: int, digits: int = 30) -> Constants:
    """γ_m, ρ_m and L_m of the hyperbolic family, each to ``digits`` significant digits or better.

    m = 1 is tanh: γ = 1 is the limit at infinity, ρ = L = 1 belong to x = 0. For m >= 2 all are reached.

    Args:
        m: the member of the family, m >= 1.
        digits: decimal digits that the enclosures resolve.

    Raises:
        ValueError: m or digits below 1.

    Soundness: roots are bracketed by certified signs and counted by Descartes' rule; see ``critical``.

    References: ``reyes2019family`` (6), (7), (8).
    """
    if m < 1 or digits < 1:
        raise ValueError(f"m and digits must be at least 1, got m = {m}, digits = {digits}")
    if m == 1:
        one, zero = Enclosure.exact(1), Enclosure.exact(0)
        return Constants(1, one, one, one, None, zero, zero)
    with ctx.workprec(ceil(digits * log(10, 2)) + 24 + 2 * m.bit_length()):
        u = peak_of_h(m)
        rho, rho_at = _rho(m)
        x = peak_of_secant(m)
        balls = (gamma_value(m, u), rho, dh_value(m, x.sinh() ** 2), position(u), rho_at, x)
        return Constants(m, *map(Enclosure.from_arb, balls))


def _rho(m: int) -> tuple[arb, arb]:
    """sup |h'| and where it is, for m >= 2; h' vanishes at 0 and at infinity, so a root of P gives it."""
    places = peaks_of_dh(m)
    rise, fall = (abs(dh_value(m, u)) for u in places)
    if not (rise < fall or rise > fall):
        raise ArithmeticError(f"the extremes of h' for m = {m} are too close to tell which is larger")
    return (rise, position(places[0])) if rise > fall else (fall, position(places[1]))


def position(u: arb) -> arb:
    """The x > 0 with sinh²x = u."""
    return u.sqrt().asinh()


def gamma_value(m: int, u: arb) -> arb:
    """γ_m from the u at which it is reached: u^m = 2m u + 2m - 1 takes the powers out of h."""
    return (2 * m * (1 + u) - 1) / (2 * m * (u * (1 + u)).sqrt())


def dh_value(m: int, u: arb) -> arb:
    """h_m' as a function of u = sinh²x > 0."""
    p = power(u, m)
    return p * (2 * m - 1 + 2 * m * u - p) / (u * (1 + p) ** 2)
