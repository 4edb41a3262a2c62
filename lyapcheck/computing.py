"""Processes: how long they compute, whatever the clock on the wall says, and work shared between some."""

from __future__ import annotations

import os
import subprocess
import sys
import time
from contextlib import contextmanager
from multiprocessing import active_children
from typing import TYPE_CHECKING

from lyapcheck.process_tree import temporary_folder, work_in

if TYPE_CHECKING:
    from collections.abc import Callable, Iterator, Sequence
    from concurrent.futures import ProcessPoolExecutor
    from pathlib import Path

_SCHEDULED = 2
"""Which of a process's clocks Linux is asked for: the time for which it was scheduled."""
_LOOK = 0.2
"""Seconds by the clock after which a process is looked at again."""


class Spent(Exception):
    """A process has computed for as long as it may."""


def computing_time() -> float:
    """The seconds that this process has computed so far, and those that it has started.

    Of processes that still run this is known on Linux; elsewhere they count when they have ended.
    """
    times = os.times()
    ended = times.children_user + times.children_system
    running = (time_of(child.pid) for child in active_children() if child.pid is not None)
    return time.process_time() + ended + sum(one or 0.0 for one in running)


def time_of(pid: int) -> float | None:
    """The seconds that another process has computed; none where the system does not say, or it has ended."""
    try:
        return time.clock_gettime((~pid << 3) | _SCHEDULED)
    except (OSError, AttributeError, OverflowError):
        return None


def run_within(command: Sequence[str], seconds: float | None, cwd: Path) -> subprocess.CompletedProcess[str]:
    """Run a program to its end.

    Args:
        command: its words.
        seconds: of computing time that it may take, by the clock where the system does not count them.
        cwd: where it runs.

    Raises:
        Spent: it takes more.
    """
    begun = time.monotonic()
    with subprocess.Popen(
        command, stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True, cwd=cwd
    ) as process:
        try:
            while True:
                try:
                    out, err = process.communicate(timeout=None if seconds is None else _LOOK)
                except subprocess.TimeoutExpired:
                    used = time_of(process.pid)
                    if seconds is not None and seconds < (time.monotonic() - begun if used is None else used):
                        raise Spent from None
                else:
                    return subprocess.CompletedProcess(command, process.returncode, out, err)
        finally:
            process.kill()


@contextmanager
def shared_between(jobs: int) -> Iterator[None]:
    """Let the checker share large judgements between some processes inside; verdicts are the same."""
    from lyapcheck.check.loop.schur import SHARE

    def all_parts(judge: Callable[..., bool], *about: object) -> bool:
        if jobs <= 1:
            return judge(*about, 0, 1)
        with temporary_folder() as place, pool(jobs, place) as workers:
            with main_unnamed():
                parts = [workers.submit(judge, *about, part, jobs) for part in range(jobs)]
            return all(part.result() for part in parts)

    token = SHARE.set(all_parts)
    try:
        yield
    finally:
        SHARE.reset(token)


def pool(workers: int, place: str) -> ProcessPoolExecutor:
    """Processes that leave their temporary files in a folder of ours; see `main_unnamed` for who submits."""
    from concurrent.futures import ProcessPoolExecutor
    from multiprocessing import get_context

    # spawned, not forked: CasADi and BLAS hold threads that a fork would leave locked
    return ProcessPoolExecutor(workers, get_context("spawn"), work_in, (place,))


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
