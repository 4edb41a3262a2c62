"""How small and how large M(q) and C(q, ·) of an arm are, over all angles and parameters.

References: ``reyes2019family``, Properties 2.1, 2.2 and 2.6.
"""

from __future__ import annotations

from collections.abc import Sequence
from fractions import Fraction
from math import prod

from flint import arb

from lyapcheck.check.loop.arithmetic import BALLS, SPANS, Arithmetic
from lyapcheck.check.loop.boxes import Box, Side, halves
from lyapcheck.check.loop.waves import Polynomial, waves
from lyapcheck.check.numbers.balls import precision, to_arb
from lyapcheck.check.numbers.enclosure import Enclosure
from lyapcheck.check.numbers.harmonics import (
    Uncertain,
    angles_in,
    by_parameters,
    largest,
    uncertain_christoffel,
)
from lyapcheck.check.statement import Ends, Monomials

PI_ABOVE = 3.1415926535897936
"""A double above π."""
BITS = 64
MOST_BOXES = 20_000


class Inertia:
    """M(q) of n joints, for all parameters in their ranges.

    Args:
        mass: rows of entries; a term has exponents of s1 … sn, c1 … cn and the parameters.
        parameters: the range of each parameter.
    """

    def __init__(self, mass: Sequence[Sequence[Monomials]], parameters: Sequence[Ends]) -> None:
        self.n, self.parameters = len(mass), tuple(parameters)
        self.mass: list[list[Uncertain]] = [[by_parameters(entry, self.n) for entry in row] for row in mass]

    @property
    def symmetric(self) -> bool:
        """Whether M = Mᵀ for all angles and parameters."""
        return all(self.mass[i][j] == self.mass[j][i] for i in range(self.n) for j in range(i))

    def above(self, low: Fraction) -> bool:
        """Whether M(q) − low·I is positive definite throughout, by boxes that are cut until they show it.

        Soundness: the boxes cover all angles that occur and all parameters; on each of them every symmetric
            matrix of the enclosure is positive definite.
        """
        angles = angles_in(self.mass)
        start: Box = (*[(-PI_ABOVE, PI_ABOVE)] * len(angles), *map(_side, self.parameters))
        whole = [high - low_end for low_end, high in start]
        waiting, count = [start], 0
        with precision(BITS):
            arithmetics = [_Over(self, angles, low, of) for of in (BALLS, SPANS)]
            while waiting:
                box, count = waiting.pop(), count + 1
                if any(over.positive_definite(box) for over in arithmetics):
                    continue
                if count > MOST_BOXES or not box:
                    return False
                widest = max(range(len(box)), key=lambda i: (box[i][1] - box[i][0]) / (whole[i] or 1))
                waiting += halves(box, widest)
        return True

    def at(self, q: Sequence[Fraction], parameters: Sequence[Fraction]) -> list[list[arb]]:
        """M in balls at one posture and one choice of the parameters."""
        return [[_value(entry, q, parameters) for entry in row] for row in self.mass]

    def coriolis(
        self, q: Sequence[Fraction], parameters: Sequence[Fraction], x: Sequence[arb], y: Sequence[arb]
    ) -> list[arb]:
        """C(q, x)y in balls, (Σ_jk c_ijk x_k y_j)_i."""
        found = [arb(0)] * self.n
        for (i, j, k), symbol in uncertain_christoffel(self.mass).items():
            value = _value(symbol, q, parameters)
            found[i] += value * (x[k] * y[j] if j == k else x[k] * y[j] + x[j] * y[k])
        return found

    def largest_row(self) -> Fraction:
        """A bound of ‖M(q)‖: the largest sum of a row of sizes of entries."""
        return max(sum(map(self._size, row), Fraction(0)) for row in self.mass)

    def squares_of_symbols(self) -> Fraction:
        """A bound of Σ c_ijk², which ‖C(q, x)y‖² ≤ Σ c_ijk² ‖x‖²‖y‖² asks for, by Cauchy–Schwarz twice."""
        symbols = uncertain_christoffel(self.mass)
        return sum(
            ((1 if j == k else 2) * self._size(c) ** 2 for (_, j, k), c in symbols.items()), Fraction(0)
        )

    def _size(self, entry: Uncertain) -> Fraction:
        sizes = [max(abs(low), abs(high)) for low, high in self.parameters]
        return sum(
            (
                largest(part) * prod(x**p for x, p in zip(sizes, powers, strict=True))
                for powers, part in entry.items()
            ),
            Fraction(0),
        )


class _Over:
    """M − low·I over boxes, in one arithmetic."""

    def __init__(self, inertia: Inertia, angles: tuple[int, ...], low: Fraction, of: Arithmetic) -> None:
        self.n, self.angles, self.of = inertia.n, angles, of
        self.low = of.value(to_arb(low))
        self.entries = [[Polynomial(entry) for entry in row] for row in inertia.mass]
        self.used = sorted({k for row in self.entries for entry in row for k in entry.used})

    def positive_definite(self, box: Box) -> bool:
        """Whether the matrix is, all over a box of angles and parameters."""
        q, middle = [arb(0)] * self.n, [arb(0)] * self.n
        for joint, side in zip(self.angles, box, strict=False):
            q[joint], middle[joint] = _ball(side), arb(0.5 * (side[0] + side[1]))
        offset = [self.of.value(a - b) for a, b in zip(q, middle, strict=True)]
        parameters = [self.of.value(_ball(side)) for side in box[len(self.angles) :]]
        over = waves(self.used, q, self.of), waves(self.used, middle, self.of), offset, parameters, self.of
        rows = [[entry.over(*over) for entry in row[: i + 1]] for i, row in enumerate(self.entries)]
        for i, row in enumerate(rows):
            row[i] = row[i] - self.low
        return self.of.positive_definite(rows)


def _value(entry: Uncertain, q: Sequence[Fraction], parameters: Sequence[Fraction]) -> arb:
    """An entry in balls at one posture."""
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
