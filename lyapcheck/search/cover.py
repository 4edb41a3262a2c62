"""Covering a box with smaller boxes on each of which something is proved."""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass
from time import monotonic

import numpy as np
from numpy.typing import NDArray

from lyapcheck._types import Array, Progress

Boxes = Array
"""(count, 2, dimensions): lower and upper ends."""
Indices = NDArray[np.intp]

Prover = Callable[[Boxes], NDArray[np.bool_]]
Chooser = Callable[[Boxes], Indices]

CHUNK = 32768
PROBES = 64
FEW = 512
SMALLEST = 1e-5
"""Half width below which a box that is not proved ends the search."""

RESISTS = "a state resisted"
EXHAUSTED = "the budget of boxes is spent"
LATE = "the time is up"


@dataclass(frozen=True, eq=False)
class Outcome:
    """How a search over boxes ended.

    Args:
        proved: every point of the start lies in a proved box.
        boxes: how many boxes were looked at.
        reason: why not, when not proved.
        point: the point that resisted, if one did.
        tree: when proved, the cuts in preorder: a digit for a side, a dot for a box that was proved.
    """

    proved: bool
    boxes: int
    reason: str = ""
    point: Array | None = None
    tree: str = ""


def cover(
    start: Boxes,
    prove: Prover,
    choose: Chooser,
    max_boxes: int,
    on_progress: Progress | None = None,
    deadline: float = math.inf,
) -> Outcome:
    """Prove a property of every point of a box, halving it where it is not proved as a whole.

    Depth first in chunks, so that memory stays bounded. It ends early at a point, or a very small box, on
    which the property is not proved: halving would not help there.

    Args:
        start: one box.
        prove: for each box whether the property holds on all of it, proved.
        choose: the side of each box that should be halved.
        max_boxes: how many boxes may be looked at.
        on_progress: told the share of the volume decided.
        deadline: by the monotonic clock, s; the search gives up after it.

    Soundness: halves cover their box; ``prove`` is taken at its word.
    """
    nodes = Nodes()
    stack, seen, done = [(start, nodes.add(1))], 0, 0.0
    volume = float(np.sum(_volumes(start)))
    while stack:
        boxes, names = stack.pop()
        if len(boxes) > CHUNK:
            stack.append((boxes[CHUNK:], names[CHUNK:]))
            boxes, names = boxes[:CHUNK], names[:CHUNK]
        seen += len(boxes)
        if seen > max_boxes or monotonic() > deadline:
            return Outcome(False, seen, EXHAUSTED if seen > max_boxes else LATE)
        proved, point = _judged(boxes, prove)
        done += float(np.sum(_volumes(boxes[proved])))
        rest = boxes[~proved]
        if on_progress is not None:
            still_open = sum(len(waiting) for waiting, _ in stack) + 2 * len(rest)
            on_progress(min(done / volume, 1.0) if volume else 0.0, f"{seen} boxes, {still_open} open")
        if len(rest):
            if point is not None:
                return Outcome(False, seen, RESISTS, point)
            sides = choose(rest)
            stack.append((halve(rest, sides), nodes.cut(names[~proved], sides)))
    return Outcome(True, seen, tree=nodes.preorder()[0])


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


def _volumes(boxes: Boxes) -> Array:
    return np.asarray(np.prod(boxes[:, 1] - boxes[:, 0], axis=1))


def _judged(boxes: Boxes, prove: Prover) -> tuple[NDArray[np.bool_], Array | None]:
    """Which boxes are proved, and a point that resists: halving would not help there.

    It is the middle of a box where not even that point is proved, or of a box too small to halve.
    """
    if len(boxes) <= FEW:
        # one call for both: so few boxes cost less than the call
        middles = boxes.mean(axis=1)
        judged = prove(np.concatenate([boxes, np.stack([middles, middles], axis=1)]))
        proved, central = judged[: len(boxes)], judged[len(boxes) :]
        rest = boxes[~proved]
    else:
        proved = prove(boxes)
        rest = boxes[~proved]
        middles = rest[:: max(1, len(rest) // PROBES)].mean(axis=1)
        central = prove(np.stack([middles, middles], axis=1))
    if not central.all():
        return proved, np.asarray(middles[~central][0])
    small = np.max(rest[:, 1] - rest[:, 0], axis=1) < 2 * SMALLEST
    return proved, np.asarray(rest[small][0].mean(axis=0)) if small.any() else None


def halve(boxes: Boxes, side: Indices) -> Boxes:
    """Both halves of every box, cut in the middle of its chosen side: all left ones, then all right ones."""
    rows = np.arange(len(boxes))
    middle = 0.5 * (boxes[rows, 0, side] + boxes[rows, 1, side])
    left, right = boxes.copy(), boxes.copy()
    left[rows, 1, side] = middle
    right[rows, 0, side] = middle
    return np.concatenate([left, right])
