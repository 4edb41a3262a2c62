"""Many garbled files, one after the other: each must be read or refused, in time and in little memory."""

from __future__ import annotations

import gc
import random
import resource
import signal
import time
import traceback
from collections.abc import Callable
from contextlib import contextmanager
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

from lyapcheck import robots
from lyapcheck.errors import InputError

from .mutations import SEEDS, garbled

SECONDS = 5.0
MEMORY = 1_000_000_000
"""Bytes that one file may make the process grow by."""


@dataclass
class Outcome:
    """What became of the inputs."""

    accepted: int = 0
    refused: int = 0
    slowest: float = 0.0
    failures: list[str] = field(default_factory=list)

    @property
    def sentence(self) -> str:
        """One line for people."""
        total = self.accepted + self.refused + len(self.failures)
        return (
            f"{total} inputs: {self.accepted} read, {self.refused} refused, {len(self.failures)} failures; "
            f"slowest {self.slowest:.2f} s, peak memory {peak() // 2**20} MiB"
        )


def run(
    inputs: int,
    folder: Path,
    seed: int = 20190301,
    read: Callable[[Path], Any] = robots.load,
    seconds: float = SECONDS,
) -> Outcome:
    """Feed garbled files to a reader.

    Args:
        inputs: how many.
        folder: where they are written; those that fail stay there.
        seed: the same seed gives the same files.
        read: the reader; it must return or raise ``InputError``.
        seconds: of computing time that one file may take.
    """
    rng, outcome = random.Random(seed), Outcome()
    gc.freeze()  # what others have left is not looked through within the time of a file
    for name, content in SEEDS.items():
        (folder / name).write_bytes(content)
    for number in range(inputs):
        name, content = garbled(rng)
        file = folder / f"input{Path(name).suffix}"
        file.write_bytes(content)
        begin = time.process_time()
        try:
            with limited(seconds):
                read(file)
            outcome.accepted += 1
        except InputError:
            outcome.refused += 1
        except Exception:  # whatever else a reader raises is what is looked for
            file.rename(folder / f"failure{number}{file.suffix}")
            outcome.failures.append(f"input {number} ({name}): {traceback.format_exc(limit=-4)}")
        outcome.slowest = max(outcome.slowest, time.process_time() - begin)
    return outcome


@contextmanager
def limited(seconds: float) -> Any:
    """Within it, what computes longer raises ``TimeoutError``, what takes too much memory ``MemoryError``."""
    before = resource.getrlimit(resource.RLIMIT_AS)
    previous = signal.signal(signal.SIGPROF, _late)
    signal.setitimer(signal.ITIMER_PROF, seconds)
    resource.setrlimit(resource.RLIMIT_AS, (_size() + MEMORY, before[1]))
    try:
        yield
    finally:
        signal.setitimer(signal.ITIMER_PROF, 0)
        signal.signal(signal.SIGPROF, previous)
        resource.setrlimit(resource.RLIMIT_AS, before)


def peak() -> int:
    """The largest resident memory of the process so far, bytes."""
    return resource.getrusage(resource.RUSAGE_SELF).ru_maxrss * 1024


def _size() -> int:
    pages = int(Path("/proc/self/statm").read_text(encoding="ascii").split()[0])
    return pages * resource.getpagesize()


def _late(number: int, frame: object) -> None:
    raise TimeoutError("the reader takes too long")
