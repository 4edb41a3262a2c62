"""Covering a box with smaller boxes on each of which something is proved."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]
Boxes = Array
"""(count, 2, dimensions): lower and upper ends."""

Progress = Callable[[float, str], None]
Prover = Callable[[Boxes], NDArray[np.bool_]]
Halver = Callable[[Boxes], Boxes]

CHUNK = 8192
PROBES = 64
SMALLEST = 1e-5
"""Half width below which a box that is not proved ends the search."""

RESISTS = "a state resisted"
EXHAUSTED = "the budget of boxes is spent"


@dataclass(frozen=True, eq=False)
class Outcome:
    """How a search over boxes ended.

    Args:
        proved: every point of the start lies in a proved box.
        boxes: how many boxes were looked at.
        reason: why not, when not proved.
        point: the point that resisted, if one did.
    """

    proved: bool
    boxes: int
    reason: str = ""
    point: Array | None = None


def cover(
    start: Boxes, prove: Prover, halves: Halver, max_boxes: int, on_progress: Progress | None = None
) -> Outcome:
    """Prove a property of every point of some boxes, halving those where it is not proved as a whole.

    Depth first in chunks, so that memory stays bounded. It ends early at a point, or a very small box, on
    which the property is not proved: halving would not help there.

    Args:
        start: boxes that together hold every point meant.
        prove: for each box whether the property holds on all of it, proved.
        halves: both halves of each box.
        max_boxes: how many boxes may be looked at.
        on_progress: told the share of the volume decided.

    Soundness: halves cover their box; ``prove`` is taken at its word.
    """
    stack, seen, done = [start], 0, 0.0
    volume = float(np.sum(_volumes(start)))
    while stack:
        boxes = stack.pop()
        if len(boxes) > CHUNK:
            stack.append(boxes[CHUNK:])
            boxes = boxes[:CHUNK]
        seen += len(boxes)
        if seen > max_boxes:
            return Outcome(False, seen, EXHAUSTED)
        proved = prove(boxes)
        done += float(np.sum(_volumes(boxes[proved])))
        if on_progress is not None:
            on_progress(min(done / volume, 1.0), f"{seen} boxes")
        rest = boxes[~proved]
        if len(rest):
            point = _resisting(rest, prove)
            if point is not None:
                return Outcome(False, seen, RESISTS, point)
            stack.append(halves(rest))
    return Outcome(True, seen)


def _volumes(boxes: Boxes) -> Array:
    return np.asarray(np.prod(boxes[:, 1] - boxes[:, 0], axis=1))


def _resisting(boxes: Boxes, prove: Prover) -> Array | None:
    """The middle of a box where the property is not even proved for that point, or of one too small to halve."""
    probes = boxes[:: max(1, len(boxes) // PROBES)]
    middles = probes.mean(axis=1)
    failed = ~prove(np.stack([middles, middles], axis=1))
    if failed.any():
        return np.asarray(middles[failed][0])
    small = np.max(boxes[:, 1] - boxes[:, 0], axis=1) < 2 * SMALLEST
    return np.asarray(boxes[small][0].mean(axis=0)) if small.any() else None


def halve(boxes: Boxes, side: NDArray[np.intp]) -> Boxes:
    """Both halves of every box, cut in the middle of the side chosen for it."""
    rows = np.arange(len(boxes))
    middle = 0.5 * (boxes[rows, 0, side] + boxes[rows, 1, side])
    left, right = boxes.copy(), boxes.copy()
    left[rows, 1, side] = middle
    right[rows, 0, side] = middle
    return np.concatenate([left, right])
