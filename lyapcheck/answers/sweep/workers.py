"""Who asks the questions of a sweep: this process, the cores of this machine, or the workers of a cluster."""

from __future__ import annotations

from collections import deque
from collections.abc import Iterable, Iterator, Sequence
from concurrent.futures import Future, ProcessPoolExecutor
from concurrent.futures.process import BrokenProcessPool
from itertools import groupby
from typing import Any

from lyapcheck import store
from lyapcheck.answers.sweep.asks import TOGETHER, asked
from lyapcheck.answers.sweep.question import Answered, Question, answered
from lyapcheck.computing import main_unnamed, pool
from lyapcheck.errors import InputError, argument_error, missing
from lyapcheck.process_tree import temporary_folder

ERROR = "error"
MANY = 100
"""So many of the gate's questions are asked together: a worker has work for a tenth of a second at least."""

Batch = tuple[Question, ...]
AHEAD = 16
"""Batches a worker that may be under way, or done and waiting for an earlier one that takes longer."""
KILLED = "the process that worked on it was killed; is the memory enough?"
PATIENCE = 30
"""Seconds to wait for the scheduler."""
RETRIES = 5
"""How often a batch is asked again whose worker was lost."""


def batches(questions: Iterable[Question]) -> Iterator[Batch]:
    """What is handed to a worker at once: a few questions in the order of the plan, one heavy one at most."""
    batch: list[Question] = []
    for question in questions:
        batch.append(question)
        if question.ask != TOGETHER or len(batch) == MANY:
            yield tuple(batch)
            batch = []
    if batch:
        yield tuple(batch)


def ask(batch: Sequence[Question], jobs: int = 1) -> list[Answered]:
    """What comes of some questions, in their order; what cannot be asked has the verdict ``error``.

    Args:
        batch: the questions.
        jobs: processes that may share one of them; they change no answer.
    """
    result: list[Answered] = []
    for _, group in groupby(batch, key=lambda one: (one.ask, one.robot, one.variation, one.options)):
        some = list(group)
        try:
            result += asked(some, jobs)
        except Exception:
            result += [_alone(one, jobs) for one in some]
    return result


def _alone(question: Question, jobs: int) -> Answered:
    """One question for itself, whatever it raises: the others must not be lost with it."""
    try:
        return asked([question], jobs)[0]
    except InputError as error:
        return failed(question, "; ".join(map(str, error.problems)))
    except Exception as error:
        lack = missing(error) if isinstance(error, ImportError) else None
        if lack is not None:  # all the others lack it, too
            raise lack from None
        return failed(question, f"{type(error).__name__}: {error}")


def failed(question: Question, reason: str) -> Answered:
    """The row of a question that could not be asked."""
    return answered(question, ERROR, None, reason=reason)


def answers_here(batches: Iterable[Batch], workers: int, jobs: int = 1) -> Iterator[list[Answered]]:
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
            with pool(workers, place) as some:
                try:
                    while True:
                        while not ended and len(under_way) < AHEAD * workers:
                            batch = next(left, None)
                            if batch is None:
                                ended = True
                            else:
                                under_way.append((batch, _submitted(some, batch, jobs)))
                        if not under_way:
                            break
                        result = under_way[0][1].result()
                        under_way.popleft()
                        yield result
                except BrokenProcessPool:
                    some.shutdown(wait=False, cancel_futures=True)
            for batch, future in under_way:
                kept = _kept(future)
                yield [_in_own_process((one,), jobs, place)[0] for one in batch] if kept is None else kept


def _kept(future: Future[list[Answered]]) -> list[Answered] | None:
    """What was done before the pool broke."""
    done = future.done() and not future.cancelled() and future.exception() is None
    return future.result() if done else None


def _in_own_process(batch: Batch, jobs: int, place: str) -> list[Answered]:
    """One question in a process of its own."""
    with pool(1, place) as one:
        try:
            return _submitted(one, batch, jobs).result()
        except BrokenProcessPool:
            return [failed(one, KILLED) for one in batch]


def _submitted(some: ProcessPoolExecutor, batch: Batch, jobs: int) -> Future[list[Answered]]:
    with main_unnamed():
        try:
            return some.submit(ask, batch, jobs)
        except BrokenProcessPool as broken:  # since the last look at it
            lost: Future[list[Answered]] = Future()
            lost.set_exception(broken)
            return lost


def answers_of_cluster(batches: Iterable[Batch], scheduler: str) -> Iterator[list[Answered]]:
    """What comes of each batch, in their order.

    Args:
        batches: taken as they are needed.
        scheduler: the address, ``tcp://host:port``.

    Raises:
        InputError: distributed is not installed, no scheduler answers, or a worker has another lyapcheck.
    """
    try:
        from distributed import Client
    except ImportError:
        repair = "pip install 'lyapcheck[sweep]', or leave --scheduler out"
        raise argument_error("--scheduler", scheduler, "needs the package distributed", repair) from None
    try:
        client: Any = Client(scheduler, timeout=PATIENCE, set_as_default=False)
    except (OSError, ValueError) as error:
        repair = "start one with dask scheduler, or correct the address"
        raise argument_error("--scheduler", scheduler, f"does not answer ({error})", repair) from None
    left, own = iter(batches), store.made_with()
    under_way: deque[Any] = deque()
    with client:
        while True:
            capacity = AHEAD * max(1, sum(client.nthreads().values()))
            while len(under_way) < capacity and (batch := next(left, None)) is not None:
                under_way.append(client.submit(_ask, batch, pure=False, retries=RETRIES))
            if not under_way:
                return
            made_with, result = under_way[0].result()
            under_way.popleft()
            if made_with != own:
                rule = "has a worker with another lyapcheck, or other packages behind it"
                raise argument_error("--scheduler", scheduler, rule, "install the same versions everywhere")
            yield result


def _ask(batch: Batch) -> tuple[str, list[Answered]]:
    """What comes of a batch, and what the worker is made of."""
    return store.made_with(), ask(batch)
