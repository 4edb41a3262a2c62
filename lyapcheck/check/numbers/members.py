"""The bounded functions h that controllers may use, as the checker knows them: h, h' in balls, γ, ρ and L.

References: ``reyes2019family`` (6), (7), (8).
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from fractions import Fraction
from functools import cache, lru_cache, partial
from importlib import import_module
from pathlib import Path
from pkgutil import iter_modules

from flint import arb

from lyapcheck.check.numbers import balls
from lyapcheck.check.numbers.polynomials import Enclosure

Value = Callable[[arb], arb]


@dataclass(frozen=True)
class Functions:
    """h, h' and U with U' = h, U(0) = 0, each a map of balls that contains."""

    h: Value
    dh: Value
    potential: Value


@dataclass(frozen=True)
class Member(Functions):
    """An odd, bounded h, once continuously differentiable, positive for x > 0, with its bounds from above.

    It does not tend to 0 as x grows: U is unbounded, and h(x) → 0 only as x → 0.

    Args:
        gamma: at least sup h.
        rho: at least sup |h'|.
        L: at least sup h(x)/x.
    """

    gamma: Fraction
    rho: Fraction
    L: Fraction


def hyperbolic(m: int | None) -> Member:
    """h_m = sinh^(2m-1)x cosh x / (1 + sinh^(2m)x), for m >= 1."""
    if not isinstance(m, int) or m < 1:
        raise unknown("hyperbolic", m)
    known = balls.hyperbolic_constants(m)
    h, dh, potential = (partial(f, m) for f in (balls.h, balls.dh, balls.potential))
    return Member(h, dh, potential, known.gamma.upper, known.rho.upper, known.L.upper)


def tanh(m: int | None) -> Member:
    """The hyperbolic tangent: the hyperbolic family at m = 1, under its own name."""
    require_single("tanh", m)
    return hyperbolic(1)


def algebraic(m: int | None) -> Member:
    """x/√(1 + x²), its U without cancellation; γ = 1 in the limit."""
    require_single("algebraic", m)

    def root(a: arb) -> arb:
        return (1 + a * a).sqrt()

    return _rising(
        lambda a: a / root(a),
        lambda a: 1 / ((1 + a * a) * root(a)),
        lambda a: a * a / (1 + root(a)),
        Fraction(1),
    )


def arctan(m: int | None) -> Member:
    """The inverse tangent; γ = π/2 in the limit."""
    require_single("arctan", m)
    half_pi = Enclosure.from_arb(arb.pi() / 2).upper
    return _rising(arb.atan, lambda a: 1 / (1 + a * a), lambda a: a * a.atan() - (a * a).log1p() / 2, half_pi)


def _rising(h: Value, dh: Value, potential: Value, gamma: Fraction) -> Member:
    """One that rises, by values at x ≥ 0, with a slope that falls away from 0, from 1 there: ρ = L = 1."""
    return Member(
        lambda x: balls.odd_range(h, (), x),
        lambda x: balls.even_range(dh, (), x),
        lambda x: balls.even_range(potential, (), x),
        gamma=gamma,
        rho=Fraction(1),
        L=Fraction(1),
    )


KNOWN = {create.__name__: create for create in (hyperbolic, tanh, algebraic, arctan)}


@lru_cache(maxsize=256)
def member(name: str, m: int | None = None) -> Member:
    """A function by its name, or that of a file in ``functions``, with its m if it has one.

    Raises:
        ValueError: it is not known.
    """
    create = _creators().get(name)
    if create is None:
        raise unknown(name, m)
    return create(m)


@cache
def _creators() -> dict[str, Callable[[int | None], Member]]:
    """What makes each function: every file of the folder is imported, whatever a certificate names."""
    from lyapcheck.check.numbers import functions

    files = iter_modules([str(Path(functions.__file__).parent)])
    own = {file.name: import_module(f"{functions.__name__}.{file.name}").create for file in files}
    return own | KNOWN


def member_text(name: str, m: int | None) -> str:
    """``tanh``, ``hyperbolic_2``."""
    return name if m is None else f"{name}_{m}"


def require_single(name: str, m: int | None) -> None:
    """Refuse an m for a function that has a single member.

    Raises:
        ValueError: there is one.
    """
    if m is not None:
        raise unknown(name, m)


def unknown(name: str, m: int | None) -> ValueError:
    """What is raised for a function that there is not."""
    return ValueError(f"no bounded function {name!r} with m = {m} is known to the checker")
