"""The cores of this machine as workers: a pool of processes that is handed no more than it can soon do."""

from __future__ import annotations

from collections import deque
from collections.abc import Iterable, Iterator
from concurrent.futures import Future, ProcessPoolExecutor
from concurrent.futures.process import BrokenProcessPool
from multiprocessing import get_context

from lyapcheck.answers.sweep.ask import Batch, ask, failed
from lyapcheck.answers.sweep.question import Answered
from lyapcheck.check.loop.processes import main_unnamed
from lyapcheck.temporary import temporary_folder, work_in

AHEAD = 16
"""Batches a worker that may be under way, or done and waiting for an earlier one that takes longer."""
KILLED = "the process that worked on it was killed; is the memory enough?"


def answers(batches: Iterable[Batch], workers: int, jobs: int = 1) -> Iterator[list[Answered]]:
    """What comes of each batch, in their order; with one worker in this process.

    Where a worker is killed, what was under way is asked again, question by question in a process each, so
    that only the one that kills its process has no answer.

    Args:
        batches: taken as they are needed.
        workers: how many processes.
        jobs: processes that each of them may start for one question.
    """
    if workers == 1:
        yield from (ask(batch, jobs) for batch in batches)
        return
    left = iter(batches)
    with temporary_folder() as place:
        ended = False
        while not ended:
            under_way: deque[tuple[Batch, Future[list[Answered]]]] = deque()
            with _pool(workers, place) as pool:
                try:
                    while True:
                        while not ended and len(under_way) < AHEAD * workers:
                            batch = next(left, None)
                            if batch is None:
                                ended = True
                            else:
                                under_way.append((batch, _submitted(pool, batch, jobs)))
                        if not under_way:
                            break
                        result = under_way[0][1].result()
                        under_way.popleft()
                        yield result
                except BrokenProcessPool:
                    pool.shutdown(wait=False, cancel_futures=True)
            for batch, future in under_way:
                kept = _kept(future)
                yield [_alone((one,), jobs, place)[0] for one in batch] if kept is None else kept


def _kept(future: Future[list[Answered]]) -> list[Answered] | None:
    """What was done before the pool broke."""
    done = future.done() and not future.cancelled() and future.exception() is None
    return future.result() if done else None


def _alone(batch: Batch, jobs: int, place: str) -> list[Answered]:
    """One question in a process of its own."""
    with _pool(1, place) as pool:
        try:
            return _submitted(pool, batch, jobs).result()
        except BrokenProcessPool:
            return [failed(one, KILLED) for one in batch]


def _submitted(pool: ProcessPoolExecutor, batch: Batch, jobs: int) -> Future[list[Answered]]:
    with main_unnamed():
        try:
            return pool.submit(ask, batch, jobs)
        except BrokenProcessPool as broken:  # since the last look at it
            lost: Future[list[Answered]] = Future()
            lost.set_exception(broken)
            return lost


def _pool(workers: int, place: str) -> ProcessPoolExecutor:
    # spawned, not forked: CasADi and BLAS hold threads that a fork would leave locked
    return ProcessPoolExecutor(workers, get_context("spawn"), work_in, (place,))
