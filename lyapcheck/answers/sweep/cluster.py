"""The workers of a Dask cluster: its scheduler hands out the work, and again where a worker is lost."""

from __future__ import annotations

from collections import deque
from collections.abc import Iterable, Iterator
from typing import Any

from lyapcheck import store
from lyapcheck.answers.sweep.ask import Batch, ask
from lyapcheck.answers.sweep.question import Answered
from lyapcheck.errors import argument_error
from lyapcheck.search.shared import boxes_shared

AHEAD = 16
"""Batches a thread of a worker that may be under way, or done and waiting for an earlier one."""
PATIENCE = 30
"""Seconds to wait for the scheduler."""
RETRIES = 5
"""How often a batch is asked again whose worker was lost."""


def answers(batches: Iterable[Batch], scheduler: str, count: int) -> Iterator[list[Answered]]:
    """What comes of each batch, in their order.

    Args:
        batches: taken as they are needed.
        scheduler: the address, ``tcp://host:port``.
        count: how many questions; threads beyond that share the boxes of each.

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
            threads = max(1, sum(client.nthreads().values()))
            capacity, jobs = AHEAD * threads, threads // min(threads, max(1, count))
            while len(under_way) < capacity and (batch := next(left, None)) is not None:
                under_way.append(client.submit(_ask, batch, jobs, pure=False, retries=RETRIES))
            if not under_way:
                return
            made_with, result = under_way[0].result()
            under_way.popleft()
            if made_with != own:
                rule = "has a worker with another lyapcheck, or other packages behind it"
                raise argument_error("--scheduler", scheduler, rule, "install the same versions everywhere")
            yield result


def _ask(batch: Batch, jobs: int) -> tuple[str, list[Answered]]:
    """What comes of a batch, and what the worker is made of.

    With more than one job the boxes of a hard question go to the other workers; the checker stays here.
    """
    if jobs <= 1:
        return store.made_with(), ask(batch)
    from distributed import worker_client

    with worker_client() as client, boxes_shared(jobs, client.get_executor()):
        return store.made_with(), ask(batch)
