"""Properties of the closed loop and of V: bounds of h are proposed, then each fact about it is decided.

The facts are about h, h' and U in one variable; the checker says why they are enough.
"""

from __future__ import annotations

from fractions import Fraction

import numpy as np

from lyapcheck.check.expressions.expression import Tree
from lyapcheck.check.kinds.loop_property import SMOOTH, UNBOUNDED, Facts, LoopProperty, facts_of
from lyapcheck.claims.registry import find, procedure
from lyapcheck.claims.search_result import SearchResult, conjunction, shown, still_open

METHOD = "facts in one variable"
FARTHEST = 40.0
STARTS = (1, 2, 4, 8, 16)


@procedure(LoopProperty)
def find_loop_property(statement: LoopProperty) -> SearchResult:
    """Decide every fact; one that fails leaves the property open, as it is only sufficient."""
    numbers = _numbers(statement)
    if numbers is None:
        return still_open("h, h' or h(x)/x has no bound that sampling would show; check the function", METHOD)
    facts = [(name, find(fact)) for name, fact in facts_of(statement, numbers)]
    for name, result in facts:
        if not result.is_proof:
            reason = result.reason or "it fails"
            return still_open(f"{name} is not shown: {reason}", METHOD)
    proofs = tuple(result.proof for _, result in facts if result.proof is not None)
    return shown(Facts(numbers, proofs), conjunction(facts).method)


def _numbers(statement: LoopProperty) -> tuple[Fraction, ...] | None:
    """c, its x and γ, or ρ and L: a little beyond what is met on a grid, where doubles do not overflow."""
    if statement.property == UNBOUNDED:
        x = np.concatenate([np.linspace(0.0, FARTHEST, 8001), np.geomspace(FARTHEST, 1e9, 40)])
        h = _values(statement.h, x)
        x, h = x[np.isfinite(h)], h[np.isfinite(h)]
        if not np.any(x >= max(STARTS)):
            return None
        low, start = max((float(np.min(h[x >= start])), start) for start in STARTS)
        largest = float(np.max(np.abs(h)))
        if not low > 0:
            return None
        return Fraction(low / 2).limit_denominator(100) or Fraction(1, 1000), Fraction(start), _above(largest)
    if statement.property == SMOOTH:
        x = np.concatenate([np.geomspace(1e-6, 1e-2, 40), np.linspace(1e-2, FARTHEST, 16001)])
        slope, secant = _values(statement.slope, x), _values(statement.h, x) / x
        finite = np.isfinite(slope) & np.isfinite(secant)
        if not np.any(finite):
            return None
        return _above(float(np.max(np.abs(slope[finite])))), _above(float(np.max(np.abs(secant[finite]))))
    return ()


def _values(
    tree: Tree, x: np.ndarray[tuple[int], np.dtype[np.float64]]
) -> np.ndarray[tuple[int], np.dtype[np.float64]]:
    from lyapcheck.claims.procedures.sampling import values_of

    with np.errstate(all="ignore"):
        return np.broadcast_to(values_of(tree, {"x": x}), x.shape)


def _above(value: float) -> Fraction:
    """A short number clearly above."""
    return Fraction(int(value * 1010) + 2, 1000)
