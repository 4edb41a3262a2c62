"""A judgement in parts, each by a process of its own: verdicts come sooner and are the same."""

from __future__ import annotations

import sys
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from contextvars import ContextVar

_JOBS = ContextVar("jobs", default=1)


@contextmanager
def shared_between(jobs: int) -> Iterator[None]:
    """Let large judgements be shared between some processes inside."""
    token = _JOBS.set(jobs)
    try:
        yield
    finally:
        _JOBS.reset(token)


def all_parts(judge: Callable[..., bool], *about: object) -> bool:
    """Whether ``judge(*about, part, parts)`` holds for every part from 0 on."""
    jobs = _JOBS.get()
    if jobs <= 1:
        return judge(*about, 0, 1)
    from concurrent.futures import ProcessPoolExecutor
    from multiprocessing import get_context

    with ProcessPoolExecutor(jobs, mp_context=get_context("spawn")) as pool:
        with main_unnamed():
            parts = [pool.submit(judge, *about, part, jobs) for part in range(jobs)]
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
