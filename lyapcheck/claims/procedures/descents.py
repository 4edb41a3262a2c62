"""Points at which a polynomial fact may fail: where descents end, rounded."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from fractions import Fraction
from typing import TYPE_CHECKING

import numpy as np
from flint import fmpq, fmpq_mpoly

from lyapcheck.check.kinds.implies import Implies, Signs, gaps_of, letters_of
from lyapcheck.claims.procedures.gram import as_float

if TYPE_CHECKING:
    from lyapcheck._types import Array

STARTS, SEED = 16, 1
LENGTHS = (0.3, 1.0, 3.0)
MARGINS = (0.0, 1e-3)
"""By how much hypotheses are to hold, as rounding moves a point."""
ROUND = (1, 2, 3, 4, 6, 12, 60, 1000, 10**6)


def lowest_points(statement: Implies, signs: Signs) -> Iterator[dict[str, Fraction]]:
    """Points near local minima of the conclusion's gap, in the region where the hypotheses hold.

    Args:
        statement: the implication.
        signs: its polynomials, which are plain.
    """
    names, random = signs.algebra.names, np.random.default_rng(SEED)
    if len(letters_of(signs)) > len(names):
        return  # of sines, too: sampling has looked already
    goal, *given = (_Numeric(gap, len(names)) for gap in gaps_of(signs))
    free = [i not in signs.bounds for i in range(len(names))]
    lows = {v.name: v.low or Fraction(0) for v in statement.variables}
    for _ in range(STARTS):
        start = random.normal(size=len(names)) * random.choice(LENGTHS)
        for margin in MARGINS if given else MARGINS[:1]:
            place = _descended(goal, given, np.where(free, start, abs(start)), free, margin)
            for most in ROUND if np.isfinite(place).all() else ():
                moved = zip(names, (Fraction(float(x)).limit_denominator(most) for x in place), strict=True)
                yield {name: low + 1 for name, low in lows.items()} | {
                    name: lows[name] + x for name, x in moved
                }


@dataclass
class _Numeric:
    """A polynomial and its slope in floating point, its largest coefficient 1."""

    polynomial: fmpq_mpoly
    count: int

    def __post_init__(self) -> None:
        terms = self.polynomial.to_dict() or {(0,) * self.count: fmpq(0)}
        self.powers = np.array([e[: self.count] for e in terms], dtype=int)
        numbers = np.array(list(map(as_float, terms.values())))
        self.numbers = numbers / (np.abs(numbers).max() or 1.0)

    def value(self, x: Array) -> float:
        return float(self.numbers @ np.prod(x**self.powers, axis=1))

    def slope(self, x: Array) -> Array:
        result = []
        for i in range(self.count):
            lowered = self.powers - np.eye(self.count, dtype=int)[i]
            result.append(self.numbers * self.powers[:, i] @ np.prod(x ** np.maximum(lowered, 0), axis=1))
        return np.array(result)


def _descended(goal: _Numeric, given: list[_Numeric], start: Array, free: list[bool], margin: float) -> Array:
    from scipy.optimize import minimize

    constraints = [
        {"type": "ineq", "fun": lambda x, one=one: one.value(x) - margin, "jac": one.slope} for one in given
    ]
    bounds = [(None if any_sign else 0.0, None) for any_sign in free]
    settings = {"maxiter": 60, "ftol": 1e-14}
    with np.errstate(all="ignore"):
        found = minimize(
            goal.value, start, jac=goal.slope, bounds=bounds, constraints=constraints, options=settings
        )
    return np.asarray(found.x)
