"""An arm at the corners of the ranges of M's parameters, which speak for all that lies between.

At one state −dV/dt = ε hᵀK_p h + yᵀ(B + K_v D + ε S)w, and S is linear in M(q) and its rates. So where M is
affine in each parameter, dV/dt is so too, and nowhere above the largest of its values at the corners of their
ranges; likewise λmax of M and of what is linear in it.

References: ``reyes2019family`` (11), (15).
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from fractions import Fraction
from itertools import product
from math import prod

from lyapcheck.check.limits import MOST_CORNERS
from lyapcheck.check.refusal import require
from lyapcheck.check.statement import Ends, Monomials

Mass = tuple[tuple[Monomials, ...], ...]


def corners_of(parameters: Sequence[Ends]) -> Iterator[tuple[Fraction, ...]]:
    """The corners of the ranges of the parameters; one where nothing ranges."""
    return product(*([low, high] if low < high else [low] for low, high in parameters))


def is_affine(mass: Mass) -> bool:
    """Whether M(q) is affine in each of its parameters."""
    return all(max(p[2 * len(mass) :], default=0) <= 1 for row in mass for entry in row for p, _ in entry)


def at_parameters(entry: Monomials, angles: int, parameters: Sequence[Fraction]) -> Monomials:
    """The entry with numbers for the parameters; their exponents follow those of sines and cosines."""
    return tuple(
        (powers[:angles], c * prod(x**p for x, p in zip(parameters, powers[angles:], strict=True)))
        for powers, c in entry
    )


def masses_at_corners(mass: Mass, parameters: Sequence[Ends]) -> tuple[Mass, ...]:
    """M(q) with numbers for its parameters, one for each corner, in the order of ``corners_of``.

    Raises:
        Refused: M is not affine in each of them, or they have too many corners.
    """
    require(is_affine(mass), "M(q)", "", "must be affine in each of its parameters")
    ranging = sum(low < high for low, high in parameters)
    require(2**ranging <= MOST_CORNERS, "corners", 2**ranging, f"must not exceed {MOST_CORNERS}")
    return tuple(
        tuple(tuple(at_parameters(entry, 2 * len(mass), corner) for entry in row) for row in mass)
        for corner in corners_of(parameters)
    )
