"""M(q) and the Christoffel symbols of an arm over boxes of joint angles."""

from __future__ import annotations

from collections.abc import Mapping
from fractions import Fraction
from functools import cached_property
from itertools import product

from lyapcheck.intervals.functions import cosine, sine
from lyapcheck.intervals.interval import Interval
from lyapcheck.robots import RobotModel
from lyapcheck.robots.harmonics import Gaussian, Harmonic, Harmonics, derivative, harmonics

Place = tuple[int, ...]
Columns = dict[Harmonic, tuple[Interval, Interval]]


class ArmIntervals:
    """The exact polynomials of an arm without parameters, as harmonics evaluated over boxes.

    An entry is enclosed twice: by the ranges of its harmonics, and by its value in the middle of the box
    plus its slopes times the half widths (mean value form); both hold, so their intersection does.

    Args:
        model: the arm; ``RobotModel.fixed`` has put its parameters to exact values.
    """

    def __init__(self, model: RobotModel) -> None:
        self.model = model
        self.n = model.n
        joints = range(self.n)
        self.mass = {
            (i, j): harmonics(model.mass[i][j])
            for i, j in product(joints, repeat=2)
            if j <= i and model.mass[i][j] != 0
        }
        self.christoffel = {
            (i, j, k): harmonics(model.christoffel[i][j][k])
            for i, j, k in product(joints, repeat=3)
            if k <= j and model.christoffel[i][j][k] != 0
        }

    @cached_property
    def angles(self) -> tuple[int, ...]:
        """The joints whose angle M depends on; all others may be held at 0."""
        used = {i for terms in self.mass.values() for k in terms for i, factor in enumerate(k) if factor}
        return tuple(sorted(used))

    def at(self, q: list[Interval]) -> ArmBox:
        """The arm over a box: one interval of angles in rad for each joint, as arrays over many boxes."""
        return ArmBox(self, q)


class ArmBox:
    """M and the Christoffel symbols over one array of boxes."""

    def __init__(self, arm: ArmIntervals, q: list[Interval]) -> None:
        self.arm = arm
        self._wide = _columns(arm, q)
        centre = [Interval(x.mid, x.mid) for x in q]
        self._centre = _columns(arm, centre)
        self._offset = [x - c for x, c in zip(q, centre, strict=True)]

    def mass(self) -> list[list[Interval | float]]:
        """M, n × n; entries that vanish identically are the number 0."""
        entries = {place: self._enclosed(terms) for place, terms in self.arm.mass.items()}
        joints = range(self.arm.n)
        return [[entries.get((max(i, j), min(i, j)), 0.0) for j in joints] for i in joints]

    def symbols(self) -> dict[Place, Interval]:
        """The Christoffel symbols c_ijk with k ≤ j that do not vanish identically; c_ijk = c_ikj."""
        return {place: self._enclosed(terms) for place, terms in self.arm.christoffel.items()}

    def _enclosed(self, terms: Harmonics) -> Interval:
        natural = _combine(terms, self._wide)
        mean = _combine(terms, self._centre)
        for i in self.arm.angles:
            slope = derivative(terms, i)
            if slope:
                mean = mean + _combine(slope, self._wide) * self._offset[i]
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


def magnitude(terms: Harmonics) -> float:
    """A rough bound of the size of a polynomial, for choosing where to split."""
    return float(sum(abs(a) + abs(b) for a, b in terms.values()))


def _columns(arm: ArmIntervals, q: list[Interval]) -> Columns:
    """cos and sin of every harmonic that occurs."""
    used = {k for terms in (*arm.mass.values(), *arm.christoffel.values()) for k in terms if any(k)}
    columns: Columns = {}
    for k in sorted(used):
        angle = _angle(k, q)
        columns[k] = cosine(angle), sine(angle)
    return columns


def _angle(k: Harmonic, q: list[Interval]) -> Interval:
    parts = [x * float(factor) for factor, x in zip(k, q, strict=True) if factor]
    return sum(parts[1:], parts[0])


def _combine(terms: Mapping[Harmonic, Gaussian], columns: Columns) -> Interval:
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
