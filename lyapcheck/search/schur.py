"""P of ``lyapcheck.check.loop`` over many boxes at once, by its ranges.

What is found positive definite here is only a proposal: the checker looks at every box again, in balls.
"""

from __future__ import annotations

from collections.abc import Sequence
from functools import cached_property

import numpy as np
from numpy.typing import NDArray

from lyapcheck._types import Array
from lyapcheck.check.loop import ClosedLoop
from lyapcheck.check.loop.field import Ring, ball
from lyapcheck.check.loop.schur import Errors, Value, form
from lyapcheck.check.numbers.harmonics import Harmonics, Uncertain, derivative, largest
from lyapcheck.search.boxes import Interval, norm, of_sides, positive_definite, unit_vector

RING = Ring(float, Interval.square)
"""Intervals beside exact numbers."""
NEAR = 0.05
"""rad: harmonics that turn by more are bounded by their ranges, with which trees have the fewest boxes."""
SLACK = 1e-12
"""Times the sizes of all coefficients: far more than the rounding of sines, products and sums amounts to."""
BEYOND = 1 + 1e-12
"""As a multiple of the radius of the tail: doubles are not balls."""
ANGLES = 0.25
"""Share of the estimate of an angle that counts: M is enclosed more tightly than its slopes say.

Trees for 0.99 of the falsified ε₀ and beyond have a tenth to all of the boxes that they have with 1.
"""


class Reach:
    """What trigonometric polynomials of n joints reach on boxes of angles, in doubles.

    Over a box with half widths r a harmonic cos(k·q) or sin(k·q) turns by at most d = Σ |k_i| r_i from its
    value in the middle, and by at most d²/2 from its linear part. Harmonics that turn far are bounded by
    their exact range, those that hardly turn by their slope and what is sharper than the square.
    """

    def __init__(self, entries: Sequence[Harmonics], n: int) -> None:
        sums = [
            {(k, odd): x for k, ab in entry.items() for odd, x in enumerate(ab) if x} for entry in entries
        ]
        keys = sorted({key for entry in sums for key in entry}) or [((0,) * n, 0)]
        coefficients = np.array([[float(entry.get(key, 0)) for entry in sums] for key in keys])
        self._coefficients: Array = coefficients.reshape(len(keys), len(entries))
        self._sizes: Array = np.abs(self._coefficients)
        self._slack: Array = SLACK * self._sizes.sum(axis=0)
        self._multiples: Array = np.array([k for k, _ in keys], dtype=np.float64)
        self._sine = np.array([sine for _, sine in keys]) > 0

    def on(self, middle: Array, half: Array) -> tuple[Array, Array]:
        """Both ends over boxes, given by their middles and half widths (boxes, n), each (boxes, entries)."""
        angle, turn = middle @ self._multiples.T, half @ np.abs(self._multiples).T
        sine, cosine = np.sin(angle), np.cos(angle)
        values, turned = np.where(self._sine, sine, cosine), np.where(self._sine, cosine, -sine)
        near, far = turn < NEAR, np.minimum(turn, np.pi)
        along, across = np.cos(far), turned * np.sin(far)
        ends = values * along + across, values * along - across
        low = np.where(-values >= along, -1.0, np.minimum(*ends))
        high = np.where(values >= along, 1.0, np.maximum(*ends))
        # v cos d + u sin d at the distance d, v the value and u the slope: what is left of it without u d
        most = np.minimum(turn, NEAR)
        least = np.cos(most)
        bent = np.abs(values) * 0.5 * (1 - least) + np.abs(turned) * (most - np.sin(most))
        middles = np.where(near, values * 0.5 * (1 + least), 0.5 * (low + high)) @ self._coefficients
        radius = (np.where(near, bent, 0.5 * (high - low)) @ self._sizes + self._slack) * (1.0 + 1e-9)
        for multiples, width in zip(self._multiples.T, half.T, strict=True):
            slope = np.where(near, turned * multiples, 0.0) @ self._coefficients
            radius = radius + np.abs(slope) * width[:, None]
        return middles - radius, middles + radius


