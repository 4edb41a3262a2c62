"""Boxes of one branch and bound shared between processes, of this machine or of a cluster.

The boxes that wait at one depth are judged in slices, and put together again in their order. What is proved
of a box depends on nothing but the box, so that trees, and the certificates made of them, are the same bytes
as on one core.
"""

from __future__ import annotations

from collections.abc import Iterator
from concurrent.futures import Executor, ProcessPoolExecutor
from contextlib import contextmanager
from contextvars import ContextVar
from dataclasses import dataclass, field, replace
from functools import lru_cache
from multiprocessing import get_context
from typing import Any

import numpy as np
from numpy.typing import NDArray

from lyapcheck._types import Array
from lyapcheck.check.loop import ClosedLoop
from lyapcheck.check.loop.proof import main_unnamed
from lyapcheck.search.cover import Prover
from lyapcheck.search.schur import Problem

WORTH = 2_048
"""Boxes at one depth from which a slice for another process pays for its way there and back."""
SLICES = 2
"""For each process, as some boxes take longer than others."""


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

    def proved(self, problem: Problem, boxes: Array) -> NDArray[np.bool_]:
        """What the problem says of each box."""
        if len(boxes) < WORTH:
            return problem.proved(boxes)
        if self.pool is None:
            # spawned, not forked: CasADi and BLAS hold threads that a fork would leave locked
            self.pool, self.own = ProcessPoolExecutor(self.jobs, get_context("spawn")), True
        loop = replace(problem.loop)  # without what it has computed for itself
        slices = np.array_split(boxes, self.jobs * SLICES)
        with main_unnamed():
            asked = [self.pool.submit(proved_of, loop, part) for part in slices]
        return np.concatenate([one.result() for one in asked])


_SHARING: ContextVar[Sharing | None] = ContextVar("sharing", default=None)


@contextmanager
def boxes_shared(jobs: int, pool: Executor | None = None) -> Iterator[None]:
    """Inside, large depths of branch and bound are shared by so many processes, unless they are already."""
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


def prover(problem: Problem) -> Prover:
    """What judges boxes: the problem itself, or with others."""
    sharing = _SHARING.get()
    if sharing is None:
        return problem.proved

    def proved(boxes: Array) -> NDArray[np.bool_]:
        return sharing.proved(problem, boxes)

    return proved


def proved_of(loop: ClosedLoop, boxes: Array) -> Any:
    """What the problem of a closed loop says of each box, in another process."""
    return _problem(loop).proved(boxes)


@lru_cache(maxsize=2)
def _problem(loop: ClosedLoop) -> Problem:
    return Problem(loop)
