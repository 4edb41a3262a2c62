"""M(q) and the Christoffel symbols of an arm over boxes of joint angles."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from fractions import Fraction
from functools import lru_cache

import numpy as np
from flint import arb

from lyapcheck._types import Array
from lyapcheck.check.numbers.harmonics import (
    Gaussian,
    Harmonic,
    Harmonics,
    Uncertain,
    angles_in,
    derivative,
    uncertain_christoffel,
)
from lyapcheck.check.numbers.polynomials import Enclosure
from lyapcheck.family import Family
from lyapcheck.search.interval import TINY, Interval, cosine, sine, widened

Place = tuple[int, int, int]
Columns = dict[Harmonic, tuple[Interval, Interval]]


class ArmIntervals:
    """M(q) and the Christoffel symbols as harmonics, evaluated over boxes of angles in rad.

    Each power of the parameters is enclosed twice: by the ranges of its harmonics, and by its value in the
    middle of the box plus its slopes times the half widths (mean value form); both hold, so their
    intersection does.

    Args:
        mass: the entries of M, rows of harmonics by powers of the parameters, kg·m².
    """

    def __init__(self, mass: Sequence[Sequence[Uncertain]]) -> None:
        self.n = len(mass)
        joints = range(self.n)
        self.mass = {(i, j): mass[i][j] for i in joints for j in joints if j <= i and mass[i][j]}
        self.christoffel = uncertain_christoffel(mass)
        self.angles = angles_in(mass)
        """The joints whose angle M depends on; all others may be held at 0."""

    def at(self, q: list[Interval], parameters: Sequence[Interval] = ()) -> ArmBox:
        """The arm over a box: angles in rad for each joint, and its parameters, as arrays over many boxes."""
        return ArmBox(self, q, parameters)


class ArmBox:
    """M and the Christoffel symbols over one array of boxes."""

    def __init__(self, arm: ArmIntervals, q: list[Interval], parameters: Sequence[Interval] = ()) -> None:
        self.arm = arm
        self._parameters = parameters
        self.wide = _columns(arm, q)
        centre = [Interval(x.mid, x.mid) for x in q]
        self.centre = _columns(arm, centre)
        self._offset = [x - c for x, c in zip(q, centre, strict=True)]

    def mass(self) -> list[list[Interval | float]]:
        """M, n × n; entries that vanish identically are the number 0."""
        entries = {place: self._enclosed(terms) for place, terms in self.arm.mass.items()}
        joints = range(self.arm.n)
        return [[entries.get((max(i, j), min(i, j)), 0.0) for j in joints] for i in joints]

    def symbols(self) -> dict[Place, Interval]:
        """The Christoffel symbols c_ijk with k ≤ j that do not vanish identically; c_ijk = c_ikj."""
        return {place: self._enclosed(terms) for place, terms in self.arm.christoffel.items()}

    def _enclosed(self, entry: Uncertain) -> Interval:
        total: Interval | None = None
        for powers, terms in entry.items():
            part = self.part(terms)
            for parameter, power in zip(self._parameters, powers, strict=True):
                for _ in range(power):
                    part = part * parameter
            total = part if total is None else total + part
        return Interval.exact(0.0) if total is None else total

    def part(self, terms: Harmonics) -> Interval:
        """One power of the parameters, without these."""
        natural = combine(terms, self.wide)
        mean = combine(terms, self.centre)
        for i in self.arm.angles:
            slope = derivative(terms, i)
            if slope:
                mean = mean + combine(slope, self.wide) * self._offset[i]
        return natural.meet(mean)


def _columns(arm: ArmIntervals, q: list[Interval]) -> Columns:
    """cos and sin of every harmonic that occurs."""
    entries = (*arm.mass.values(), *arm.christoffel.values())
    used = {k for entry in entries for terms in entry.values() for k in terms if any(k)}
    columns: Columns = {}
    for k in sorted(used):
        parts = [x * float(factor) for factor, x in zip(k, q, strict=True) if factor]
        angle = sum(parts[1:], parts[0])
        columns[k] = cosine(angle), sine(angle)
    return columns


def combine(terms: Mapping[Harmonic, Gaussian], columns: Columns) -> Interval:
    """Σ a cos + b sin, with exact coefficients enclosed."""
    total: Interval | None = None
    for k, (a, b) in terms.items():
        pieces = [(a, columns[k][0])] if any(k) else [(a, Interval.exact(1.0))]
        pieces += [(b, columns[k][1])] if any(k) else []
        for coefficient, column in pieces:
            if coefficient:
                piece = _times(coefficient, column)
                total = piece if total is None else total + piece
    return Interval.exact(0.0) if total is None else total


def _times(coefficient: Fraction, column: Interval) -> Interval:
    exact = float(coefficient)
    if Fraction(exact) == coefficient:
        return column * exact
    return column * Interval.of(coefficient)


# --- h and h' of a family over intervals: hulls of end values and of the extremes in between.
#
# In doubles the member m loses 4m + 8 units in the last place of h. Of h' it loses as many of the size of its
# terms, which is at most 4m, and cancels where |sinh x| > 1 alone; see `lyapcheck.family.members.hyperbolic`.


_BORDER = 0.88
"""Below asinh 1."""


@dataclass(frozen=True)
class TurningPoint:
    """An x ≥ 0 at which a function may turn, and its value there, each between two doubles."""

    where: tuple[float, float]
    value: tuple[float, float]


def h_range(family: Family, x: Interval) -> Interval:
    """All values of h over the intervals: h is odd and monotone between its extremes."""
    extrema = _turning_points(family)[0]
    mirrored = [
        TurningPoint((-p.where[1], -p.where[0]), (-p.value[1], -p.value[0]))
        for p in extrema
        if p.where[1] > 0
    ]
    return _range(family.h, [*extrema, *mirrored], x, _lost(family), TINY)


def dh_range(family: Family, x: Interval) -> Interval:
    """All values of h' over the intervals: h' is even and monotone between its extremes."""
    extrema = _turning_points(family)[1]
    mirrored = [TurningPoint((-p.where[1], -p.where[0]), p.value) for p in extrema if p.where[1] > 0]
    cancels = np.maximum(np.abs(x.lo), np.abs(x.hi)) > _BORDER
    least = np.where(cancels, 4 * (family.m or 1) * _lost(family), TINY)
    return _range(family.dh, [*extrema, *mirrored], x, _lost(family), least)


def _lost(family: Family) -> float:
    """Of h in doubles, relatively."""
    return (4 * (family.m or 1) + 8) * 2.0**-52


def _range(
    function: Callable[[Array], Array],
    extrema: list[TurningPoint],
    x: Interval,
    slack: float,
    least: Array | float,
) -> Interval:
    # the function at both ends; boxes made by halving share most ends, and equal ones are done once
    ends = np.concatenate([np.ravel(x.lo), np.ravel(x.hi)])
    distinct, index = np.unique(ends, return_inverse=True)
    values = function(distinct)[index.ravel()]
    half = values.size // 2
    a, b = values[:half].reshape(np.shape(x.lo)), values[half:].reshape(np.shape(x.hi))
    result = widened(np.minimum(a, b), np.maximum(a, b), slack, least)
    low, high = result.lo, result.hi
    for point in extrema:
        inside = (x.lo <= point.where[1]) & (x.hi >= point.where[0])
        low = np.where(inside, np.minimum(low, point.value[0]), low)
        high = np.where(inside, np.maximum(high, point.value[1]), high)
    return Interval(low, high)


@lru_cache(maxsize=256)
def _turning_points(family: Family) -> tuple[tuple[TurningPoint, ...], tuple[TurningPoint, ...]]:
    """The x ≥ 0 at which h, and at which h', may stop being monotone."""
    h_turns, dh_turns = family.turning_points()
    h = tuple(_extreme(family.ball_h, where) for where in h_turns)
    return h, tuple(_extreme(family.ball_dh, where) for where in (arb(0), *dh_turns))


def _extreme(function: Callable[[arb], arb], where: arb) -> TurningPoint:
    place, value = Enclosure.from_arb(where), Enclosure.from_arb(function(where))
    return TurningPoint((place.float_lower, place.float_upper), (value.float_lower, value.float_upper))
