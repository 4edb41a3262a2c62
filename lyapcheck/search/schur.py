"""P of ``lyapcheck.check.loop`` over many boxes at once: by its ranges, and by its middle and its slopes.

What is found positive definite here is only a proposal: the checker looks at every box again, in balls.
"""

from __future__ import annotations

from collections.abc import Iterable
from functools import cached_property
from itertools import count
from typing import Any

import numpy as np
from numpy.typing import NDArray

from lyapcheck._types import Array
from lyapcheck.check.loop.arithmetic import Ring
from lyapcheck.check.loop.closed_loop import ClosedLoop
from lyapcheck.check.loop.field import ball
from lyapcheck.check.loop.proof import MOST_CENTRED
from lyapcheck.check.loop.schur import Centred, Errors, form, of_error, transformed, triangle
from lyapcheck.check.numbers.harmonics import Uncertain, derivative, largest
from lyapcheck.constants.constant import Torus
from lyapcheck.search.boxes import Interval, norm, of_sides, positive_definite, unit_vector

SMALL = 1.0
"""Length of sides, rad, below which slopes are tried."""
BEYOND = 1 + 1e-12
"""As a multiple of the radius of the tail: doubles are not balls."""
ANGLES = 0.25
"""Share of the estimate of an angle that counts: M is enclosed more tightly than its slopes say.

Trees for 0.99 of the falsified ε₀ and beyond have a tenth to all of the boxes that they have with 1.
"""
TINY = 1e-300


