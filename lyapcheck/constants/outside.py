"""What is known of the constants of an arm for all angles before any box: from its links."""

from __future__ import annotations

from collections.abc import Sequence
from fractions import Fraction
from math import inf, nextafter, sqrt

from lyapcheck.robots.plant import Plant


def ceiling(bound: Fraction | None, sign: int) -> float:
    """A double that is not below sign·bound; infinite where there is no bound."""
    return inf if bound is None else nextafter(float(sign * bound), inf)


def from_distances(plant: Plant, name: str) -> Fraction | None:
    """A lower bound of λmin(M), an upper one of another constant, from masses and distances where known."""
    bounds = plant.chain_bounds
    if bounds is None:
        return None
    known = {"lambda_min": bounds.lambda_min, "lambda_max": bounds.lambda_max, "k_c": bounds.k_c}
    known |= {f"k_g{i + 1}": top for i, top in enumerate(bounds.gravity)}
    return _length(bounds.gravity) if name == "k_g" else known[name]


def _length(vector: Sequence[Fraction]) -> Fraction:
    """The length of a vector, rounded up."""
    square = sum((x * x for x in vector), Fraction(0))
    return Fraction(sqrt(square)) * (1 + Fraction(1, 10**12))
