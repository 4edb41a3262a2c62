"""Walking a tree of boxes and showing P ≻ 0 on each leaf."""

from __future__ import annotations

import sys
from collections.abc import Iterator
from contextlib import contextmanager
from contextvars import ContextVar
from dataclasses import dataclass, replace

from lyapcheck.check.loop.arithmetic import BALLS, SPANS
from lyapcheck.check.loop.boxes import Box, halves, leaves
from lyapcheck.check.loop.centred import CentredEvaluator
from lyapcheck.check.loop.closed_loop import ClosedLoop
from lyapcheck.check.loop.scalar import certifies
from lyapcheck.check.loop.schur import Evaluator
from lyapcheck.check.numbers.balls import precision

BITS = 64
BLOCK = 64
WORTH_SHARING = 20_000
"""Characters of a tree from which a second process pays for its start."""
MORE_HALVINGS = 12
"""How much deeper than its tree a box may be cut: balls may be wider than the intervals of the search."""
TRIES = 64
SELDOM = 8
"""After so many tries an evaluator that has shown less than one box in so many waits for smaller ones."""


_JOBS = ContextVar("jobs", default=1)


@contextmanager
def shared_between(jobs: int) -> Iterator[None]:
    """Let the leaves of large trees be shared between some processes inside; verdicts are the same."""
    token = _JOBS.set(jobs)
    try:
        yield
    finally:
        _JOBS.reset(token)


def sharing() -> int:
    """How many processes may share the leaves of a tree."""
    return _JOBS.get()


def proves(loop: ClosedLoop, tree: str, jobs: int = 1) -> bool:
    """Whether a tree of boxes proves dV/dt < 0 at every state but the origin.

    Args:
        loop: arm, controller and ε₀.
        tree: in preorder, a digit for the side of ``loop.start`` that is cut, a dot for a leaf.
        jobs: processes to share the leaves between.

    Returns:
        ``True`` only if proved; ``False`` says nothing about the statement.

    Raises:
        BrokenTree: the text is not a tree of this box.

    Soundness: what lies outside the start is an image under a symmetry or has ‖e‖ ≥ R; the leaves cover it.
    """
    if jobs <= 1 or len(tree) < WORTH_SHARING:
        return proves_part(loop, tree, 0, 1)
    # spawned processes import afresh; the copy leaves behind what the closed loop has computed for itself
    from concurrent.futures import ProcessPoolExecutor
    from multiprocessing import get_context

    with ProcessPoolExecutor(jobs, mp_context=get_context("spawn")) as pool:
        with main_unnamed():
            parts = [pool.submit(proves_part, replace(loop), tree, part, jobs) for part in range(jobs)]
        return all(part.result() for part in parts)


@contextmanager
def main_unnamed() -> Iterator[None]:
    """Hide where the main module came from, so that processes spawned inside do not run a caller's script."""
    main = sys.modules["__main__"]
    file, main.__spec__, spec = vars(main).pop("__file__", None), None, main.__spec__
    try:
        yield
    finally:
        main.__spec__ = spec
        vars(main).update({} if file is None else {"__file__": file})


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
        means = [
            _Means(Evaluator(loop, BALLS)),
            _Means(CentredEvaluator(loop)),
            _Means(Evaluator(loop, SPANS)),
        ]
        # blocks, not single leaves: neighbours share the ranges that the evaluator keeps
        mine = (box for k, box in enumerate(boxes) if k // BLOCK % parts == part)
        return all(_shown(means, box) for box in mine)


@dataclass
class _Means:
    """An evaluator, and how often it was tried and has shown a box."""

    evaluator: Evaluator
    tried: int = 0
    succeeded: int = 0

    def proves(self, box: Box, depth: int) -> bool:
        """Whether P ≻ 0 is shown; not asked of a box that was hardly cut if the answer is seldom yes."""
        if depth < 2 and self.tried >= TRIES and self.succeeded * SELDOM < self.tried:
            return False
        result = self.evaluator.proves(box)
        self.tried, self.succeeded = self.tried + 1, self.succeeded + result
        return result


def _shown(means: list[_Means], box: Box) -> bool:
    """Whether P ≻ 0 is shown on a box, by one of the means, cut further where that is needed.

    The side that is cut is the widest beside what it was at the start.
    """
    stack = [(box, 0)]
    while stack:
        part, depth = stack.pop()
        # each costs several times what the one before does: halves are tried without spans first
        if any(one.proves(part, depth) for one in means[: 2 + (depth > 0)]):
            continue
        if depth == MORE_HALVINGS:
            return False
        whole = [high - low for low, high in means[0].evaluator.loop.start]
        side = max(range(len(part)), key=lambda i: (part[i][1] - part[i][0]) / whole[i])
        stack += [(half, depth + 1) for half in halves(part, side)]
    return True