class SchurProblem:
    """One controller on one arm at one ε₀, ready to be enclosed over boxes (count, 2, sides).

    Args:
        loop: what is to be proved; its ``start`` says which side is which.
    """

    def __init__(self, loop: ClosedLoop) -> None:
        self.loop, self.first = loop, len(loop.angles)
        member, self.slopes_help = loop.member, loop.n <= MOST_CENTRED and loop.member.d2h is not None
        joints = range(loop.n)
        entries = {(i, j): loop.mass[i][j] for i in joints for j in range(i + 1)} | loop.symbols
        self.parts = [(place, powers, x) for place, entry in entries.items() for powers, x in entry.items()]
        harmonics = [x for _, _, x in self.parts]
        self.torus = Torus(harmonics, loop.n, sheared=False)
        turned = [derivative(x, i) for i in loop.angles for x in harmonics]
        self.turning = Torus(turned, loop.n, sheared=False)
        self.of_error = of_sides(lambda side: (member.h(ball(side)), member.dh(ball(side))))
        self.of_middle = of_sides(lambda side: [x for part in of_error(member, side) for x in part])
        self.last: tuple[Array, Array] = np.empty((0, 2, 0)), np.empty((0, 0))

    def proved(self, boxes: Array) -> NDArray[np.bool_]:
        """Where P ≻ 0 on the whole box, up to rounding, or all of it lies beyond the radius of the tail."""
        proved = self.by_ranges(boxes)
        left = np.flatnonzero(~proved & self._small(boxes))
        if len(left):
            shown, moved = self._by_slopes(boxes[left])
            proved[left] = shown
            # those that are left will be asked for their sides
            self.last = boxes[left[~shown]], moved[:, ~shown]
        return proved

    def by_ranges(self, boxes: Array) -> NDArray[np.bool_]:
        """The same by the ranges of the entries of P alone."""
        with np.errstate(all="ignore"):
            at = _Boxes(self, boxes, slopes=False)
            inside, beyond = positive_definite(at.P()), norm(at.e).lo >= self.loop.radius * BEYOND
        return np.asarray(np.all(boxes[:, 0] <= boxes[:, 1], axis=1) & (inside | beyond))

    def sides(self, boxes: Array) -> NDArray[np.intp]:
        """The side of every box that should be halved; where T P Tᵀ is known, it moves most over that."""
        sides, small = self.by_estimate(boxes), np.flatnonzero(self._small(boxes))
        if len(small):
            last, moved = self.last
            same = np.array_equal(boxes[small], last[: len(small)])
            moved = moved[:, : len(small)] if same else self._by_slopes(boxes[small])[1]
            known = np.isfinite(moved).all(axis=0)
            sides[small[known]] = np.argmax(moved, axis=0)[known]
        return sides

    def by_estimate(self, boxes: Array) -> NDArray[np.intp]:
        """The side whose length moves P most by rough estimates, relative to the friction of each joint."""
        (slopes, inertia, coriolis), first = self._estimates, self.first
        half = 0.5 * (boxes[:, 1] - boxes[:, 0])
        weights = np.empty_like(half)
        weights[:, :first] = ANGLES * half[:, :first] * slopes * max(float(self.loop.member.rho), 1.0)
        for i in range(self.loop.n):
            h, dh = self.of_error(Interval(boxes[:, 0, first + i], boxes[:, 1, first + i]))
            weights[:, first + i] = inertia[i] * (dh.radius + half[:, first + i] * 0.5) + coriolis * h.radius
        uncertain = boxes[:, :, first + self.loop.n :]
        middle = np.maximum(np.abs(uncertain.mean(axis=1)), 1e-12)
        weights[:, first + self.loop.n :] = half[:, first + self.loop.n :] / middle * inertia.max(initial=1.0)
        return np.asarray(np.argmax(weights, axis=1))

    @cached_property
    def _estimates(self) -> tuple[Array, Array, float]:
        """Slopes of M by each angle, row sums of M, and the largest Christoffel symbol."""
        loop, ends = self.loop, [float(max(abs(low), abs(high))) for low, high in self.loop.parameters]

        def size(entry: Uncertain) -> float:
            """A rough bound at the upper ends of the parameters."""
            parts = ((float(largest(x)), np.prod(np.power(ends, powers))) for powers, x in entry.items())
            return float(sum(x * scale for x, scale in parts))

        root = np.sqrt([float(low) for low, _ in loop.friction])
        sizes, slopes = np.zeros((loop.n, loop.n)), np.zeros(self.first)
        for i, row in enumerate(loop.mass):
            for j, entry in enumerate(row):
                sizes[i, j] = size(entry) / (root[i] * root[j])
                for column, joint in enumerate(loop.angles):
                    slope = size({powers: derivative(x, joint) for powers, x in entry.items()})
                    slopes[column] = max(slopes[column], slope / (root[i] * root[j]))
        coriolis = max(map(size, loop.symbols.values()), default=0.0) / float(root.min() ** 2)
        return slopes, sizes.sum(axis=0), coriolis

    def _small(self, boxes: Array) -> NDArray[np.bool_]:
        """Boxes small enough in q and e for slopes to say more than ranges."""
        last = self.first + self.loop.n if self.slopes_help else 0
        sides = boxes[:, 1, :last] - boxes[:, 0, :last]
        return np.asarray(np.all(sides < SMALL, axis=1) & self.slopes_help)

    def _by_slopes(self, boxes: Array) -> tuple[NDArray[np.bool_], Array]:
        """Where T P Tᵀ ≻ 0 on the whole box; how much each side moves it, relative to its diagonal."""
        with np.errstate(all="ignore"):
            at = _Boxes(self, boxes, slopes=True)
            rows = at.P()
            Q = transformed(rows, triangle([[entry.middle for entry in row] for row in rows]))
            moved = [[(x, s.size * at.half) for x, s in row] for row in Q]
            shown = positive_definite(
                [[Interval.around(x, np.sum(y, axis=0)) for x, y in row] for row in moved]
            )
            # at e = 0 ê has no slopes
            shown &= np.any([(x.lo > 0) | (x.hi < 0) for x in at.e], axis=0)
            diagonal = [np.maximum(row[i][0], TINY) for i, row in enumerate(Q)]
            total = np.zeros_like(at.half)
            for i, row in enumerate(moved):
                for j, (_, each) in enumerate(row):
                    more = 1 if i == j else 2 * np.sum(each, axis=0) / diagonal[j]
                    total += each * more / diagonal[i]
        return shown, total


