"""Measuring: whole processes by the wall clock, functions of many states by states a second."""

from __future__ import annotations

import resource
import statistics
import subprocess
import sys
import time
from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path

HERE = Path(__file__).parent
PROOFS = HERE.parent.parent / "proofs"
LYAPCHECK = str(Path(sys.executable).with_name("lyapcheck"))
VERDICTS = (0, 1, 3)
"""Exit codes of a command that did its work."""

REPEATS = 5

ENOUGH = 5.0
"""Seconds of one command after which it is not run again."""


@dataclass(frozen=True)
class Timing:
    """The median wall time of some runs of one process, and what the last run printed."""

    seconds: float
    runs: int
    output: str


class Disagreement(AssertionError):
    """Two ways to one number gave two numbers: their times are not worth comparing."""


def lyapcheck(*arguments: str, runs: int = REPEATS) -> Timing:
    """The wall time of a command, start of the interpreter included."""
    return _timed([LYAPCHECK, *arguments], runs)


def by_hand(script: str, *arguments: str, runs: int = REPEATS) -> Timing:
    """The wall time of a script in by_hand/, start of the interpreter included."""
    return _timed([sys.executable, str(HERE / "by_hand" / script), *arguments], runs)


def _timed(command: list[str], runs: int) -> Timing:
    times = []
    for _ in range(runs):
        begin = time.perf_counter()
        done = subprocess.run(command, capture_output=True, text=True, check=False)
        times.append(time.perf_counter() - begin)
        if done.returncode not in VERDICTS:
            raise RuntimeError(f"{Path(command[0]).name} {command[1:]} failed: {done.stderr.strip()}")
        if sum(times) > ENOUGH:
            break
    return Timing(statistics.median(times), len(times), done.stdout)


def in_turn(one: list[str], other: list[str], runs: int = REPEATS) -> list[tuple[float, float]]:
    """The processor times of two commands run one after the other, pair by pair.

    Of processes this short the wall time says more of what else the machine does.
    """
    pairs = []
    for _ in range(runs + 1):
        pairs.append((processor_seconds(one)[1], processor_seconds(other)[1]))
    return pairs[1:]  # the first pair has warmed up both


def processor_seconds(command: list[str]) -> tuple[str, float]:
    """What a command prints, and the processor time that it and its processes take."""
    before = resource.getrusage(resource.RUSAGE_CHILDREN)
    done = subprocess.run(command, stdout=subprocess.PIPE, stderr=subprocess.DEVNULL, text=True, check=False)
    after = resource.getrusage(resource.RUSAGE_CHILDREN)
    return done.stdout, after.ru_utime + after.ru_stime - before.ru_utime - before.ru_stime


def states_per_second(function: Callable[[], object], states: int, repeats: int = REPEATS) -> float:
    """States a second of a call that treats ``states`` of them; one call before that warms it up."""
    function()
    times = []
    for _ in range(repeats):
        begin = time.perf_counter()
        function()
        times.append(time.perf_counter() - begin)
    return states / statistics.median(times)
