"""P of ``lyapcheck.check.loop`` over many boxes at once, as intervals.

What is found positive definite here is only a proposal: the checker looks at every box again, in balls.
"""

from __future__ import annotations

from dataclasses import dataclass, field

import numpy as np
from numpy.typing import NDArray

from lyapcheck._types import Array
from lyapcheck.check.loop.arithmetic import Ring
from lyapcheck.check.loop.closed_loop import ClosedLoop
from lyapcheck.check.loop.schur import Errors, form
from lyapcheck.family import Family, named
from lyapcheck.intervals import Interval, inverse_one_plus, norm, unit_vector
from lyapcheck.intervals.arm import ArmIntervals, dh_range, h_range
from lyapcheck.intervals.interval import positive_definite

RING = Ring(float, Interval.square)
"""Intervals beside exact numbers."""


@dataclass(frozen=True)
class BoxSides:
    """The columns of boxes (count, 2, sides) as intervals: q of every joint, e, parameters, and B."""

    q: list[Interval]
    e: list[Interval]
    parameters: list[Interval]
    viscous: list[Interval]


@dataclass(frozen=True, eq=False)
class SchurProblem:
    """One controller on one arm at one ε₀, ready to be enclosed over boxes.

    Args:
        loop: what is to be proved; its ``start`` says which side is which.
    """

    loop: ClosedLoop
    arm: ArmIntervals = field(init=False)
    family: Family = field(init=False)

    def __post_init__(self) -> None:
        object.__setattr__(self, "arm", ArmIntervals(self.loop.mass))
        object.__setattr__(self, "family", named(self.loop.family, self.loop.m))

    def proved(self, boxes: Array) -> NDArray[np.bool_]:
        """Where P ≻ 0 on the whole box, or all of the box lies beyond the radius of the tail.

        A box with an undefined end, or with its ends the wrong way round, is not proved.
        """
        sides = self.sides(boxes)
        inside: NDArray[np.bool_] = positive_definite(self.schur(sides))
        ordered: NDArray[np.bool_] = np.all(boxes[:, 0] <= boxes[:, 1], axis=1)
        beyond = norm(sides.e).lo >= self.loop.radius
        return np.asarray(ordered & (inside | beyond))

    def sides(self, boxes: Array) -> BoxSides:
        """Boxes taken apart."""
        columns = [Interval(boxes[:, 0, k], boxes[:, 1, k]) for k in range(boxes.shape[2])]
        first, last = len(self.loop.angles), len(self.loop.angles) + self.loop.n
        q = [Interval.exact(0.0)] * self.loop.n
        for joint, column in zip(self.loop.angles, columns[:first], strict=True):
            q[joint] = column
        free = iter(columns[last:])
        ranges = (*self.loop.parameters, *self.loop.friction)
        filled = [next(free) if low < high else Interval.of(low) for low, high in ranges]
        count = len(self.loop.parameters)
        return BoxSides(q, columns[first:last], filled[:count], filled[count:])

    def schur(self, sides: BoxSides) -> list[list[Interval]]:
        """P: the entries on and below the diagonal."""
        box, shrink = self.arm.at(sides.q, sides.parameters), inverse_one_plus(norm(sides.e))
        eps = shrink * Interval.of(self.loop.eps0)
        quarter = eps * 0.25
        weights = [Interval.of(scale) for scale in self.loop.Lambda]
        h, dh = (
            [f(self.family, x) * scale for x, scale in zip(sides.e, weights, strict=True)]
            for f in (h_range, dh_range)
        )
        errors = Errors(
            None,
            eps,
            [quarter * Interval.of(k).reciprocal() for k in self.loop.stiffness],
            h,
            dh,
            [unit * shrink for unit in unit_vector(sides.e)],
        )
        return form(box.mass(), box.symbols(), errors, sides.viscous, RING)