class _Boxes:
    """P over some boxes: its entries as ranges, or each with its middle and its slopes."""

    def __init__(self, problem: SchurProblem, boxes: Array, slopes: bool) -> None:
        self.problem, self.loop, self.slopes = problem, problem.loop, slopes
        self.ring = Ring(_constant, _square) if slopes else Ring(float, Interval.square)
        columns = [Interval(boxes[:, 0, k], boxes[:, 1, k]) for k in range(boxes.shape[2])]
        first, last = problem.first, problem.first + problem.loop.n
        self.angles, self.e, self.uncertain = columns[:first], columns[first:last], columns[last:]
        self.half = np.stack([x.radius for x in columns])

    def P(self) -> list[list[Any]]:
        """The entries on and below the diagonal."""
        free = count(len(self.half) - len(self.uncertain))
        sides, number = iter(self.uncertain), self.ring.value
        one = Interval(np.ones(()), np.ones(()))
        uncertain = [
            self._placed((x := next(sides)).middle, x, [(next(free), one)])
            if low < high
            else number(float(low))
            for low, high in (*self.loop.parameters, *self.loop.friction)
        ]
        ranging = len(self.loop.parameters)
        return form(*self._arm(uncertain[:ranging]), self._errors(), uncertain[ranging:], self.ring)

    def _placed(self, middle: Array, hull: Interval, slopes: Iterable[tuple[int, Interval]]) -> Any:
        """A value, from its middle, its range and its slopes by some sides, which are 0 by the others."""
        if not self.slopes:
            return hull
        low, high = np.zeros((2, *self.half.shape))
        for side, slope in slopes:
            low[side], high[side] = slope.lo, slope.hi
        return Centred(middle, hull, Interval(low, high))

    def _arm(self, parameters: list[Any]) -> tuple[list[list[Any]], dict[tuple[int, int, int], Any]]:
        """M and the Christoffel symbols."""
        middle, half = np.zeros((2, self.half.shape[1], self.loop.n))
        for joint, x in zip(self.loop.angles, self.angles, strict=True):
            middle[:, joint], half[:, joint] = x.middle, x.radius
        parts, at = self.problem.parts, self.problem.torus.on(middle, half)
        turned = self.problem.turning.on(middle, half).reach if self.slopes else None
        low, high = at.reach
        values: dict[tuple[int, ...], Any] = {}
        for k, (place, powers, _) in enumerate(parts):
            slopes = (
                (side, Interval(*(end[:, side * len(parts) + k] for end in turned)))
                for side in range(self.problem.first)
                if turned is not None
            )
            part = self._placed(at.value[:, k], Interval(low[:, k], high[:, k]), slopes)
            for parameter, power in zip(parameters, powers, strict=True):
                for _ in range(power):
                    part = part * parameter
            values[place] = values[place] + part if place in values else part
        joints, zero = range(self.loop.n), self.ring.value(0.0)
        M = [[values.get((max(i, j), min(i, j)), zero) for j in joints] for i in joints]
        return M, {place: values[place] for place in self.loop.symbols}

    def _errors(self) -> Errors:
        loop, first, number, e = self.loop, self.problem.first, self.ring.value, self.e
        h: list[Any] = []
        dh: list[Any] = []
        for side, (x, scale) in enumerate(zip(e, loop.Lambda, strict=True), start=first):
            known = self.problem.of_middle(x) if self.slopes else self.problem.of_error(x)
            step = len(known) // 2
            for values, own in ((h, known[:step]), (dh, known[step:])):
                value = self._placed(own[0].middle, own[1], [(side, own[2])]) if self.slopes else own[0]
                values.append(value * number(float(scale)))
        joints, r, unit, c = range(loop.n), norm(e), unit_vector(e), [x.middle for x in e]
        near, at, turn = (r + 1.0).reciprocal(), np.sqrt(sum(x * x for x in c)), r.reciprocal()
        falls = ((first + k, unit[k] * near.square() * -1.0) for k in joints)
        shrink = self._placed(1 / (1 + at), near, falls)
        along = []
        for j in joints:
            turns = ((first + k, (float(j == k) - unit[j] * unit[k]) * turn) for k in joints)
            along.append(self._placed(c[j] / at, unit[j], turns) * shrink)
        eps = shrink * number(float(loop.eps0))
        return Errors(None, eps, [eps * number(float(1 / (4 * k))) for k in loop.stiffness], h, dh, along)


def _constant(value: Any) -> Centred:
    number, zero = np.asarray(float(value)), np.zeros(())
    return Centred(number, Interval(number, number), Interval(zero, zero))


def _square(x: Centred) -> Centred:
    return Centred(x.middle**2, x.hull.square(), x.slopes * (x.hull + x.middle))
