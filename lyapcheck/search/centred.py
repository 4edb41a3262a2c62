"""P by its middle and its slopes, as ``lyapcheck.check.loop.schur`` has it, over many boxes at once.

In doubles without directed rounding: the checker looks at all of it again, in balls, which discs imitate.
"""

from __future__ import annotations

from dataclasses import dataclass
from itertools import count

import numpy as np
from flint import arb
from numpy.typing import NDArray

from lyapcheck._types import Array
from lyapcheck.check.loop.arithmetic import Ring
from lyapcheck.check.loop.proof import MOST_CENTRED
from lyapcheck.check.loop.schur import Centred, Errors, form, of_error, transformed, triangle
from lyapcheck.check.numbers.balls import to_arb
from lyapcheck.check.numbers.harmonics import Harmonics, Uncertain, derivative
from lyapcheck.search.cover import Chooser, Prover, SchurProblem, Splitter
from lyapcheck.search.interval import Interval, inverse_one_plus, norm, unit_vector
from lyapcheck.search.interval_arm import ArmBox, combine

SURELY = 1e-9
"""What a pivot has to exceed, beside its value in the middle: rounding is not directed."""
SMALL = 1.0
"""Length of sides, rad, below which slopes are tried."""


@dataclass(frozen=True, eq=False)
class Disc:
    """Numbers within a radius of a middle, elementwise."""

    mid: Array
    rad: Array

    @classmethod
    def of(cls, x: Interval) -> Disc:
        """The disc of an interval."""
        return cls(0.5 * (x.lo + x.hi), 0.5 * (x.hi - x.lo))

    def __add__(self, other: Disc) -> Disc:
        return Disc(self.mid + other.mid, self.rad + other.rad)

    def __sub__(self, other: Disc) -> Disc:
        return Disc(self.mid - other.mid, self.rad + other.rad)

    def __mul__(self, other: Disc | Array) -> Disc:
        if not isinstance(other, Disc):
            return Disc(self.mid * other, self.rad * np.abs(other))
        size = np.abs(other.mid) + other.rad
        return Disc(self.mid * other.mid, np.abs(self.mid) * other.rad + self.rad * size)

    @property
    def size(self) -> Array:
        """The largest absolute value."""
        return np.asarray(np.abs(self.mid) + self.rad)

    def square(self) -> Disc:
        """x²."""
        low, high = np.maximum(np.abs(self.mid) - self.rad, 0.0) ** 2, self.size**2
        return Disc(0.5 * (low + high), 0.5 * (high - low))


def judge_of(problem: SchurProblem) -> tuple[Prover, Chooser]:
    """What says of boxes whether P ≻ 0, and which side of the others should be halved."""
    sides = Splitter.of(problem).sides
    if problem.loop.n > MOST_CENTRED or problem.loop.member.d2h is None:
        return problem.proved, sides
    centred = CentredProblem(problem, sides)
    return centred.proved, centred.sides


