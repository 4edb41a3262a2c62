"""M(q) and the Christoffel symbols of an arm over boxes of joint angles."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from fractions import Fraction

from lyapcheck.check.numbers.harmonics import (
    Gaussian,
    Harmonic,
    Harmonics,
    Uncertain,
    angles_in,
    derivative,
    uncertain_christoffel,
)
from lyapcheck.intervals.functions import cosine, sine
from lyapcheck.intervals.interval import Interval

Place = tuple[int, ...]
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


def coriolis(symbols: Mapping[Place, Interval], h: list[Interval]) -> list[list[Interval | float]]:
    """C(q, h)_ij = Σ_k c_ijk h_k."""
    n = len(h)
    rows: list[list[Interval | float]] = [[0.0] * n for _ in range(n)]
    for (i, j, k), symbol in symbols.items():
        rows[i][j] = symbol * h[k] + rows[i][j]
        if k != j:
            rows[i][k] = symbol * h[j] + rows[i][k]
    return rows


def _columns(arm: ArmIntervals, q: list[Interval]) -> Columns:
    """cos and sin of every harmonic that occurs."""
    entries = (*arm.mass.values(), *arm.christoffel.values())
    used = {k for entry in entries for terms in entry.values() for k in terms if any(k)}
    columns: Columns = {}
    for k in sorted(used):
        angle = _angle(k, q)
        columns[k] = cosine(angle), sine(angle)
    return columns


def _angle(k: Harmonic, q: list[Interval]) -> Interval:
    parts = [x * float(factor) for factor, x in zip(k, q, strict=True) if factor]
    return sum(parts[1:], parts[0])


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
