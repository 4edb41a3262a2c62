"""Looking for counterexamples, and writing down the ones that balls confirm."""

from __future__ import annotations

import math
from collections.abc import Iterable, Iterator, Sequence
from dataclasses import dataclass
from fractions import Fraction
from random import Random
from typing import Any

import numpy as np
from flint import ctx
from numpy.typing import NDArray

from lyapcheck.check.expressions.domain import Comparison, holds
from lyapcheck.check.expressions.expression import Algebra, Tree, Unsupported, ball, evaluate
from lyapcheck.check.numbers.polynomials import Enclosure, ball_of
from lyapcheck.check.statement import Point as Coordinates
from lyapcheck.check.statement import Relation, Variable, Witness
from lyapcheck.claims.search_result import failing
from lyapcheck.output.digits import decimals

BITS = 192
LARGEST = 4096
"""The binary exponent of the largest number in a witness, and of the inverse of the smallest."""

MOST_DIGITS = 400
"""That are shown of a side, however near it is to the other."""

SEEN = 1e-6
"""Of the sizes of both sides: by how much an inequality must hold for doubles to be believed at first."""

ROUND = tuple(map(Fraction, ("0", "1", "1/2", "2", "1/10", "10", "1/100", "100")))
"""What a reader takes in at a glance, the roundest first."""

TRIES, SEED = 300, 1
VALUES = tuple(map(Fraction, ("1", "3/2", "2", "3", "1/2", "10", "1/10", "100", "1/100")))
"""How many round points are drawn at random, and what from."""

Point = dict[str, Fraction]


@dataclass(frozen=True)
class Sides:
    """Both sides of a comparison that fails, enclosed."""

    left: Enclosure
    right: Enclosure


Failure = tuple[Comparison, Point, Sides]


def first_refutation(
    claim: Comparison, points: Iterable[Point], hypotheses: Sequence[Comparison] = ()
) -> Failure | None:
    """The first point at which balls show that the relation fails while every hypothesis holds."""
    for point in points:
        try:
            sides = broken_sides(claim, point, hypotheses)
        except (Unsupported, ValueError, ZeroDivisionError):
            continue
        if sides is not None and all(map(_can_be_written, (sides.left, sides.right))):
            return claim, point, sides
    return None


def doubtful(claim: Comparison, points: Sequence[Point]) -> list[Point]:
    """The points at which doubles do not see an inequality hold by far; the others are not worth balls."""
    at = {name: np.array([float(point[name]) for point in points]) for name in points[0]}
    left, right = values_of(claim[0], at), values_of(claim[2], at)
    with np.errstate(all="ignore"):
        far = right - left > SEEN * (np.abs(left) + np.abs(right))
    return [point for point, seen in zip(points, far, strict=True) if not seen or claim[1] == "="]


def broken_sides(claim: Comparison, point: Point, hypotheses: Sequence[Comparison] = ()) -> Sides | None:
    """Both sides of a relation, if the point provably meets the hypotheses and breaks it."""
    with ctx.workprec(BITS):
        met = all(holds(hypothesis, point) is True for hypothesis in hypotheses)
        if not met or holds(claim, point) is not False:
            return None
        balls = {name: ball_of(value) for name, value in point.items()}
        return Sides(*(Enclosure.from_arb(ball(side, balls)) for side in (claim[0], claim[2])))


def rounder(failure: Failure, hypotheses: Sequence[Comparison] = ()) -> Failure:
    """The same failure at rounder numbers, one coordinate after the other, where it still is one."""
    claim, point, _ = failure
    result = failure
    for name in sorted(point):
        signed = (sign * value for value in ROUND for sign in ((1, -1) if value else (1,)))
        tries = ({**result[1], name: value} for value in signed)
        result = first_refutation(claim, tries, hypotheses) or result
    return result


def round_points(variables: Sequence[Variable]) -> Iterator[Point]:
    """All variables 1 above their ends, then one at a time at its end, then random ones; a fixed seed."""
    random = Random(SEED)
    ones = {v.name: (v.low or Fraction(0)) + 1 for v in variables}
    yield ones
    yield from (ones | {v.name: v.low} for v in variables if v.low is not None and not v.strict)
    for _ in range(TRIES):
        yield {v.name: _drawn(v, random) for v in variables}


def _drawn(variable: Variable, random: Random) -> Fraction:
    """A value in the range of a variable; its end, or 0, now and then."""
    value = random.choice(VALUES)
    if variable.low is None:
        return random.choice((value, -value, Fraction(0)))
    return variable.low + (value if variable.strict else random.choice((value, value, Fraction(0))))


def _can_be_written(side: Enclosure) -> bool:
    """Whether a reader could be shown the number: e^(e^x) soon has more digits than a page."""
    size = max(abs(side.lower), abs(side.upper))
    return size == 0 or abs(size.numerator.bit_length() - size.denominator.bit_length()) <= LARGEST


def witness_of(failure: Failure) -> Witness:
    """The failure as the checker replays it."""
    return Witness(point_of(failure[1]), BITS)


def point_of(point: Point) -> Coordinates:
    """A point as certificates write it."""
    return tuple(sorted(point.items()))


def witness_data(failure: Failure) -> dict[str, Any]:
    """A witness as plain data: the exact point, and both sides between decimals."""
    claim, point, sides = failure
    left, right = told_apart(sides.left, sides.right)
    return failing(dict(sorted(point.items())), left, claim[1], right)


def told_apart(left: Enclosure, right: Enclosure) -> tuple[list[str], list[str]]:
    """Both between decimals: with 12 digits, or as many as it takes for two numbers to look different."""
    digits = 12
    while True:
        shown = decimals(left, digits), decimals(right, digits)
        lower, upper = sorted(tuple(map(Fraction, ends)) for ends in shown)
        overlap = max(left.lower, right.lower) <= min(left.upper, right.upper)
        if overlap or digits >= MOST_DIGITS or lower[1] < upper[0]:
            return list(shown[0]), list(shown[1])
        digits += 4


# --- Candidate counterexamples in many variables by vectorised floating point: untrusted and fast.


SAMPLING_SEED = 20190561
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
    generator = np.random.default_rng(SAMPLING_SEED)
    points = {v.name: _draw(v, SAMPLES, generator) for v in variables}
    score = _score(points, hypotheses, conclusion)
    for step in range(CLIMB_STEPS):
        order = np.argsort(score, kind="stable")[:KEPT]
        if score[order[0]] < -1e-6:
            break
        # many small random moves from each of the best points; the points themselves stay in
        copies, width = 100, 0.5 ** (step // 10)
        moved = {}
        for v in variables:
            base = np.repeat(points[v.name][order], copies)
            low = float(v.low) if v.low is not None else 0.0
            touched = generator.random(base.size) < 0.5
            factor = np.exp(width * generator.normal(size=base.size) * touched)
            moved[v.name] = np.concatenate([points[v.name][order], low + (base - low) * factor])
        points, score = moved, _score(moved, hypotheses, conclusion)
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


def _exact(value: float, variable: Variable) -> Fraction:
    """A short rational near a double, on the right side of the lower bound."""
    short = Fraction(value).limit_denominator(1000)
    if variable.low is not None and short <= variable.low:
        return Fraction(value)
    return short if short else Fraction(value)
