"""The bounded functions h that controllers may use, as the checker knows them: h, h' in balls, γ, ρ and L.

References: ``reyes2019family`` (6), (7), (8).
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from fractions import Fraction
from functools import cache, lru_cache
from importlib import import_module
from pathlib import Path
from pkgutil import iter_modules

from flint import arb


@dataclass(frozen=True)
class Functions:
    """h, h' and U with U' = h, U(0) = 0, each a map of balls that contains."""

    h: Callable[[arb], arb]
    dh: Callable[[arb], arb]
    potential: Callable[[arb], arb]


@dataclass(frozen=True)
class Member(Functions):
    """An odd, bounded h, positive for x > 0 and once continuously differentiable, with its bounds from above.

    Args:
        gamma: at least sup h.
        rho: at least sup |h'|.
        L: at least sup h(x)/x.
        d2h: contains h'' over a ball; without it h' has no slopes, and boxes near a worst state are smaller.
        bends: the x > 0 at which h'' may stop being monotone; from −x to x it does not for the first one.
    """

    gamma: Fraction
    rho: Fraction
    L: Fraction
    d2h: Callable[[arb], arb] | None = None
    bends: Callable[[], tuple[arb, ...]] = tuple


@lru_cache(maxsize=256)
def member(name: str, m: int | None = None) -> Member:
    """A function by the name of a file in ``functions``, with its m if it has one; else ``ValueError``."""
    create = _creators().get(name)
    if create is None:
        raise unknown(name, m)
    return create(m)


@cache
def _creators() -> dict[str, Callable[[int | None], Member]]:
    """What makes each function: every file of the folder is imported, whatever a certificate names."""
    from lyapcheck.check.numbers import functions

    files = iter_modules([str(Path(functions.__file__).parent)])
    return {file.name: import_module(f"{functions.__name__}.{file.name}").create for file in files}


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
