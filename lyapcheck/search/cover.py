"""Covering a box with smaller boxes on each of which something is proved, level by level."""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from lyapcheck._types import Array, Progress
from lyapcheck.computing import computing_time
from lyapcheck.search.cuts import Boxes, Indices, Nodes, halve

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
