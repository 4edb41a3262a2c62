"""M(q) and the Christoffel symbols over boxes of joint angles, in balls or spans."""

from __future__ import annotations

import math
from collections.abc import Sequence
from typing import Any

from flint import arb

from lyapcheck.check.loop.arithmetic import Arithmetic
from lyapcheck.check.numbers.balls import to_arb
from lyapcheck.check.numbers.harmonics import Harmonics, Uncertain, derivative

Value = Any
Waves = dict[tuple[int, ...], tuple[Value, Value]]


class Polynomial:
    """A trigonometric polynomial and its slopes, enclosed over boxes by two forms that both hold.

    Its coefficients are polynomials in the parameters; each power of those is enclosed on its own.
    """

    def __init__(self, entry: Uncertain) -> None:
        self.parts = [(powers, Part(terms)) for powers, terms in entry.items()]
        self.used = [k for terms in entry.values() for k in terms if any(k)]

    def over(
        self, wide: Waves, centre: Waves, offset: list[Value], parameters: Sequence[Value], of: Arithmetic
    ) -> Value:
        """The values over a box of angles and parameters."""
        total = of.value(arb(0))
        for powers, part in self.parts:
            value = part.over(wide, centre, offset, of)
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

    def over(self, wide: Waves, centre: Waves, offset: list[Value], of: Arithmetic) -> Value:
        """The values over a box of angles."""
        natural = _combined(self.terms, wide, of)
        if not self.slopes:
            return natural
        mean = _combined(self.terms, centre, of)
        for i, slope in self.slopes:
            mean = mean + _combined(slope, wide, of) * offset[i]
        return of.meet(natural, mean)


Lifted = list[tuple[tuple[int, ...], arb, arb]]


def _lifted(terms: Harmonics) -> Lifted:
    return [(k, to_arb(a), to_arb(b)) for k, (a, b) in terms.items()]


def _combined(terms: Lifted, waves: Waves, of: Arithmetic) -> Value:
    total = of.value(arb(0))
    for k, a, b in terms:
        if k in waves:
            cosine, sine = waves[k]
            total = total + of.value(a) * cosine + of.value(b) * sine
        else:
            total = total + of.value(a)
    return total


def waves(used: Sequence[tuple[int, ...]], q: Sequence[arb], of: Arithmetic) -> Waves:
    """cos and sin of every harmonic."""
    found: Waves = {}
    for k in used:
        angle = sum((factor * x for factor, x in zip(k, q, strict=True) if factor), arb(0))
        found[k] = of.value(cosine_range(angle)), of.value(cosine_range(angle - arb.pi() / 2))
    return found


def cosine_range(x: arb) -> arb:
    """cos over a ball: the hull of both ends and of the extremes ±1 at the multiples of π in between."""
    low, high = x.lower(), x.upper()
    found = low.cos().union(high.cos())
    turns = range(math.floor(float(low) / math.pi) - 1, math.ceil(float(high) / math.pi) + 2)
    for k in turns:
        place = k * arb.pi()
        if not (place < low or place > high):
            found = found.union(arb((-1) ** k))
    return found
