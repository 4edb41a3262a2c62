"""P of ``lyapcheck.check.loop`` over many boxes at once, as intervals, and how smaller boxes cover a box.

What is found positive definite here is only a proposal: the checker looks at every box again, in balls.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass, field

import numpy as np
from numpy.typing import NDArray

from lyapcheck._types import Array, Progress
from lyapcheck.check.loop.arithmetic import Ring
from lyapcheck.check.loop.closed_loop import ClosedLoop
from lyapcheck.check.loop.schur import Errors, form
from lyapcheck.check.numbers.harmonics import Uncertain, derivative, largest
from lyapcheck.computing import computing_time
from lyapcheck.family import Family, named
from lyapcheck.search.interval import Interval, inverse_one_plus, norm, positive_definite, unit_vector
from lyapcheck.search.interval_arm import ArmIntervals, dh_range, h_range

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


# --- The cuts of boxes into halves: as a tree, and which side of a box is cut.


Boxes = Array
"""(count, 2, dimensions): lower and upper ends."""
Indices = NDArray[np.intp]


class Nodes:
    """The tree of cuts, as arrays that grow: of each box that was cut, the side and both halves."""

    def __init__(self) -> None:
        self.count = 0
        self.parts: list[tuple[Indices, Indices, Indices]] = []

    def add(self, count: int) -> Indices:
        """Names for new boxes."""
        self.count += count
        return np.arange(self.count - count, self.count)

    def cut(self, names: Indices, sides: Indices) -> Indices:
        """Note that boxes were cut; the names of all left halves, then of all right ones."""
        halves = self.add(2 * len(names))
        self.parts.append((names, sides, halves))
        return halves

    def preorder(self) -> tuple[str, list[int]]:
        """The tree as text, and the names of its leaves in their order."""
        side = np.full(self.count, -1, dtype=np.intp)
        left, right = np.zeros((2, self.count), dtype=np.intp)
        for names, sides, halves in self.parts:
            side[names], left[names], right[names] = sides, halves[: len(names)], halves[len(names) :]
        sides_of, lefts, rights = side.tolist(), left.tolist(), right.tolist()
        text, leaves, stack = [], [], [0]
        while stack:
            node = stack.pop()
            if sides_of[node] < 0:
                text.append(".")
                leaves.append(node)
            else:
                text.append(chr(ord("0") + sides_of[node]))
                stack += (rights[node], lefts[node])
        return "".join(text), leaves


def halve(boxes: Boxes, side: Indices) -> Boxes:
    """Both halves of every box, cut in the middle of its chosen side: all left ones, then all right ones."""
    rows = np.arange(len(boxes))
    middle = 0.5 * (boxes[rows, 0, side] + boxes[rows, 1, side])
    left, right = boxes.copy(), boxes.copy()
    left[rows, 1, side] = middle
    right[rows, 0, side] = middle
    return np.concatenate([left, right])


# --- Which side of a box branch and bound halves.


ANGLES = 0.25
"""Share of the estimate of an angle that counts: the mean value form encloses M more tightly than its slopes.

