"""The bounded functions h that controllers may use, as the checker knows them: h, h' in balls, γ, ρ and L.

References: ``reyes2019family`` (6), (7), (8).
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from fractions import Fraction
from functools import lru_cache, partial

from flint import arb

from lyapcheck.check.numbers import balls
from lyapcheck.check.numbers.constants import hyperbolic_constants
from lyapcheck.check.numbers.enclosure import Enclosure


@dataclass(frozen=True)
class Functions:
    """h, h' and U of one variable, each a map of balls that contains."""

    h: Callable[[arb], arb]
    dh: Callable[[arb], arb]
    potential: Callable[[arb], arb]


@dataclass(frozen=True)
class Member:
    """An odd, bounded h with its bounds from above.

    Args:
        h: contains h over a ball, dimensionless.
        dh: contains h' over a ball.
        potential: contains U over a ball, U' = h, U(0) = 0.
        secant: contains h(x)/x over a ball, h'(0) at x = 0.
        gamma: at least sup h.
        rho: at least sup |h'|.
        L: at least sup h(x)/x.
    """

    h: Callable[[arb], arb]
    dh: Callable[[arb], arb]
    potential: Callable[[arb], arb]
    secant: Callable[[arb], arb]
    gamma: Fraction
    rho: Fraction
    L: Fraction

    @property
    def functions(self) -> Functions:
        """h, h' and U, for the derivative of V at one state."""
        return Functions(self.h, self.dh, self.potential)


@lru_cache(maxsize=256)
def member(name: str, m: int | None = None) -> Member:
    """A function by name: ``hyperbolic`` with its m, ``tanh``, ``arctan`` or ``algebraic`` (x/√(1+x²)).

    Raises:
        ValueError: no such function, or an m where there is none to choose, or none where there is.
    """
    if name == "hyperbolic" and isinstance(m, int) and m >= 1:
        return _hyperbolic(m)
    if m is None and name in _SINGLE:
        return _SINGLE[name]()
    raise ValueError(f"no bounded function {name!r} with m = {m} is known to the checker")


def _hyperbolic(m: int) -> Member:
    found = hyperbolic_constants(m)
    bounds = found.gamma.upper, found.rho.upper, found.L.upper
    h, dh, potential, secant = (partial(f, m) for f in (balls.h, balls.dh, balls.potential, balls.secant))
    return Member(h, dh, potential, secant, *bounds)


def arctan_h(x: arb) -> arb:
    """arctan x, rising."""
    return balls.odd_range(arb.atan, (), x)


def arctan_dh(x: arb) -> arb:
    """1/(1 + x²), falling away from 0."""
    return balls.even_range(lambda a: 1 / (1 + a * a), (), x)


def arctan_potential(x: arb) -> arb:
    """x arctan x − ½ ln(1 + x²), rising away from 0."""
    return balls.even_range(lambda a: a * a.atan() - (a * a).log1p() / 2, (), x)


def arctan_secant(x: arb) -> arb:
    """arctan(x)/x, falling away from 0."""
    return balls.even_range(lambda a: arb(1) if a == 0 else a.atan() / a, (), x)


def half_pi() -> Enclosure:
    """π/2 at the precision in force."""
    return Enclosure.from_arb(arb.pi() / 2)


def algebraic_h(x: arb) -> arb:
    """x/√(1 + x²), rising."""
    return balls.odd_range(lambda a: a / (1 + a * a).sqrt(), (), x)


def algebraic_dh(x: arb) -> arb:
    """(1 + x²)^(−3/2), falling away from 0."""
    return balls.even_range(lambda a: 1 / ((1 + a * a) * (1 + a * a).sqrt()), (), x)


def algebraic_potential(x: arb) -> arb:
    """√(1 + x²) − 1, without cancellation, rising away from 0."""
    return balls.even_range(lambda a: a * a / (1 + (1 + a * a).sqrt()), (), x)


def algebraic_secant(x: arb) -> arb:
    """1/√(1 + x²), falling away from 0."""
    return balls.even_range(lambda a: 1 / (1 + a * a).sqrt(), (), x)


def _arctan() -> Member:
    return Member(
        arctan_h, arctan_dh, arctan_potential, arctan_secant, half_pi().upper, Fraction(1), Fraction(1)
    )


def _algebraic() -> Member:
    return Member(
        algebraic_h,
        algebraic_dh,
        algebraic_potential,
        algebraic_secant,
        Fraction(1),
        Fraction(1),
        Fraction(1),
    )


_SINGLE: dict[str, Callable[[], Member]] = {
    "tanh": lambda: _hyperbolic(1),
    "arctan": _arctan,
    "algebraic": _algebraic,
}
