"""Large trees of boxes judged by several processes, to make certificates sooner; verdicts are the same."""

from __future__ import annotations

import sys
from collections.abc import Iterator
from concurrent.futures import ProcessPoolExecutor
from contextlib import contextmanager
from dataclasses import replace
from functools import partial
from multiprocessing import get_context

from lyapcheck.check.loop.closed_loop import ClosedLoop
from lyapcheck.check.loop.proof import IN_PARTS, proves_part

WORTH_SHARING = 20_000
"""Characters of a tree from which a second process pays for its start."""


@contextmanager
def shared_between(jobs: int) -> Iterator[None]:
    """Let the leaves of large trees be shared between some processes inside."""
    token = IN_PARTS.set(partial(proves_in_processes, jobs))
    try:
        yield
    finally:
        IN_PARTS.reset(token)


def proves_in_processes(jobs: int, loop: ClosedLoop, tree: str) -> bool:
    """What `lyapcheck.check.loop.proof.proves` says, by so many processes where the tree is large."""
    if jobs <= 1 or len(tree) < WORTH_SHARING:
        return proves_part(loop, tree, 0, 1)
    # spawned processes import afresh; the copy leaves behind what the closed loop has computed for itself
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
