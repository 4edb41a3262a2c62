"""Polynomials in sines, cosines and parameters over boxes, which are cut until each shows what is claimed."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from fractions import Fraction
from math import prod
from typing import Any

from flint import arb

from lyapcheck.check.loop.arithmetic import BALLS, SPANS, Arithmetic
from lyapcheck.check.loop.boxes import Box, Side, halves
from lyapcheck.check.loop.waves import Polynomial, waves
from lyapcheck.check.numbers.balls import precision, to_arb
from lyapcheck.check.numbers.enclosure import Enclosure
from lyapcheck.check.numbers.harmonics import Uncertain, angles_in, largest
from lyapcheck.check.statement import Ends

PI_ABOVE = 3.1415926535897936
"""A double above π."""
BITS = 64
MOST_BOXES = 20_000
Value = Any
"""A ball or a span, as the arithmetic has it."""
Shows = Callable[[list[Value], Arithmetic], bool]
"""Whether enclosures of all polynomials show it."""


class Field:
    """Some polynomials of one arm.

    Args:
        entries: the polynomials.
        n: number of joints.
        parameters: the range of each parameter.
    """

    def __init__(self, entries: Sequence[Uncertain], n: int, parameters: Sequence[Ends]) -> None:
        self.n, self.parameters = n, tuple(parameters)
        self.angles = angles_in([entries])
        self.entries = [Polynomial(entry) for entry in entries]
        self.used = sorted({k for entry in self.entries for k in entry.used})

    def throughout(self, shows: Shows, most: int = MOST_BOXES) -> bool:
        """Whether something is shown for all angles and parameters; ``False`` says nothing.

        Soundness: the boxes cover all angles that occur and all parameters; each of them shows it.
        """
        start: Box = (*[(-PI_ABOVE, PI_ABOVE)] * len(self.angles), *map(_side, self.parameters))
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
        """The polynomials over a box of the angles that occur and the parameters."""
        q, middle = [arb(0)] * self.n, [arb(0)] * self.n
        for joint, side in zip(self.angles, box, strict=False):
            q[joint], middle[joint] = _ball(side), arb(0.5 * (side[0] + side[1]))
        offset = [of.value(a - b) for a, b in zip(q, middle, strict=True)]
        parameters = [of.value(_ball(side)) for side in box[len(self.angles) :]]
        wide, centre = waves(self.used, q, of), waves(self.used, middle, of)
        return [entry.over(wide, centre, offset, parameters, of) for entry in self.entries]


def size_of(entry: Uncertain, parameters: Sequence[Ends]) -> Fraction:
    """A bound of the absolute value of a polynomial: the sum of the sizes of its harmonics."""
    sizes = [max(abs(low), abs(high)) for low, high in parameters]
    return sum(
        (
            largest(part) * prod(x**p for x, p in zip(sizes, powers, strict=True))
            for powers, part in entry.items()
        ),
        Fraction(0),
    )


def value_at(entry: Uncertain, q: Sequence[Fraction], parameters: Sequence[Fraction]) -> arb:
    """A polynomial in balls at one posture and one choice of the parameters."""
    total = arb(0)
    for powers, terms in entry.items():
        scale = to_arb(prod((x**p for x, p in zip(parameters, powers, strict=True)), start=Fraction(1)))
        for k, (a, b) in terms.items():
            angle = to_arb(sum((factor * x for factor, x in zip(k, q, strict=True)), Fraction(0)))
            total += scale * (to_arb(a) * angle.cos() + to_arb(b) * angle.sin())
    return total


def _ball(side: Side) -> arb:
    return arb(side[0]).union(arb(side[1]))


def _side(ends: Ends) -> Side:
    return Enclosure(*ends).float_lower, Enclosure(*ends).float_upper
