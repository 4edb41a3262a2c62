"""Covering a box with smaller boxes on each of which something is proved.

Boxes are looked at level by level. Whether one is proved, where it is cut and whether its middle is probed
depends on nothing but the box once levels are large, so that others may look at what lies below some boxes of
a level: the tree, the count of boxes and the end are those of one process, whoever looked at what.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass, field
from typing import Protocol

import numpy as np
from numpy.typing import NDArray

from lyapcheck._types import Array, Progress
from lyapcheck.computing import computing_time
from lyapcheck.search.cuts import Boxes, Branches, Indices, Nodes, halve

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
    """

    proved: bool
    boxes: int
    reason: str = ""
    point: Array | None = None
    tree: str = ""


class SharedSearch(Protocol):
    """Has others look below the boxes of a level."""

    @property
    def hands(self) -> int:
        """How many they are dealt out to."""

    def below(self, hands: Sequence[Boxes], most: int, seconds: float) -> Iterator[Branches]:
        """What is below each hand, as far as that many boxes and seconds of computing time for all lead."""


@dataclass
class Hand:
    """Boxes of a level that others look below, and what they have found.

    Args:
        boxes: that still wait; none at the end.
        names: theirs.
        levels: how many boxes were looked at, level by level.
        point: of the last of these levels, if one resisted.
    """

    boxes: Boxes
    names: Indices
    levels: list[int] = field(default_factory=list)
    point: Array | None = None

    @property
    def open(self) -> bool:
        """Whether boxes wait."""
        return len(self.boxes) > 0

    def count(self, depth: int) -> int:
        """The boxes of a level; of one that waits as well."""
        return [*self.levels, len(self.boxes)][depth] if depth <= len(self.levels) else 0

    def take(self, part: Branches, nodes: Nodes) -> None:
        """Take over what was found below the boxes that waited."""
        names = nodes.graft(self.names, part)
        boxes, numbers = part.waiting or (self.boxes[:0], self.names[:0])
        self.boxes, self.names, self.point = boxes, names[numbers], part.point
        self.levels += part.levels


def cover(
    start: Boxes,
    prove: Prover,
    choose: Chooser,
    max_boxes: int,
    on_progress: Progress | None = None,
    deadline: float = math.inf,
    share: SharedSearch | None = None,
    worth: float = math.inf,
) -> CoverOutcome:
    """Prove a property of every point of a box, halving it where it is not proved as a whole.

    It ends early at a point, or a very small box, on which the property is not proved: halving would not help
    there.

    Args:
        prove: for each box whether the property holds on all of it, proved.
        choose: the side of each box that should be halved.
        deadline: by the computing time of `lyapcheck.computing`, s; the search gives up after it.
        share: has others look at what lies below the boxes of a level.
        worth: how many boxes of a level are left to them, more than ``FEW``.

    Soundness: halves cover their box; ``prove`` is taken at its word.
    """
    nodes = Nodes()
    names = nodes.add(len(start))
    until = math.inf if share is None else worth
    top = explored(start, prove, choose, max_boxes, deadline, on_progress, worth=until)
    seen = sum(top.levels)
    hand = Hand(start, names)
    hand.take(top, nodes)
    if top.late or top.point is not None:
        return CoverOutcome(False, seen, LATE if top.late else RESISTS, top.point)
    if seen + len(hand.boxes) > max_boxes:
        return CoverOutcome(False, seen + len(hand.boxes), EXHAUSTED)
    if hand.open and share is not None:
        return _shared(hand, nodes, share, seen, max_boxes, deadline, on_progress)
    return CoverOutcome(True, seen, tree=nodes.preorder()[0])


