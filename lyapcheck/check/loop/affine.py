"""M(q) at the corners of the ranges of its parameters, where it is affine in each of them."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from fractions import Fraction
from itertools import product
from math import prod

from lyapcheck.check.statement import Ends, Monomials


def corners_of(parameters: Sequence[Ends]) -> Iterator[tuple[Fraction, ...]]:
    """The corners of the ranges of the parameters; one where nothing ranges."""
    return product(*([low, high] if low < high else [low] for low, high in parameters))


def is_affine(mass: Sequence[Sequence[Monomials]], n: int) -> bool:
    """Whether M(q) of n joints is affine in each of its parameters."""
    return all(max(p[2 * n :], default=0) <= 1 for row in mass for entry in row for p, _ in entry)


def at_corner(entry: Monomials, angles: int, parameters: Sequence[Fraction]) -> Monomials:
    """The entry with numbers for the parameters, each to the power 0 or 1."""
    return tuple(
        (powers[:angles], c * prod(x for x, p in zip(parameters, powers[angles:], strict=True) if p))
        for powers, c in entry
    )