Trees for 0.99 of the falsified ε₀ and beyond have a tenth to all of the boxes that they have with 1.
"""


@dataclass(frozen=True, eq=False)
class Splitter:
    """Chooses for each box the side to halve: the one whose length moves P most, by rough estimates."""

    problem: SchurProblem
    angle_slopes: Array
    inertia: Array
    coriolis: float

    @classmethod
    def of(cls, problem: SchurProblem) -> Splitter:
        """Estimates from the sizes of the polynomials, relative to the friction of each joint."""
        loop, arm = problem.loop, problem.arm
        root = np.sqrt([float(low) for low, _ in loop.friction])
        sizes = np.zeros((loop.n, loop.n))
        slopes = np.zeros(len(loop.angles))
        for (i, j), entry in arm.mass.items():
            sizes[i, j] = sizes[j, i] = _size(problem, entry) / (root[i] * root[j])
            for column, joint in enumerate(loop.angles):
                slope = {p: derivative(terms, joint) for p, terms in entry.items()}
                slopes[column] = max(slopes[column], _size(problem, slope) / (root[i] * root[j]))
        coriolis = max((_size(problem, t) for t in arm.christoffel.values()), default=0.0) / float(
            root.min() ** 2
        )
        return cls(problem, slopes, sizes.sum(axis=0), coriolis)

    def sides(self, boxes: Array) -> NDArray[np.intp]:
        """The side of every box that should be halved."""
        first, n = len(self.problem.loop.angles), self.problem.loop.n
        half = 0.5 * (boxes[:, 1] - boxes[:, 0])
        weights = np.empty_like(half)
        family, e = self.problem.family, self.problem.sides(boxes).e
        steep = max(float(family.constants().rho.upper), 1.0)
        weights[:, :first] = ANGLES * half[:, :first] * self.angle_slopes * steep
        for i, x in enumerate(e):
            bend, move = dh_range(family, x).radius, h_range(family, x).radius
            weights[:, first + i] = self.inertia[i] * (bend + half[:, first + i] * 0.5) + self.coriolis * move
        uncertain = boxes[:, :, first + n :]
        middle = np.maximum(np.abs(uncertain.mean(axis=1)), 1e-12)
        weights[:, first + n :] = half[:, first + n :] / middle * self.inertia.max(initial=1.0)
        return np.asarray(np.argmax(weights, axis=1))


def _size(problem: SchurProblem, entry: Uncertain) -> float:
    """A rough bound of the size of a polynomial at the upper ends of its parameters."""
    ends = [float(max(abs(low), abs(high))) for low, high in problem.loop.parameters]
    return float(
        sum(float(largest(terms)) * float(np.prod(np.power(ends, powers))) for powers, terms in entry.items())
    )


Prover = Callable[[Boxes], NDArray[np.bool_]]
Chooser = Callable[[Boxes], Indices]
CHUNK = 32768
"""Boxes that are judged at a time."""
FEW = 512
"""Boxes of a level up to which every middle is probed."""
PROBE_BITS = 5
"""Of the boxes of larger levels one in 2⁵ is probed."""
MIXING = np.multiply.accumulate(np.full(128, 0x9E3779B97F4A7C15, dtype=np.uint64))
SMALLEST = 1e-5
"""Half width below which a box that is not proved ends the search."""
RESISTS = "a state resisted"
EXHAUSTED = "the budget of boxes is spent"
LATE = "the time is up"


@dataclass(frozen=True, eq=False)
class CoverOutcome:
    """How a search over boxes ended.

    Args:
        proved: every point of the start lies in a proved box.
        boxes: how many boxes were looked at.
        reason: why not, when not proved.
        point: the point that resisted, if one did.
        tree: when proved, the cuts in preorder: a digit for a side, a dot for a box that was proved.
        scales: of these boxes, where they have some.
    """

    proved: bool
    boxes: int
    reason: str = ""
    point: Array | None = None
    tree: str = ""
    scales: str = ""


def cover(
    start: Boxes,
    prove: Prover,
    choose: Chooser,
    max_boxes: int,
    on_progress: Progress | None = None,
    deadline: float = math.inf,
) -> CoverOutcome:
    """Prove a property of every point of a box, halving it where it is not proved as a whole.

    It ends early at a point, or a very small box, on which the property is not proved: halving would not help
    there.

    Args:
        start: one box.
        prove: for each box whether the property holds on all of it, proved.
        choose: the side of each box that should be halved.
        max_boxes: a level that would make them more boxes than that is not looked at.
        on_progress: receives the share of the volume decided.
        deadline: by the computing time of `lyapcheck.computing`, s; the search gives up after it.

    Soundness: halves cover their box; ``prove`` is taken at its word.
    """
    nodes, boxes, seen, few = Nodes(), start, 0, True
    names, volume, done = nodes.add(len(boxes)), float(np.sum(_volumes(boxes))), 0.0
    while len(boxes):
        if seen + len(boxes) > max_boxes:
            return CoverOutcome(False, seen + len(boxes), EXHAUSTED)
        if computing_time() > deadline:
            return CoverOutcome(False, seen, LATE)
        seen += len(boxes)
        few = few and len(boxes) <= FEW
        proved, point = _judged(boxes, prove, few)
        if point is not None:
            return CoverOutcome(False, seen, RESISTS, point)
        done += float(np.sum(_volumes(boxes[proved])))
        boxes, names = boxes[~proved], names[~proved]
        if on_progress is not None:
            on_progress(min(done / volume, 1.0) if volume else 0.0, f"{seen} boxes, {2 * len(boxes)} open")
        if len(boxes):
            sides = choose(boxes)
            boxes, names = halve(boxes, sides), nodes.cut(names, sides)
    return CoverOutcome(True, seen, tree=nodes.preorder()[0])


def _volumes(boxes: Boxes) -> Array:
    return np.asarray(np.prod(boxes[:, 1] - boxes[:, 0], axis=1))


def _judged(boxes: Boxes, prove: Prover, few: bool) -> tuple[NDArray[np.bool_], Array | None]:
    """Which boxes are proved, and a point that resists: halving would not help there.

    It is the middle of a box where not even that point is proved, or of a box too small to halve.
    """
    if few:
        # one call for both: so few boxes cost less than the call
        middles = boxes.mean(axis=1)
        judged = prove(np.concatenate([boxes, np.stack([middles, middles], axis=1)]))
        proved, central = judged[: len(boxes)], judged[len(boxes) :]
        rest = boxes[~proved]
    else:
        proved = np.concatenate([prove(boxes[k : k + CHUNK]) for k in range(0, len(boxes), CHUNK)])
        rest = boxes[~proved]
        middles = rest[_probed(rest)].mean(axis=1)
        central = prove(np.stack([middles, middles], axis=1)) if len(middles) else np.ones(0, dtype=bool)
    small = rest[np.max(rest[:, 1] - rest[:, 0], axis=1) < 2 * SMALLEST]
    points = np.concatenate([middles[~central], small.mean(axis=1)])
    return proved, points[np.lexsort(points.T[::-1])[0]] if len(points) else None


def _probed(boxes: Boxes) -> NDArray[np.bool_]:
    """About one box in 2⁵, by nothing but its ends."""
    ends = np.ascontiguousarray(boxes).reshape(len(boxes), 2 * boxes.shape[2]).view(np.uint64)
    mixed: NDArray[np.uint64] = np.sum(ends * MIXING[: ends.shape[1]], axis=1, dtype=np.uint64)
    return np.asarray(mixed >> np.uint64(64 - PROBE_BITS) == 0)