class CentredProblem:
    """One controller on one arm at one ε₀: boxes by their ranges, and where these fail by middles and slopes.

    Args:
        problem: the same by ranges.
        otherwise: the side of each box that should be halved where there are no slopes.
    """

    def __init__(self, problem: SchurProblem, otherwise: Chooser) -> None:
        self.problem, self.loop, self.otherwise = problem, problem.loop, otherwise
        self.kept: dict[tuple[float, float], Array] = {}
        self.last: tuple[Array, Array] = np.empty((0, 2, 0)), np.empty((0, 0))

    def proved(self, boxes: Array) -> NDArray[np.bool_]:
        """Where P ≻ 0 on the whole box, up to rounding."""
        proved = self.problem.proved(boxes)
        left = np.flatnonzero(~proved & self._small(boxes))
        if len(left):
            at = _At(self, boxes[left])
            proved[left] = shown = at.proved()
            # those that are left will be asked for their sides
            self.last = boxes[left[~shown]], at.moved()[:, ~shown]
        return proved

    def sides(self, boxes: Array) -> NDArray[np.intp]:
        """The side of every box over which T P Tᵀ moves most."""
        sides, small = self.otherwise(boxes), np.flatnonzero(self._small(boxes))
        if len(small):
            moved = self._moved(boxes[small])
            known = np.isfinite(moved).all(axis=0)
            sides[small[known]] = np.argmax(moved, axis=0)[known]
        return sides

    def _small(self, boxes: Array) -> NDArray[np.bool_]:
        """Boxes small enough in q and e for slopes to say more than ranges."""
        count = len(self.loop.angles) + self.loop.n
        return np.asarray(np.all(boxes[:, 1, :count] - boxes[:, 0, :count] < SMALL, axis=1))

    def _moved(self, boxes: Array) -> Array:
        known, moved = self.last
        if np.array_equal(boxes, known[: len(boxes)]):
            return moved[:, : len(boxes)]
        return _At(self, boxes).moved()

    def of_error(self, x: Interval) -> Array:
        """Middles and radii of what `lyapcheck.check.loop.schur.of_error` has, (2, 3, 2, boxes)."""
        sides, index = np.unique(np.stack([x.lo, x.hi], axis=1), axis=0, return_inverse=True)
        known = np.empty((2, 3, 2, len(sides)))
        for k, side in enumerate(map(tuple, sides.tolist())):
            value = self.kept.get(side)
            if value is None:
                both = of_error(self.loop.member, side)
                value = np.array([[(float(y.mid()), float(y.rad())) for y in part] for part in both])
                self.kept[side] = value
            known[..., k] = value
        return known[..., index.ravel()]


