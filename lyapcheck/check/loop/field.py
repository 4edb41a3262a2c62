"""Polynomials in sines, cosines and parameters over boxes, which are cut until each shows what is claimed."""

from __future__ import annotations

import math
from collections.abc import Callable, Iterator, Sequence
from fractions import Fraction
from math import prod
from typing import Any

from flint import arb

from lyapcheck.check.loop.arithmetic import BALLS, SPANS, Arithmetic, Ring
from lyapcheck.check.numbers.balls import precision, to_arb
from lyapcheck.check.numbers.harmonics import Harmonics, Uncertain, angles_in, derivative, largest
from lyapcheck.check.numbers.polynomials import Enclosure
from lyapcheck.check.statement import Ends

# --- Trees of boxes: a box is cut in the middle of one side, and again, until each part can be judged.
#
# A tree is written in preorder, a digit for the side that is cut and a dot for a leaf. Both halves of a side
# share the double in the middle, so the leaves cover the start whatever the tree.


Side = tuple[float, float]
Box = tuple[Side, ...]


class BrokenTree(ValueError):
    """The text is not the preorder of a tree of cuts of this box."""


def leaves(start: Box, tree: str) -> Iterator[Box]:
    """The boxes at the dots of a tree; raises ``BrokenTree`` as `nodes` does."""
    return (box for box, side in nodes(start, tree) if side is None)


def nodes(start: Box, tree: str) -> Iterator[tuple[Box, int | None]]:
    """Every box of a tree with the side that is cut, ``None`` at a dot; ``BrokenTree`` if it is none."""
    stack = [start]
    for mark in tree:
        if not stack:
            raise BrokenTree("the tree ends before its text does")
        box = stack.pop()
        side = None if mark == "." else _side(mark, len(box))
        yield box, side
        if side is not None:
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


def _side(mark: str, sides: int) -> int:
    side = ord(mark) - ord("0")
    if not 0 <= side < sides:
        raise BrokenTree(f"{mark!r} is not a side of the box")
    return side


PI_ABOVE = 3.1415926535897936
"""A double above π."""
BITS = 64
MOST_BOXES = 20_000
Value = Any
"""A ball or a span, as the arithmetic has it."""
Shows = Callable[[list[Value], Arithmetic], bool]
"""Whether enclosures of all polynomials show it."""
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

    def throughout(self, shows: Shows, most: int = MOST_BOXES) -> bool:
        """Whether something is shown for all angles and parameters; ``False`` says nothing.

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

    Its coefficients are polynomials in the parameters; each power of those is enclosed on its own.
    """

    def __init__(self, entry: Uncertain) -> None:
        self.parts = [(powers, Part(terms)) for powers, terms in entry.items()]
        self.used = [k for terms in entry.values() for k in terms if any(k)]

    def over(
        self, wide: Values, centre: Values, offset: list[Value], parameters: Sequence[Value], of: Arithmetic
    ) -> Value:
        return self.put_together(lambda part: part.over(wide, centre, offset, of), parameters, of)

    def put_together(self, value_of: Callable[[Part], Value], parameters: Sequence[Value], of: Ring) -> Value:
        total = of.value(arb(0))
        for powers, part in self.parts:
            value = value_of(part)
            for parameter, power in zip(parameters, powers, strict=True):
                for _ in range(power):
                    value = value * parameter
            total = total + value
        return total


class Part:
    """One power of the parameters: the ranges of its harmonics, cut with the mean value form."""

    def __init__(self, terms: Harmonics) -> None:
        self.terms = _lifted(terms)
        joints = {i for k in terms for i, factor in enumerate(k) if factor}
        self.slopes = [(i, _lifted(derivative(terms, i))) for i in sorted(joints)]

    def over(self, wide: Values, centre: Values, offset: list[Value], of: Arithmetic) -> Value:
        natural = combined(self.terms, wide, of)
        if not self.slopes:
            return natural
        mean = combined(self.terms, centre, of)
        for i, slope in self.slopes:
            mean = mean + combined(slope, wide, of) * offset[i]
        return of.meet(natural, mean)


Lifted = list[tuple[tuple[int, ...], arb, arb]]


def _lifted(terms: Harmonics) -> Lifted:
    return [(k, to_arb(a), to_arb(b)) for k, (a, b) in terms.items()]


def combined(terms: Lifted, values: Values, of: Arithmetic) -> Value:
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
