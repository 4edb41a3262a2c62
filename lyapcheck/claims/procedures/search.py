"""Looking for counterexamples, and writing down the ones that balls confirm."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Sequence
from dataclasses import dataclass
from fractions import Fraction
from random import Random
from typing import Any

from flint import ctx

from lyapcheck.check.expressions.expression import Unsupported, ball
from lyapcheck.check.expressions.witness import Comparison, holds
from lyapcheck.check.numbers.enclosure import Enclosure, ball_of
from lyapcheck.check.statement import Point as Coordinates
from lyapcheck.check.statement import Variable, Witness
from lyapcheck.claims.search_result import failing
from lyapcheck.output.digits import decimals

BITS = 192
LARGEST = 4096
"""The binary exponent of the largest number in a witness, and of the inverse of the smallest."""

MOST_DIGITS = 400
"""That are shown of a side, however near it is to the other."""

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


def broken_sides(claim: Comparison, point: Point, hypotheses: Sequence[Comparison] = ()) -> Sides | None:
    """Both sides of a relation, if the point provably meets the hypotheses and breaks it."""
    with ctx.workprec(BITS):
        balls = {name: ball_of(value) for name, value in point.items()}
        met = all(holds(hypothesis, balls) is True for hypothesis in hypotheses)
        if not met or holds(claim, balls) is not False:
            return None
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