class _At:
    """P over some boxes."""

    def __init__(self, of: CentredProblem, boxes: Array) -> None:
        self.of, self.loop, self.shape = of, of.loop, (boxes.shape[2], len(boxes))
        self.problem, middle = of.problem, 0.5 * (boxes[:, 0] + boxes[:, 1])
        self.wide = self.problem.sides(boxes)
        self.centre = self.problem.sides(np.stack([middle, middle], axis=1))
        self.half = 0.5 * (boxes[:, 1] - boxes[:, 0]).T
        self.first = len(self.loop.angles)
        with np.errstate(all="ignore"):
            rows = self._rows()
            self.Q = transformed(rows, triangle([[entry.middle for entry in row] for row in rows]))

    def proved(self) -> NDArray[np.bool_]:
        """Where T P Tᵀ ≻ 0 on the whole box, by the sizes of its entries."""
        with np.errstate(all="ignore"):
            Q = [[Disc(x, np.sum(s.size * self.half, axis=0)) for x, s in row] for row in self.Q]
            proved = np.any([(x.lo > 0) | (x.hi < 0) for x in self.wide.e], axis=0)
            for k, row in enumerate(Q):
                pivot = row[k].mid - row[k].rad
                proved &= pivot > SURELY * (1 + row[k].mid)
                for i in range(k + 1, len(Q)):
                    for j in range(k + 1, i + 1):
                        more = Q[i][k].size * Q[j][k].size / pivot
                        Q[i][j] = Disc(Q[i][j].mid, Q[i][j].rad + more)
        return np.asarray(proved)

    def moved(self) -> Array:
        """How much each side moves T P Tᵀ beside its diagonal, (sides, boxes)."""
        with np.errstate(all="ignore"):
            diagonal = [np.maximum(row[i][0], SURELY) for i, row in enumerate(self.Q)]
            total = np.zeros(self.shape)
            for i, row in enumerate(self.Q):
                for j, (_, slopes) in enumerate(row):
                    each = slopes.size * self.half
                    more = 1 if i == j else 2 * np.sum(each, axis=0) / diagonal[j]
                    total += each * more / diagonal[i]
        return total

    def _rows(self) -> list[list[Centred]]:
        free = count(self.first + self.loop.n)
        ranges = (*self.loop.parameters, *self.loop.friction)
        sides = (*self.wide.parameters, *self.wide.viscous)
        uncertain = [
            self._placed(x.mid, Disc.of(x), {next(free): ONE} if low < high else {})
            for x, (low, high) in zip(sides, ranges, strict=True)
        ]
        parameters, B = uncertain[: len(self.loop.parameters)], uncertain[len(self.loop.parameters) :]
        return form(*self._arm(parameters), self._errors(), B, RING)

    def _placed(self, middle: Array, hull: Disc, slopes: dict[int, Disc]) -> Centred:
        mid, rad = np.zeros((2, *self.shape))
        for side, slope in slopes.items():
            mid[side], rad[side] = slope.mid, slope.rad
        return Centred(middle, hull, Disc(mid, rad))

    def _errors(self) -> Errors:
        e, c = self.wide.e, [x.lo for x in self.centre.e]
        scales = [_constant(to_arb(scale)) for scale in self.loop.Lambda]
        h: list[Centred] = []
        dh: list[Centred] = []
        for side, (x, scale) in enumerate(zip(e, scales, strict=True), start=self.first):
            for values, known in zip((h, dh), self.of.of_error(x), strict=True):
                (middle, _), hull, slope = known
                values.append(self._placed(middle, Disc(*hull), {side: Disc(*slope)}) * scale)
        shrink, along = self._shrink(c)
        eps = _constant(to_arb(self.loop.eps0)) * shrink
        weight = [eps * _constant(1 / (4 * to_arb(k))) for k in self.loop.stiffness]
        return Errors(None, eps, weight, h, dh, along)

    def _shrink(self, c: list[Array]) -> tuple[Centred, list[Centred]]:
        """1/(1 + r) and êᵀ/(1 + r)."""
        e, joints, at = self.wide.e, range(self.loop.n), np.sqrt(sum(x * x for x in c))
        r = norm(e)
        near, unit = inverse_one_plus(r), unit_vector(e)
        fall, turn = near.square() * -1.0, r.reciprocal()
        shrink = self._placed(
            1 / (1 + at), Disc.of(near), {self.first + k: Disc.of(unit[k] * fall) for k in joints}
        )
        along = []
        for j in joints:
            turns = {self.first + k: Disc.of((float(j == k) - unit[j] * unit[k]) * turn) for k in joints}
            along.append(self._placed(c[j] / at, Disc.of(unit[j]), turns) * shrink)
        return shrink, along

    def _arm(
        self, parameters: list[Centred]
    ) -> tuple[list[list[Centred]], dict[tuple[int, int, int], Centred]]:
        arm, zero = self.problem.arm, _constant(arb(0))
        box = arm.at(self.wide.q)

        def value(entry: Uncertain) -> Centred:
            total = zero
            for powers, terms in entry.items():
                part = self._part(box, terms)
                for parameter, power in zip(parameters, powers, strict=True):
                    for _ in range(power):
                        part = part * parameter
                total = total + part
            return total

        below, joints = {place: value(entry) for place, entry in arm.mass.items()}, range(self.loop.n)
        M = [[below.get((max(i, j), min(i, j)), zero) for j in joints] for i in joints]
        return M, {place: value(entry) for place, entry in arm.christoffel.items()}

    def _part(self, box: ArmBox, terms: Harmonics) -> Centred:
        slopes = {}
        for side, i in enumerate(self.loop.angles):
            slope = derivative(terms, i)
            if slope:
                slopes[side] = Disc.of(combine(slope, box.wide))
        middle = combine(terms, box.centre)
        return self._placed(middle.mid, Disc.of(box.part(terms)), slopes)


def _constant(value: arb) -> Centred:
    number = np.asarray(float(value))
    zero = np.zeros(())
    return Centred(number, Disc(number, zero), Disc(zero, zero))


def _square(x: Centred) -> Centred:
    return Centred(x.middle**2, x.hull.square(), x.slopes * (x.hull + Disc(x.middle, np.zeros(()))))


ONE = Disc(np.ones(()), np.zeros(()))
RING = Ring(_constant, _square)
