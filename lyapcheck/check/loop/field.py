"""Polynomials in sines, cosines and parameters over boxes, in balls or spans.

Boxes are cut until each shows what is claimed.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass
from fractions import Fraction
from math import prod
from typing import Any

from flint import arb

from lyapcheck.check.numbers.balls import precision, to_arb
from lyapcheck.check.numbers.harmonics import Harmonics, Uncertain, angles_in, derivative, largest
from lyapcheck.check.numbers.polynomials import Enclosure
from lyapcheck.check.statement import Ends

Value = Any
"""A ball or a span, as the arithmetic has it."""

# --- What evaluation needs of an arithmetic, beyond sums and products.
#
# Spans are intervals with two ends, for boxes so wide that balls are too coarse. A product of balls a ± r and
# b ± s has the radius |a|s + |b|r + rs, the exact range one of |a|s + |b|r: for wide balls that is much.
# Spans give the exact range of every operation, at several times the cost.


class Span:
    """All reals between two points.

    Soundness: for x in the first and y in the second span, x ∘ y lies in the result, for every ∘ here; ends
    are rounded outward by taking the outer end of each ball.
    """

    __slots__ = ("high", "low")

    def __init__(self, low: arb, high: arb) -> None:
        self.low = low
        self.high = high

    @classmethod
    def of(cls, value: arb) -> Span:
        return cls(value.lower(), value.upper())

    def __add__(self, other: Span) -> Span:
        return Span((self.low + other.low).lower(), (self.high + other.high).upper())

    def __sub__(self, other: Span) -> Span:
        return Span((self.low - other.high).lower(), (self.high - other.low).upper())

    def __mul__(self, other: Span) -> Span:
        a, b = self.low * other.low, self.low * other.high
        c, d = self.high * other.low, self.high * other.high
        return Span(
            a.lower().min(b.lower()).min(c.lower().min(d.lower())),
            a.upper().max(b.upper()).max(c.upper().max(d.upper())),
        )

    def __truediv__(self, other: Span) -> Span:
        """The quotient by a positive span; everything where the divisor may be 0."""
        if not other.low > 0:
            return Span(arb("-inf"), arb("inf"))
        return self * Span((1 / other.high).lower(), (1 / other.low).upper())

    def square(self) -> Span:
        """x², which is never negative."""
        a, b = self.low * self.low, self.high * self.high
        large = a.upper().max(b.upper())
        if self.low <= 0 <= self.high:
            return Span(arb(0), large)
        return Span(a.lower().min(b.lower()), large)

    def meet(self, other: Span) -> Span:
        """The values in both, for two enclosures of the same quantity."""
        return Span(self.low.max(other.low), self.high.min(other.high))

    @property
    def positive(self) -> bool:
        """Whether all of it is proved to be above 0; an end that is not a number proves nothing."""
        return bool(self.low > 0)


@dataclass(frozen=True)
class Ring:
    """Values under +, − and ×.

    Args:
        value: the one for a ball.
        square: x², never below 0 where it encloses.
    """

    value: Callable[[arb], Value]
    square: Callable[[Value], Value]


@dataclass(frozen=True)
class Arithmetic(Ring):
    """Enclosures under +, −, × and ÷, with what those operators cannot say.

    Args:
        meet: what lies in two enclosures of the same quantity.
        positive: whether all of an enclosure is proved to be above 0.
    """

    meet: Callable[[Value, Value], Value]
    positive: Callable[[Value], bool]

    def positive_definite(self, rows: list[list[Value]]) -> bool:
        """Whether every symmetric matrix inside is positive definite; ``False`` says nothing.

        Elimination: a symmetric matrix is positive definite exactly when all its pivots are positive.

        Args:
            rows: the entries on and below the diagonal; they are overwritten.
        """
        n = len(rows)
        for k in range(n):
            pivot = rows[k][k]
            if not self.positive(pivot):
                return False
            for i in range(k + 1, n):
                factor = rows[i][k] / pivot
                for j in range(k + 1, i):
                    rows[i][j] = rows[i][j] - factor * rows[j][k]
                rows[i][i] = rows[i][i] - self.square(rows[i][k]) / pivot
        return True


def _square_of(x: arb) -> arb:
    """The square of a ball, which a product with itself would make too wide."""
    low, high = x.lower(), x.upper()
    if low <= 0 <= high:
        return arb(0).union(low * low).union(high * high)
    return (low * low).union(high * high)


BALLS = Arithmetic(lambda x: x, _square_of, arb.intersection, lambda x: bool(x > 0))
SPANS = Arithmetic(Span.of, Span.square, Span.meet, lambda x: x.positive)


# --- Trees of boxes: a box is cut in the middle of one side, and again, until each part can be judged.
#
# A tree is written in preorder, a digit for the side that is cut and a dot for a leaf. Both halves of a side
# share the double in the middle, so the leaves cover the start whatever the tree.


Side = tuple[float, float]
Box = tuple[Side, ...]


class BrokenTree(ValueError):
    """The text is not the preorder of a tree of cuts of this box."""


def leaves(start: Box, tree: str) -> Iterator[Box]:
    """The boxes at the dots of a tree; ``BrokenTree`` if it is none."""
    stack = [start]
    for mark in tree:
        if not stack:
            raise BrokenTree("the tree ends before its text does")
        box = stack.pop()
        if mark == ".":
            yield box
        else:
            side = ord(mark) - ord("0")
            if not 0 <= side < len(box):
                raise BrokenTree(f"{mark!r} is not a side of the box")
            left, right = halves(box, side)
            stack += (right, left)
    if stack:
        raise BrokenTree("the text ends before its tree does")


def halves(box: Box, side: int) -> tuple[Box, Box]:
    """Both halves of a box, cut at one double."""
    low, high = box[side]
    middle = 0.5 * (low + high)
    before, after = box[:side], box[side + 1 :]
    return (*before, (low, middle), *after), (*before, (middle, high), *after)


# --- Polynomials over boxes.


PI_ABOVE = 3.1415926535897936
"""A double above π."""
BITS = 64
MOST_BOXES = 20_000
Values = dict[tuple[int, ...], tuple[Value, Value]]
"""The cosine and the sine of each harmonic."""


class Field:
    """Some polynomials of an arm of n joints.

    ``angles`` are the joints whose angles boxes have as sides; all that occur, unless it is said.
    """

    def __init__(
        self,
        entries: Sequence[Uncertain],
        n: int,
        parameters: Sequence[Ends],
        angles: tuple[int, ...] | None = None,
    ) -> None:
        self.n, self.parameters = n, tuple(parameters)
        self.angles = angles_in([entries]) if angles is None else angles
        self.entries = [Polynomial(entry) for entry in entries]
        self.used = sorted({k for entry in self.entries for k in entry.used})

    def throughout(self, shows: Callable[[list[Value], Arithmetic], bool], most: int = MOST_BOXES) -> bool:
        """Whether enclosures show something for all angles and parameters; ``False`` says nothing.

        Soundness: the boxes cover all angles that occur and all parameters; each of them shows it.
        """
        ranges = [Enclosure(*ends).side for ends in self.parameters]
        start: Box = (*[(-PI_ABOVE, PI_ABOVE)] * len(self.angles), *ranges)
        whole = [high - low for low, high in start]
        waiting, count = [start], 0
        with precision(BITS):
            while waiting:
                box, count = waiting.pop(), count + 1
                if any(shows(self.over(box, of), of) for of in (BALLS, SPANS)):
                    continue
                if count > most or not box:
                    return False
                widest = max(range(len(box)), key=lambda i: (box[i][1] - box[i][0]) / (whole[i] or 1))
                waiting += halves(box, widest)
        return True

    def over(self, box: Box, of: Arithmetic) -> list[Value]:
        count = len(self.angles)
        return self.at(box[:count], [of.value(ball(side)) for side in box[count:]], of)

    def at(self, sides: Box, parameters: Sequence[Value], of: Arithmetic) -> list[Value]:
        """The polynomials over a box of the angles, with enclosures of the parameters."""
        q, middle = [arb(0)] * self.n, [arb(0)] * self.n
        for joint, side in zip(self.angles, sides, strict=True):
            q[joint], middle[joint] = ball(side), arb(0.5 * (side[0] + side[1]))
        offset = [of.value(a - b) for a, b in zip(q, middle, strict=True)]
        wide, centre = cosines_and_sines(self.used, q, of), cosines_and_sines(self.used, middle, of)
        return [entry.over(wide, centre, offset, parameters, of) for entry in self.entries]


def size_of(entry: Uncertain, parameters: Sequence[Ends]) -> Fraction:
    """A bound of the absolute value of a polynomial: the sum of the sizes of its harmonics."""
    sizes, total = [max(abs(low), abs(high)) for low, high in parameters], Fraction(0)
    for powers, part in entry.items():
        total += largest(part) * prod(x**p for x, p in zip(sizes, powers, strict=True))
    return total


def value_at(
    entry: Uncertain, q: Sequence[Fraction], parameters: Sequence[Fraction], unit: arb | int = 1
) -> arb:
    """A polynomial in balls at one posture, in a unit of angles, and one choice of the parameters."""
    total = arb(0)
    for powers, terms in entry.items():
        scale = to_arb(prod((x**p for x, p in zip(parameters, powers, strict=True)), start=Fraction(1)))
        for k, (a, b) in terms.items():
            angle = unit * to_arb(sum((factor * x for factor, x in zip(k, q, strict=True)), Fraction(0)))
            total += scale * (to_arb(a) * angle.cos() + to_arb(b) * angle.sin())
    return total


def ball(side: Side) -> arb:
    """The ball between two doubles, which it contains."""
    return arb(side[0]).union(arb(side[1]))


class Polynomial:
    """A trigonometric polynomial and its slopes, enclosed over boxes by two forms that both hold.

    Its coefficients are polynomials in the parameters; each power of those is enclosed on its own, by the
    ranges of its harmonics, cut with the mean value form.
    """

    def __init__(self, entry: Uncertain) -> None:
        self.parts = [(powers, _lifted(terms), _slopes(terms)) for powers, terms in entry.items()]
        self.used = [k for terms in entry.values() for k in terms if any(k)]

    def over(
        self, wide: Values, centre: Values, offset: list[Value], parameters: Sequence[Value], of: Arithmetic
    ) -> Value:
        total = of.value(arb(0))
        for powers, terms, slopes in self.parts:
            value = _combined(terms, wide, of)
            if slopes:
                mean = _combined(terms, centre, of)
                for i, slope in slopes:
                    mean = mean + _combined(slope, wide, of) * offset[i]
                value = of.meet(value, mean)
            for parameter, power in zip(parameters, powers, strict=True):
                for _ in range(power):
                    value = value * parameter
            total = total + value
        return total


Lifted = list[tuple[tuple[int, ...], arb, arb]]


def _lifted(terms: Harmonics) -> Lifted:
    return [(k, to_arb(a), to_arb(b)) for k, (a, b) in terms.items()]


def _slopes(terms: Harmonics) -> list[tuple[int, Lifted]]:
    """The derivatives that do not vanish."""
    joints = {i for k in terms for i, factor in enumerate(k) if factor}
    return [(i, _lifted(derivative(terms, i))) for i in sorted(joints)]


def _combined(terms: Lifted, values: Values, of: Arithmetic) -> Value:
    """Σ a cos + b sin over the harmonics."""
    total = of.value(arb(0))
    for k, a, b in terms:
        if k in values:
            cosine, sine = values[k]
            total = total + of.value(a) * cosine + of.value(b) * sine
        else:
            total = total + of.value(a)
    return total


def cosines_and_sines(used: Sequence[tuple[int, ...]], q: Sequence[arb], of: Arithmetic) -> Values:
    """cos and sin of every harmonic."""
    result: Values = {}
    for k in used:
        angle = sum((factor * x for factor, x in zip(k, q, strict=True) if factor), arb(0))
        result[k] = of.value(cosine_range(angle)), of.value(cosine_range(angle - arb.pi() / 2))
    return result


def cosine_range(x: arb) -> arb:
    """cos over a ball: the hull of both ends and of the extremes ±1 at the multiples of π in between."""
    low, high = x.lower(), x.upper()
    result = low.cos().union(high.cos())
    turns = range(math.floor(float(low) / math.pi) - 1, math.ceil(float(high) / math.pi) + 2)
    for k in turns:
        place = k * arb.pi()
        if not (place < low or place > high):
            result = result.union(arb((-1) ** k))
    return result
