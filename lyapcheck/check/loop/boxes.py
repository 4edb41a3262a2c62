"""Trees of boxes: a box is cut in the middle of one side, and again, until each part can be judged.

A tree is written in preorder, a digit for the side that is cut and a dot for a leaf. Both halves of a side
share the double in the middle, so the leaves cover the start whatever the tree.
"""

from __future__ import annotations

from collections.abc import Iterator

Side = tuple[float, float]
Box = tuple[Side, ...]


class BrokenTree(ValueError):
    """The text is not the preorder of a tree of cuts of this box."""


def leaves(start: Box, tree: str) -> Iterator[Box]:
    """The boxes at the dots of a tree; raises ``BrokenTree`` as `nodes` does."""
    return (box for box, side in nodes(start, tree) if side is None)


def nodes(start: Box, tree: str) -> Iterator[tuple[Box, int | None]]:
    """Every box of a tree with the side that is cut, ``None`` at a dot; ``BrokenTree`` if it is none."""
    stack = [start]
    for mark in tree:
        if not stack:
            raise BrokenTree("the tree ends before its text does")
        box = stack.pop()
        side = None if mark == "." else _side(mark, len(box))
        yield box, side
        if side is not None:
            left, right = halves(box, side)
            stack += (right, left)
    if stack:
        raise BrokenTree("the text ends before its tree does")


def halves(box: Box, side: int) -> tuple[Box, Box]:
    """Both halves of a box, cut at one double."""
    low, high = box[side]
    middle = 0.5 * (low + high)
    before, after = box[:side], box[side + 1 :]
    return (*before, (low, middle), *after), (*before, (middle, high), *after)


def _side(mark: str, sides: int) -> int:
    side = ord(mark) - ord("0")
    if not 0 <= side < sides:
        raise BrokenTree(f"{mark!r} is not a side of the box")
    return side
