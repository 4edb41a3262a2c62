"""Walking a tree of boxes and showing P ≻ 0 on each leaf."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from contextvars import ContextVar
from dataclasses import replace

from lyapcheck.check.loop.arithmetic import BALLS, SPANS
from lyapcheck.check.loop.closed_loop import ClosedLoop, certifies
from lyapcheck.check.loop.field import Box, halves, leaves
from lyapcheck.check.loop.schur import CentredEvaluator, Evaluator
from lyapcheck.check.numbers.balls import precision

BITS = 64
BLOCK = 64
MORE_HALVINGS = 12
"""How much deeper than its tree a box may be cut: balls may be wider than the intervals of the search."""
MOST_CENTRED = 2
"""Joints up to which slopes cost less than the smaller boxes that go without."""
WORTH_SHARING = 20_000
"""Characters of a tree from which a second process pays for its start."""
SHARE: ContextVar[Callable[..., bool]] = ContextVar(
    "share", default=lambda judge, *about: judge(*about, 0, 1)
)
"""Whether ``judge(*about, part, parts)`` holds for every part from 0 on; here there is one."""


def proves(loop: ClosedLoop, tree: str) -> bool:
    """Whether a tree of boxes proves dV/dt < 0 at every state but the origin.

    The tree is in preorder, a digit for the side of ``loop.start`` that is cut, a dot for a leaf; raises
    ``BrokenTree`` if it is none. ``False`` says nothing about the statement.

    Soundness: what lies outside the start is an image under a symmetry or has ‖e‖ ≥ R; the leaves cover it.
    """
    if len(tree) < WORTH_SHARING:
        return proves_part(loop, tree, 0, 1)
    return SHARE.get()(proves_part, replace(loop), tree)  # the copy leaves behind what the loop has computed


def proves_part(loop: ClosedLoop, tree: str, part: int, parts: int) -> bool:
    """The share of `proves` that falls to one of several processes: every leaf in turn, by its number.

    Soundness: the tree proves the statement if all its parts are ``True``.
    """
    if not loop.admissible:
        return False
    boxes = leaves(loop.start, tree)
    if certifies(loop.tail, loop.eps0):
        return all(True for _ in boxes)  # the tree is read to its end, though no box need be judged
    with precision(BITS):
        slopes = [CentredEvaluator(loop)] if loop.n <= MOST_CENTRED else []
        means = [Evaluator(loop, BALLS), *slopes, Evaluator(loop, SPANS)]
        # blocks, not single leaves: neighbours share the ranges that the evaluator keeps
        mine = (box for k, box in enumerate(boxes) if k // BLOCK % parts == part)
        return all(_shown(means, box) for box in mine)


def _shown(means: Sequence[Evaluator], box: Box) -> bool:
    """Whether P ≻ 0 is shown on a box, by one of the means, cut further where that is needed.

    The side that is cut is the widest beside what it was at the start. Spans, the last means, cost
    several times what the others do: halves are tried without them first.
    """
    start = means[0].loop.start
    stack = [(box, 0)]
    while stack:
        part, depth = stack.pop()
        if any(one.proves(part) for one in (means if depth else means[:-1])):
            continue
        if depth == MORE_HALVINGS:
            return False
        sides = range(len(part))
        side = max(sides, key=lambda i: (part[i][1] - part[i][0]) / (start[i][1] - start[i][0]))
        stack += [(half, depth + 1) for half in halves(part, side)]
    return True
