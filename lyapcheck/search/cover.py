"""How smaller boxes cover a box: it is cut into halves, level after level, until a property is proved."""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from lyapcheck._types import Array, Progress
from lyapcheck.computing import computing_time

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
