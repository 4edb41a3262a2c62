"""Boxes of doubles: intervals over many of them at once, and how smaller boxes cover a box.

All are proposals, which the checker judges again in balls. Nothing is rounded outward: `positive_definite`
leaves more room than rounding takes. A comparison with an undefined end is false, and proves nothing.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from functools import lru_cache
from typing import Any

import numpy as np
from flint import arb
from numpy.typing import NDArray

from lyapcheck._types import Array, Progress
from lyapcheck.check.loop.field import Side
from lyapcheck.computing import computing_time

SURELY = 1e-9
"""What a pivot has to exceed, as a share of its entry of the diagonal."""
_KEPT = 1 << 17


@dataclass(frozen=True, eq=False)
class Interval:
    """All reals between ``lo`` and ``hi``, elementwise; numbers and arrays in an operation are exact."""

    lo: Array
    hi: Array

    # NumPy must leave ``array * interval`` to this class instead of looping over the array.
    __array_ufunc__ = None

    def __add__(self, other: Interval | Array | float) -> Interval:
        low, high = _ends(other)
        return Interval(self.lo + low, self.hi + high)

    __radd__ = __add__

    def __sub__(self, other: Interval | Array | float) -> Interval:
        low, high = _ends(other)
        return Interval(self.lo - high, self.hi - low)

    def __rsub__(self, other: Array | float) -> Interval:
        return Interval(other - self.hi, other - self.lo)

    def __mul__(self, other: Interval | Array | float) -> Interval:
        low, high = _ends(other)
        a, b = self.lo * low, self.hi * low
        least, most = np.minimum(a, b), np.maximum(a, b)
        if low is not high:
            c, d = self.lo * high, self.hi * high
            least, most = np.minimum(least, np.minimum(c, d)), np.maximum(most, np.maximum(c, d))
        return Interval(least, most)

    __rmul__ = __mul__

    def square(self) -> Interval:
        """x², which is never negative."""
        least = np.maximum(np.maximum(self.lo, -self.hi), 0.0)
        return Interval(least * least, self.size**2)

    def reciprocal(self) -> Interval:
        """1/x where x is positive throughout; everything elsewhere."""
        usable = self.lo > 0
        return Interval(np.where(usable, 1 / self.hi, -np.inf), np.where(usable, 1 / self.lo, np.inf))

    @property
    def middle(self) -> Array:
        """The mean of both ends."""
        return np.asarray(0.5 * (self.lo + self.hi))

    @property
    def radius(self) -> Array:
        """Half the width."""
        return np.asarray(0.5 * (self.hi - self.lo))

    @property
    def size(self) -> Array:
        """The largest absolute value."""
        return np.maximum(-self.lo, self.hi)


def _ends(value: Any) -> tuple[Any, Any]:
    return (value.lo, value.hi) if isinstance(value, Interval) else (value, value)


def norm(e: Sequence[Interval]) -> Interval:
    """‖e‖."""
    squares = [x.square() for x in e]
    return Interval(np.sqrt(sum(x.lo for x in squares)), np.sqrt(sum(x.hi for x in squares)))


def unit_vector(e: Sequence[Interval]) -> list[Interval]:
    """e/‖e‖, and everything in [−1, 1] where the box touches the origin.

    e_i/√(e_i² + rest) grows with e_i; for e_i > 0 it falls with the rest, for e_i < 0 it grows with it.
    """
    result = []
    for i, x in enumerate(e):
        rest = norm([Interval(np.zeros(()), np.zeros(())), *e[:i], *e[i + 1 :]])
        result.append(Interval(-_largest_share(-x.lo, rest), _largest_share(x.hi, rest)))
    return result


def _largest_share(x: Array, rest: Interval) -> Array:
    """The largest x/√(x² + rest²); 0 where x is 0."""
    length = np.hypot(x, np.where(x >= 0, rest.lo, rest.hi))
    return np.where(x == 0, 0.0, x / np.where(length > 0, length, 1.0))


def of_sides(functions: Callable[[Side], Sequence[arb]]) -> Callable[[Interval], list[Interval]]:
    """Functions of one side in balls, over arrays of sides: each is asked once, as boxes share most."""

    @lru_cache(maxsize=_KEPT)
    def ends(side: complex) -> list[tuple[float, float]]:
        return [(float(y.lower()), float(y.upper())) for y in functions((side.real, side.imag))]

    def over(x: Interval) -> list[Interval]:
        sides, index = np.unique(np.ravel(x.lo) + 1j * np.ravel(x.hi), return_inverse=True)
        known = np.array([ends(side) for side in sides.tolist()])[index.ravel()]
        low, high = np.moveaxis(known.reshape(*np.shape(x.lo), -1, 2), (-2, -1), (1, 0))
        return [Interval(*pair) for pair in zip(low, high, strict=True)]

    return over


def positive_definite(matrix: Sequence[Sequence[Interval]]) -> NDArray[np.bool_]:
    """Where every symmetric matrix within the intervals is positive definite; False means not shown.

    Elimination without pivoting: a symmetric matrix is positive definite exactly when all its pivots are
    positive, and the pivots of every member lie in the interval pivots.

    Args:
        matrix: n × n intervals; only the entries on and below the diagonal are read.
    """
    rows = [list(row) for row in matrix]
    proved = np.ones(np.shape(rows[0][0].lo), dtype=np.bool_)
    with np.errstate(all="ignore"):
        for k, row in enumerate(rows):
            proved = proved & (row[k].lo > SURELY * matrix[k][k].hi)
            inverse = row[k].reciprocal()
            for i in range(k + 1, len(rows)):
                factor = rows[i][k] * inverse
                for j in range(k + 1, i):
                    rows[i][j] = rows[i][j] - factor * rows[j][k]
                rows[i][i] = rows[i][i] - rows[i][k].square() * inverse
    return proved


# --- Cuts of boxes into halves, level after level, until a property is proved.


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
PROBED = 32
"""Of the boxes of larger levels every so many."""
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
        middles = rest[::PROBED].mean(axis=1)
        central = prove(np.stack([middles, middles], axis=1)) if len(middles) else np.ones(0, dtype=bool)
    small = rest[np.max(rest[:, 1] - rest[:, 0], axis=1) < 2 * SMALLEST]
    points = np.concatenate([middles[~central], small.mean(axis=1)])
    return proved, points[np.lexsort(points.T[::-1])[0]] if len(points) else None
