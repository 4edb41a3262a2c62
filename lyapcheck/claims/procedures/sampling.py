"""Candidate counterexamples in many variables by vectorised floating point: untrusted and fast."""

from __future__ import annotations

import math
from collections.abc import Iterator
from fractions import Fraction
from typing import Any

import numpy as np
from numpy.typing import NDArray

from lyapcheck.check.expressions.expression import Algebra, Tree, evaluate
from lyapcheck.check.statement import Relation, Variable
from lyapcheck.claims.procedures.search import Point, round_points

SEED = 20190561
SAMPLES = 20_000
KEPT = 12
CLIMB_STEPS = 60
OUTSIDE, NEARLY = 2.0, 1e-3
"""What is added to the score where a hypothesis fails, and by how little it may: rounding can meet it."""
DENOMINATORS = (1, 12, 1000)

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
        values = np.zeros(size) + evaluate(tree, points, FloatAlgebra())
    return np.asarray(values, dtype=np.float64)


def candidates(
    variables: tuple[Variable, ...], hypotheses: tuple[Relation, ...], conclusion: Relation
) -> Iterator[Point]:
    """Exact points, always the same: where the conclusion seems to fail, the worst first, then round ones."""
    generator = np.random.default_rng(SEED)
    points = {v.name: _draw(v, SAMPLES, generator) for v in variables}
    score = _score(points, hypotheses, conclusion)
    for step in range(CLIMB_STEPS):
        order = np.argsort(score, kind="stable")[:KEPT]
        if score[order[0]] < -1e-6:
            break
        points, score = _climb(points, order, step, variables, hypotheses, conclusion, generator)
    for index in np.argsort(score, kind="stable")[:KEPT]:
        place = {v.name: float(points[v.name][index]) for v in variables}
        if score[index] < 0 or (conclusion.strict and score[index] == 0):
            yield {v.name: _exact(place[v.name], v) for v in variables}
        elif OUTSIDE <= score[index] < OUTSIDE + NEARLY:
            for most in DENOMINATORS:
                yield {name: Fraction(value).limit_denominator(most) for name, value in place.items()}
    yield from round_points(variables)


def lowest_points(relation: Relation, name: str, low: Fraction, high: Fraction) -> list[Fraction]:
    """Points of [low, high] where the gap is smallest, by a fine grid and a zoom on its lowest valleys."""
    grid = np.linspace(float(low), float(high), 20_001)
    gap = values_of(relation.gap, {name: grid})
    gap = np.where(np.isfinite(gap), gap, np.inf)
    valleys = np.flatnonzero((gap[1:-1] <= gap[:-2]) & (gap[1:-1] <= gap[2:])) + 1
    chosen = valleys[np.argsort(gap[valleys], kind="stable")[:KEPT]]
    step = float(grid[1] - grid[0])
    result = [_zoom(relation, name, float(grid[index]), step) for index in chosen]
    return [point for point in map(Fraction, result) if low < point < high]


def _zoom(relation: Relation, name: str, centre: float, width: float) -> float:
    for _ in range(5):
        grid = centre + np.linspace(-width, width, 101)
        gap = values_of(relation.gap, {name: grid})
        centre, width = float(grid[int(np.argmin(np.where(np.isnan(gap), np.inf, gap)))]), width / 40
    return centre


def _draw(variable: Variable, count: int, generator: np.random.Generator) -> Floats:
    """Sizes even in the exponent, the first of them 1; signs at random where nothing bounds from below."""
    size = np.exp(generator.uniform(-4.0, 4.0, count))
    if variable.low is not None:
        size[0] = 1.0
        return np.asarray(float(variable.low) + size, dtype=np.float64)
    return np.asarray(size * generator.choice([-1.0, 1.0], count), dtype=np.float64)


def _score(points: dict[str, Floats], hypotheses: tuple[Relation, ...], conclusion: Relation) -> Floats:
    """The relative gap of the conclusion, negative where it fails; where hypotheses do, how far, above it."""
    score = _relative_gap(conclusion, points)
    for hypothesis in hypotheses:
        gap = _relative_gap(hypothesis, points)
        met = (gap > 0) | ((gap == 0) & (not hypothesis.strict))
        score = np.where(met, score, np.fmax(score, OUTSIDE - gap))
    return np.asarray(np.where(np.isnan(score), np.inf, score), dtype=np.float64)


def _relative_gap(relation: Relation, points: dict[str, Floats]) -> Any:
    """From −1 to 1: right − left, relative to the sizes of both."""
    left, right = values_of(relation.left, points), values_of(relation.right, points)
    with np.errstate(all="ignore"):
        return (right - left) / (np.abs(left) + np.abs(right) + 1e-300)


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
