"""Branch and bound: dV/dt < 0 proved for every state of an arm, origin and infinity included.

P(q, e) of ``lyapcheck.search.schur`` must be positive definite for all q on the torus and all e. Boxes of
(q, e) are enclosed in outward-rounded intervals, kept if P ≻ 0 is proved, else halved.

- **Infinity.** For ‖e‖ ≥ R the scalar form, positive definite at ε₀/(1+R), proves dV/dt < 0; boxes outside
  that ball are not looked at.
- **Origin.** ê = e/‖e‖ has no value at e = 0; its enclosure [−1, 1]ⁿ covers every direction, so boxes that
  touch e = 0 are proved for all of them, e = 0 (where ê counts as 0) included.
- **Symmetry.** See ``lyapcheck.search.symmetry``; angles that M does not depend on are held at 0.
"""

from __future__ import annotations

import math
from dataclasses import dataclass, field
from fractions import Fraction

import numpy as np
from numpy.typing import NDArray

from lyapcheck.check.scalar import ScalarForm, certifies
from lyapcheck.family import Family
from lyapcheck.intervals import Interval, norm
from lyapcheck.intervals.arm import magnitude
from lyapcheck.intervals.definite import positive_definite
from lyapcheck.intervals.family import dh_range, h_range
from lyapcheck.robots import RobotModel
from lyapcheck.robots.harmonics import derivative
from lyapcheck.search.cover import Outcome, Progress, cover, halve
from lyapcheck.search.schur import Problem
from lyapcheck.search.symmetry import one_sided, sign_symmetries

Array = NDArray[np.float64]
PI_ABOVE = 3.1415926535897936
"""A double above π."""


@dataclass(frozen=True, eq=False)
class Domain:
    """The box of (q, e) that must be covered, and how to split it.

    Args:
        angles: the joints whose angle varies.
        low: lower ends, one for each of those angles and each error.
        high: upper ends.
        radius: R; nothing with ‖e‖ ≥ R need be covered.
    """

    angles: tuple[int, ...]
    n: int
    low: Array
    high: Array
    radius: float

    def split(self, boxes: Array) -> tuple[list[Interval], list[Interval]]:
        """q and e as n intervals each, from boxes (count, 2, dimensions)."""
        zero = Interval.exact(0.0)
        q = [zero] * self.n
        for column, joint in enumerate(self.angles):
            q[joint] = Interval(boxes[:, 0, column], boxes[:, 1, column])
        first = len(self.angles)
        e = [Interval(boxes[:, 0, first + i], boxes[:, 1, first + i]) for i in range(self.n)]
        return q, e


def domain(model: RobotModel, problem: Problem, form: ScalarForm, eps0: Fraction) -> Domain:
    """What must be covered: all angles that matter, and the errors inside the radius that the tail leaves."""
    angles = problem.arm.angles
    radius = tail_radius(form, eps0)
    sided = one_sided(sign_symmetries(model))
    low = [-PI_ABOVE] * len(angles) + [0.0 if i in sided else -radius for i in range(model.n)]
    high = [PI_ABOVE] * len(angles) + [radius] * model.n
    return Domain(angles, model.n, np.array(low), np.array(high), radius)


def tail_radius(form: ScalarForm, eps0: Fraction) -> float:
    """A double R ≥ 0 such that the scalar form proves dV/dt < 0 wherever ‖e‖ ≥ R: Θ'(ε) ≻ 0 for ε ≤ ε₀/(1+R)."""
    radius = Fraction(1, 64)
    while not certifies(form, eps0 / (1 + radius)):
        radius = radius * 5 / 4
    return math.nextafter(float(radius), math.inf)


def certify(
    model: RobotModel,
    problem: Problem,
    form: ScalarForm,
    max_boxes: int,
    on_progress: Progress | None = None,
) -> Outcome:
    """Prove dV/dt < 0 everywhere for one ε₀, or say why it was not proved.

    Args:
        model: the arm without parameters.
        problem: what must be positive definite.
        form: the scalar form of the same arm and gains, for the tail.
        max_boxes: how many boxes may be looked at.
        on_progress: told the share of the volume decided.

    Soundness: every point of the domain lies in a proved box, outside the tail radius, or is the image of
        such a point under a symmetry; arithmetic is outward rounded.
    """
    if certifies(form, problem.eps0):
        return Outcome(True, 0)
    space = domain(model, problem, form, problem.eps0)
    splitter = Splitter.of(problem, space)
    start = np.stack([space.low, space.high])[None]
    return cover(start, lambda boxes: _proved(problem, space, boxes), splitter.halves, max_boxes, on_progress)


def _proved(problem: Problem, space: Domain, boxes: Array) -> NDArray[np.bool_]:
    q, e = space.split(boxes)
    inside: NDArray[np.bool_] = positive_definite(problem.schur(q, e))
    return inside | (norm(e).lo >= space.radius)


@dataclass(frozen=True, eq=False)
class Splitter:
    """Chooses for each box the side to halve: the one whose length moves P most, by rough estimates."""

    problem: Problem
    space: Domain
    angle_slopes: Array
    inertia: Array
    whirl: float = field(default=1.0)

    @classmethod
    def of(cls, problem: Problem, space: Domain) -> Splitter:
        """Estimates from the sizes of the polynomials, relative to the friction of each joint."""
        root = np.sqrt(np.array([float(b) for b in problem.viscous]))
        sizes = np.zeros((space.n, space.n))
        slopes = np.zeros(len(space.angles))
        for (i, j), terms in problem.arm.mass.items():
            sizes[i, j] = sizes[j, i] = magnitude(terms) / (root[i] * root[j])
            for column, joint in enumerate(space.angles):
                moved = magnitude(derivative(terms, joint)) / (root[i] * root[j])
                slopes[column] = max(slopes[column], moved)
        whirl = max((magnitude(t) for t in problem.arm.christoffel.values()), default=0.0) / float(
            root.min() ** 2
        )
        return cls(problem, space, slopes, sizes.sum(axis=0), whirl)

    def halves(self, boxes: Array) -> Array:
        """Both halves of every box."""
        return halve(boxes, np.argmax(self._weights(boxes), axis=1))

    def _weights(self, boxes: Array) -> Array:
        first = len(self.space.angles)
        half = 0.5 * (boxes[:, 1] - boxes[:, 0])
        weights = np.empty_like(half)
        _, e = self.space.split(boxes)
        steep = max(float(self.problem.family.constants().rho.upper), 1.0)
        weights[:, :first] = half[:, :first] * self.angle_slopes * steep
        for i, x in enumerate(e):
            bend, move = dh_range(self.problem.family, x).radius, h_range(self.problem.family, x).radius
            weights[:, first + i] = self.inertia[i] * (bend + half[:, first + i] * 0.5) + self.whirl * move
        return weights
