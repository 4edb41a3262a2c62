"""What is known of the constants of an arm for all angles before any box: from its links."""

from __future__ import annotations

from collections.abc import Sequence
from fractions import Fraction
from math import inf, nextafter, sqrt

from lyapcheck.robots.plant import Plant

FEW = 3
"""Up to so many joints boxes alone are close and fast; for more, storage forms are asked as well."""
_THOROUGH = 150_000


def outside(model: Plant, name: str, max_boxes: int) -> Fraction | None:
    """A lower bound of λmin(M) or an upper bound of another constant; ``None`` where none is known.

    The better of what masses and distances say and of what storage forms along the chain prove; those of k_c
    take a minute and are asked for where the budget of boxes would take one as well.
    """
    sign = -1 if name == "lambda_min" else 1
    asked = name != "k_c" or max_boxes * model.n**2 >= _THOROUGH
    forms = _of_forms(model, name) if asked else None
    found = [bound for bound in (_of_distances(model, name), forms) if bound is not None]
    return sign * min(sign * bound for bound in found) if found else None


def ceiling(bound: Fraction | None, sign: int) -> float:
    """A double that is not below sign·bound; infinite where there is no bound."""
    return inf if bound is None else nextafter(float(sign * bound), inf)


def _of_distances(model: Plant, name: str) -> Fraction | None:
    chain = model.chain_bounds
    if chain is None:
        return None
    known = {"lambda_min": chain.lambda_min, "lambda_max": chain.lambda_max, "k_c": chain.k_c}
    known |= {f"k_g{i + 1}": top for i, top in enumerate(chain.gravity)}
    return _length(chain.gravity) if name == "k_g" else known[name]


def _of_forms(model: Plant, name: str) -> Fraction | None:
    if model.chain is None or model.n <= FEW:
        return None
    from lyapcheck.constants.storage import storage_bounds

    make = storage_bounds(model.chain).get(name)
    return None if make is None else make()


def _length(vector: Sequence[Fraction]) -> Fraction:
    """The length of a vector, rounded up."""
    square = sum((x * x for x in vector), Fraction(0))
    return Fraction(sqrt(square)) * (1 + Fraction(1, 10**12))