def _shared(
    top: Hand,
    nodes: Nodes,
    share: SharedSearch,
    seen: int,
    max_boxes: int,
    deadline: float,
    on_progress: Progress | None,
) -> CoverOutcome:
    """How the search goes on where others look below boxes: it ends at the level where one process ends.

    No hand runs far ahead: each first has its share of the budget, and a quarter of that.
    """
    hands = [Hand(top.boxes[k :: share.hands], top.names[k :: share.hands]) for k in range(share.hands)]
    most = 5 * (max_boxes - seen) // (4 * share.hands)
    while True:
        asked = [hand for hand in hands if hand.open]
        parts = share.below([hand.boxes for hand in asked], most, deadline - computing_time())
        for hand, part in zip(asked, parts, strict=True):
            hand.take(part, nodes)
            total = seen + sum(sum(one.levels) for one in hands)
            if part.late:
                return CoverOutcome(False, total, LATE)
            if on_progress is not None:
                done = 1 - sum(one.open for one in hands) / len(hands)
                on_progress(done, f"{total} boxes below {len(top.boxes)}")
        total = seen
        for depth in range(max(len(hand.levels) for hand in hands) + 1):
            total += sum(hand.count(depth) for hand in hands)
            if total > max_boxes:
                return CoverOutcome(False, total, EXHAUSTED)
            if any(hand.open and len(hand.levels) == depth for hand in hands):
                break  # what they find at this level is not known
            points = [h.point for h in hands if h.point is not None and len(h.levels) == depth + 1]
            if points:
                return CoverOutcome(False, total, RESISTS, first_of(np.array(points)))
        else:
            return CoverOutcome(True, total, tree=nodes.preorder()[0])
        most = max_boxes - seen


def explored(
    boxes: Boxes,
    prove: Prover,
    choose: Chooser,
    most: int,
    deadline: float = math.inf,
    on_progress: Progress | None = None,
    *,
    few: bool = True,
    worth: float = math.inf,
) -> Branches:
    """Look at some boxes of a level and all that they are cut into.

    Args:
        boxes: of one level.
        prove: see ``cover``, as for the rest.
        most: a level that would make them more boxes than that is left waiting.
        deadline: by the computing time of `lyapcheck.computing`, s.
        few: whether no level so far had more than ``FEW`` boxes.
        worth: a level of so many boxes is left waiting as well.
    """
    levels: list[int] = []
    nodes, volume, done = Nodes(), float(np.sum(_volumes(boxes))), 0.0
    names = nodes.add(len(boxes))
    while len(boxes):
        if len(boxes) >= worth or sum(levels) + len(boxes) > most:
            return Branches(levels, nodes.parts, waiting=(boxes, names))
        if computing_time() > deadline:
            return Branches(levels, nodes.parts, late=True)
        levels.append(len(boxes))
        few = few and len(boxes) <= FEW
        proved, point = _judged(boxes, prove, few)
        if point is not None:
            return Branches(levels, nodes.parts, point=point)
        done += float(np.sum(_volumes(boxes[proved])))
        boxes, names = boxes[~proved], names[~proved]
        if on_progress is not None:
            note = f"{sum(levels)} boxes, {2 * len(boxes)} open"
            on_progress(min(done / volume, 1.0) if volume else 0.0, note)
        if len(boxes):
            sides = choose(boxes)
            boxes, names = halve(boxes, sides), nodes.cut(names, sides)
    return Branches(levels, nodes.parts)


def first_of(points: Array) -> Array:
    """The first of some points, by their coordinates: whoever found which, it is the same."""
    return np.asarray(points[np.lexsort(points.T[::-1])[0]])


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
        proved = np.concatenate([prove(chunk) for chunk in _chunks(boxes)])
        rest = boxes[~proved]
        middles = rest[_probed(rest)].mean(axis=1)
        central = prove(np.stack([middles, middles], axis=1)) if len(middles) else np.ones(0, dtype=bool)
    small = rest[np.max(rest[:, 1] - rest[:, 0], axis=1) < 2 * SMALLEST]
    points = np.concatenate([middles[~central], small.mean(axis=1)])
    return proved, first_of(points) if len(points) else None


def _chunks(boxes: Boxes) -> Iterator[Boxes]:
    return (boxes[first : first + CHUNK] for first in range(0, len(boxes), CHUNK))


def _probed(boxes: Boxes) -> NDArray[np.bool_]:
    """About one box in 2⁵, by nothing but its ends."""
    ends = np.ascontiguousarray(boxes).reshape(len(boxes), 2 * boxes.shape[2]).view(np.uint64)
    mixed: NDArray[np.uint64] = np.sum(ends * MIXING[: ends.shape[1]], axis=1, dtype=np.uint64)
    return np.asarray(mixed >> np.uint64(64 - PROBE_BITS) == 0)