class SchurProblem:
    """One controller on one arm at one ε₀, ready to be enclosed over boxes (count, 2, sides).

    Args:
        loop: what is to be proved; its ``start`` says which side is which.
    """

    def __init__(self, loop: ClosedLoop) -> None:
        self.loop, self.first = loop, len(loop.angles)
        member, joints = loop.member, range(loop.n)
        entries = {(i, j): loop.mass[i][j] for i in joints for j in range(i + 1)} | loop.symbols
        self.parts = [(place, powers, x) for place, entry in entries.items() for powers, x in entry.items()]
        self.reach = Reach([x for _, _, x in self.parts], loop.n)
        self.of_error = of_sides(lambda side: (member.h(ball(side)), member.dh(ball(side))))

    def proved(self, boxes: Array) -> NDArray[np.bool_]:
        """Where P ≻ 0 on the whole box, up to rounding, or all of it lies beyond the radius of the tail."""
        with np.errstate(all="ignore"):
            at = _Boxes(self, boxes)
            inside, beyond = positive_definite(at.P()), norm(at.e).lo >= self.loop.radius * BEYOND
        return np.asarray(np.all(boxes[:, 0] <= boxes[:, 1], axis=1) & (inside | beyond))

    def sides(self, boxes: Array) -> NDArray[np.intp]:
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


class _Boxes:
    """P over some boxes."""

    def __init__(self, problem: SchurProblem, boxes: Array) -> None:
        self.problem, self.loop = problem, problem.loop
        columns = [Interval(boxes[:, 0, k], boxes[:, 1, k]) for k in range(boxes.shape[2])]
        first, last = problem.first, problem.first + problem.loop.n
        self.angles, self.e, self.uncertain = columns[:first], columns[first:last], columns[last:]

    def P(self) -> list[list[Interval]]:
        """The entries on and below the diagonal."""
        sides, ranges = iter(self.uncertain), (*self.loop.parameters, *self.loop.friction)
        uncertain = [next(sides) if low < high else float(low) for low, high in ranges]
        ranging = len(self.loop.parameters)
        loop, r = self.loop, norm(self.e)
        scaled = zip(map(self.problem.of_error, self.e), map(float, loop.Lambda), strict=True)
        h, dh = zip(*([x * scale for x in own] for own, scale in scaled), strict=True)
        shrink = (r + 1.0).reciprocal()
        eps = shrink * float(loop.eps0)
        weight = [eps * float(1 / (4 * k)) for k in loop.stiffness]
        unit = [x * shrink for x in unit_vector(self.e)]
        errors = Errors(None, eps, weight, list(h), list(dh), unit)
        return form(*self._arm(uncertain[:ranging]), errors, uncertain[ranging:], RING)

    def _arm(
        self, parameters: Sequence[Interval | float]
    ) -> tuple[list[list[Value]], dict[tuple[int, int, int], Value]]:
        """M and the Christoffel symbols."""
        count = len(self.e[0].lo)
        middle, half = np.zeros((2, count, self.loop.n))
        for joint, x in zip(self.loop.angles, self.angles, strict=True):
            middle[:, joint], half[:, joint] = x.middle, x.radius
        low, high = self.problem.reach.on(middle, half)
        values: dict[tuple[int, ...], Value] = {}
        for k, (place, powers, _) in enumerate(self.problem.parts):
            part = Interval(low[:, k], high[:, k])
            for parameter, power in zip(parameters, powers, strict=True):
                for _ in range(power):
                    part = part * parameter
            values[place] = values[place] + part if place in values else part
        joints = range(self.loop.n)
        M = [[values.get((max(i, j), min(i, j)), 0.0) for j in joints] for i in joints]
        return M, {place: values[place] for place in self.loop.symbols}
