"""Branch and bound for dV/dt < 0 at every state of an arm, origin and infinity included.

P(q, e) of ``lyapcheck.check.loop`` must be positive definite for all q on the torus, all e, and all
values of what is uncertain about the arm. Boxes are enclosed in intervals, kept if P ≻ 0, else halved.

- **Infinity.** For ‖e‖ ≥ R the scalar form proves dV/dt < 0; boxes outside that ball are not looked at.
- **Origin.** ê = e/‖e‖ has no value at e = 0; its enclosure [−1, 1]ⁿ covers every direction, so boxes that
  touch e = 0 are proved for all of them, e = 0 (where ê counts as 0) included.
- **Symmetry.** Errors that a change of signs turns into others are looked at once, and angles that M does not
  depend on are held at 0.
"""

from __future__ import annotations

import math
from collections.abc import Iterator, Sequence
from concurrent.futures import Executor, ProcessPoolExecutor
from contextlib import contextmanager
from contextvars import ContextVar
from dataclasses import dataclass, field, replace
from functools import lru_cache
from multiprocessing import get_context

import numpy as np

from lyapcheck._types import Array, Progress
from lyapcheck.check.loop.closed_loop import ClosedLoop, certifies
from lyapcheck.computing import computing_time, main_unnamed
from lyapcheck.search.centred import judge_of
from lyapcheck.search.cover import Chooser, CoverOutcome, Prover, SharedSearch, cover, explored
from lyapcheck.search.cuts import Branches
from lyapcheck.search.schur import SchurProblem

# --- Boxes of one branch and bound shared between processes, of this machine or of a cluster.
#
# The first level with boxes enough is dealt out, and what lies below each hand is one task: whole subtrees,
# put together again in their places. What is found of a box depends on nothing but the box, so that trees,
# and the certificates made of them, are the same bytes as on one core.


WORTH = 8_192
"""Boxes of a level from which the subtrees below them pay for a process: fewer take a second or two."""
HANDS = 2
"""Tasks for each process. Neighbours come into different hands, so that these are about as large."""


@dataclass
class Sharing:
    """Who shares.

    Args:
        jobs: how many processes.
        pool: theirs; one of this machine is started when it is first worth it, if there is none.
        own: whether it was started here.
    """

    jobs: int
    pool: Executor | None = None
    own: bool = field(default=False, init=False)

    def submit(
        self, loop: ClosedLoop, hands: Sequence[Array], most: int, seconds: float
    ) -> Iterator[Branches]:
        """What others find below each hand of boxes; see ``lyapcheck.search.cover.SharedSearch``."""
        if self.pool is None:
            # spawned, not forked: CasADi and BLAS hold threads that a fork would leave locked
            self.pool, self.own = ProcessPoolExecutor(self.jobs, get_context("spawn")), True
        with main_unnamed():
            asked = [self.pool.submit(branches_of, loop, boxes, most, seconds) for boxes in hands]
        for one in asked:
            yield one.result()


@dataclass(frozen=True)
class LoopShare:
    """Who looks below boxes of a closed loop."""

    sharing: Sharing
    loop: ClosedLoop

    @property
    def hands(self) -> int:
        """How many boxes are dealt out to."""
        return self.sharing.jobs * HANDS

    def below(self, hands: Sequence[Array], most: int, seconds: float) -> Iterator[Branches]:
        """What is below each hand."""
        return self.sharing.submit(self.loop, hands, most, seconds / len(hands))


_SHARING: ContextVar[Sharing | None] = ContextVar("sharing", default=None)


@contextmanager
def boxes_shared(jobs: int, pool: Executor | None = None) -> Iterator[None]:
    """Inside, large branch and bound is shared by so many processes, unless it is already."""
    if jobs <= 1 or _SHARING.get() is not None:
        yield
        return
    sharing = Sharing(jobs, pool)
    token = _SHARING.set(sharing)
    try:
        yield
    finally:
        _SHARING.reset(token)
        if sharing.own and sharing.pool is not None:
            sharing.pool.shutdown()


def share_of(loop: ClosedLoop) -> SharedSearch | None:
    """What has others look below boxes of a closed loop; none where nothing is shared."""
    sharing = _SHARING.get()
    # without what the loop has computed for itself
    return None if sharing is None else LoopShare(sharing, replace(loop))


def branches_of(loop: ClosedLoop, boxes: Array, most: int, seconds: float) -> Branches:
    """What is found below some boxes of a closed loop, in another process that computes so many seconds."""
    prove, choose = _judge(loop)
    deadline = math.inf if math.isinf(seconds) else computing_time() + seconds
    return explored(boxes, prove, choose, most, deadline, few=False)


@lru_cache(maxsize=2)
def _judge(loop: ClosedLoop) -> tuple[Prover, Chooser]:
    return judge_of(SchurProblem(loop))


def certify(
    problem: SchurProblem,
    max_boxes: int,
    on_progress: Progress | None = None,
    deadline: float = math.inf,
) -> CoverOutcome:
    """Look for a tree of boxes that proves dV/dt < 0 everywhere for one ε₀, or say why there is none.

    Args:
        problem: what must be positive definite.
        deadline: by the computing time of `lyapcheck.computing`, s.

    Soundness: the tree of the outcome is a proposal for ``lyapcheck.check.loop.proves``.
    """
    loop = problem.loop
    if certifies(loop.tail, loop.eps0):
        return CoverOutcome(True, 0, tree=".")
    start = np.array(loop.start).T[None]
    prove, sides = judge_of(problem)
    return cover(start, prove, sides, max_boxes, on_progress, deadline, share_of(loop), WORTH)
