"""Candidate counterexamples in many variables, by vectorised sampling in floating point: untrusted and fast."""

from __future__ import annotations

import math
from collections.abc import Iterator
from fractions import Fraction
from typing import Any

import numpy as np
from numpy.typing import NDArray

from lyapcheck.check.functions import Algebra, Tree, evaluate
from lyapcheck.claims.expressions import Relation
from lyapcheck.claims.procedures.search import Point
from lyapcheck.claims.statements import Variable

SEED = 20190561
SAMPLES = 20_000
KEPT = 12
CLIMB_STEPS = 60

Floats = NDArray[np.float64]


class FloatAlgebra(Algebra):
    """Arrays of doubles."""

    def number(self, value: Fraction) -> Any:
        """The nearest double."""
        return float(value)

    def constant(self, name: str, m: int) -> Any:
        """The middle of the certified enclosure."""
        return float(super().constant(name, m).mid())

    def pi(self) -> Any:
        """The nearest double."""
        return math.pi

    def function(self, name: str, value: Any) -> Any:
        """NumPy's function."""
        alias = {"asin": "arcsin", "acos": "arccos", "atan": "arctan"}
        return getattr(np, alias.get(name, name))(value)


def values_of(tree: Tree, points: dict[str, Floats]) -> Floats:
    """An expression at many points."""
    size = len(next(iter(points.values()), np.zeros(1)))
    with np.errstate(all="ignore"):
        return np.broadcast_to(np.asarray(evaluate(tree, points, FloatAlgebra()), dtype=np.float64), (size,))


def candidates(
    variables: tuple[Variable, ...], hypotheses: tuple[Relation, ...], conclusion: Relation
) -> Iterator[Point]:
    """Exact points, the most promising first, at which the conclusion seems to fail; the seed is fixed."""
    generator = np.random.default_rng(SEED)
    points = {v.name: _draw(v, SAMPLES, generator) for v in variables}
    score = _score(points, hypotheses, conclusion)
    for step in range(CLIMB_STEPS):
        order = np.argsort(score, kind="stable")[:KEPT]
        if score[order[0]] < -1e-6:
            break
        points, score = _climb(points, order, step, variables, hypotheses, conclusion, generator)
    for index in np.argsort(score, kind="stable")[:KEPT]:
        if score[index] < 0:
            yield {v.name: _exact(float(points[v.name][index]), v) for v in variables}


def _draw(variable: Variable, count: int, generator: np.random.Generator) -> Floats:
    """Sizes even in the exponent; signs at random where the variable is not bounded below."""
    size = np.exp(generator.uniform(-4.0, 4.0, count))
    if variable.low is not None:
        return float(variable.low) + size
    return size * generator.choice([-1.0, 1.0], count)


def _score(points: dict[str, Floats], hypotheses: tuple[Relation, ...], conclusion: Relation) -> Floats:
    """The relative gap of the conclusion: negative where it fails; infinite where a hypothesis does not hold."""
    left, right = values_of(conclusion.left, points), values_of(conclusion.right, points)
    score = (right - left) / (np.abs(left) + np.abs(right) + 1e-300)
    for hypothesis in hypotheses:
        gap = values_of(hypothesis.gap, points)
        score = np.where(gap > 0, score, np.inf)
    return np.where(np.isnan(score), np.inf, score)


def _climb(
    points: dict[str, Floats],
    order: NDArray[np.intp],
    step: int,
    variables: tuple[Variable, ...],
    hypotheses: tuple[Relation, ...],
    conclusion: Relation,
    generator: np.random.Generator,
) -> tuple[dict[str, Floats], Floats]:
    """Many small random moves from each of the best points; the points themselves stay in."""
    copies, width = 100, 0.5 ** (step // 10)
    moved = {}
    for v in variables:
        base = np.repeat(points[v.name][order], copies)
        low = float(v.low) if v.low is not None else 0.0
        touched = generator.random(base.size) < 0.5
        factor = np.exp(width * generator.normal(size=base.size) * touched)
        moved[v.name] = np.concatenate([points[v.name][order], low + (base - low) * factor])
    return moved, _score(moved, hypotheses, conclusion)


def _exact(value: float, variable: Variable) -> Fraction:
    """A short rational near a double, on the right side of the lower bound."""
    short = Fraction(value).limit_denominator(1000)
    if variable.low is not None and short <= variable.low:
        return Fraction(value)
    return short if short else Fraction(value)
