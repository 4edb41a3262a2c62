"""Many questions at once: a plan of arms, variations and gains, asked on this machine or on a cluster."""

from __future__ import annotations

from collections import deque
from collections.abc import Iterable, Iterator, Sequence
from concurrent.futures import Future, ProcessPoolExecutor
from concurrent.futures.process import BrokenProcessPool
from itertools import groupby
from pathlib import Path
from typing import TYPE_CHECKING, Any

from lyapcheck import store
from lyapcheck.answers.sweep.plan import Plan, read_plan
from lyapcheck.answers.sweep.questions import TOGETHER, Answered, Question, Row, answered, answers
from lyapcheck.computing import main_unnamed, pool
from lyapcheck.errors import InputError, argument_error, missing
from lyapcheck.lyapunov.compiler import processors
from lyapcheck.process_tree import temporary_folder

if TYPE_CHECKING:
    from pandas import DataFrame

__all__ = ["Plan", "Rows", "asked", "read_plan", "sweep"]


def asked(plan: Plan, workers: int, scheduler: str | None = None) -> Iterator[Answered]:
    """What comes of each question of a plan, in its order; never more than a few at once are in memory.

    Args:
        plan: what is asked.
        workers: processes of this machine.
        scheduler: the address of a Dask scheduler, whose workers are asked instead.
    """
    work = batches(plan.questions())
    if scheduler is not None:
        results = answers_of_cluster(work, scheduler)
    else:
        fewer = min(workers, plan.count)  # cores that are left share what the checker judges
        results = answers_here(work, fewer, jobs=workers // max(1, fewer))
    for result in results:
        yield from result


class Rows(Iterator[Row]):
    """The rows of a sweep as they come, in the order of the plan."""

    def __init__(self, result: Iterator[Answered]) -> None:
        self._found = result

    def __next__(self) -> Row:
        return next(self._found).row

    def frame(self) -> DataFrame:
        """The rows that are left as a pandas DataFrame.

        Raises:
            ImportError: pandas is not installed.
        """
        import pandas

        return pandas.DataFrame(list(self))


def sweep(
    plan: Plan | str | Path,
    workers: int | None = None,
    scheduler: str | None = None,
    out: str | Path | None = None,
    resume: bool = False,
) -> Rows:
    """Ask all questions of a plan: rows as they come, and with ``.frame()`` a pandas DataFrame.

    A row has the question (its digest, arm, variation, gains), the verdict, numbers, the digests of the
    certificates behind it, and the whole answer as the command of that question writes it as JSON.

    Args:
        plan: what ``read_plan`` returned, or the path of a plan file.
        workers: processes; as many as there are cores by default, and none but this one with 1.
        scheduler: the address of a Dask scheduler whose workers are asked instead (extra ``sweep``).
        out: a folder for rows and certificates, written as the rows are taken; none by default.
        resume: whether the folder may hold a sweep already.

    Raises:
        InputError: the plan cannot be read, the folder not be written, or no scheduler answers.

    Soundness: the command of each question makes the verdict, in the process that answered it.

    Example:
        >>> import lyapcheck
        >>> rows = lyapcheck.sweep("examples/sweep_plan.toml", workers=1)
        >>> next(rows)["verdict"]
        'accepted'
    """
    read: Any = plan if isinstance(plan, Plan) else read_plan(plan)
    result = asked(read, processors() if workers is None else workers, scheduler)
    if out is not None:
        from lyapcheck.answers.sweep.result import Folder

        result = Folder(Path(out), resume).written(result)
    return Rows(result)


# --- Who asks: this process, the cores of this machine, or the workers of a cluster.


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
            result += answers(some, jobs)
        except Exception:
            result += [_alone(one, jobs) for one in some]
    return result


def _alone(question: Question, jobs: int) -> Answered:
    """One question for itself, whatever it raises: the others must not be lost with it."""
    try:
        return answers([question], jobs)[0]
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
            return [failed(each, KILLED) for each in batch]


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
