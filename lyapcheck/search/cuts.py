"""The cuts of boxes into halves: as a tree, and which side of a box is cut."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from lyapcheck._types import Array
from lyapcheck.check.numbers.harmonics import Uncertain, derivative, largest
from lyapcheck.intervals.arm import dh_range, h_range
from lyapcheck.search.schur import SchurProblem

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
