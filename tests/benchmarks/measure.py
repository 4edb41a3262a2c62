"""Measuring: whole processes by wall and processor time, functions of many states by states a second."""

import resource
import statistics
import subprocess
import sys
import time
from dataclasses import dataclass
from pathlib import Path

HERE = Path(__file__).parent
ROOT = HERE.parents[1]
LYAPCHECK = str(Path(sys.executable).with_name("lyapcheck"))
VERDICTS = (0, 1, 3)
"""Exit codes of a command that did its work."""
REPEATS = 5
ENOUGH = 5.0
"""Seconds of one command after which it is not run again."""


@dataclass(frozen=True)
class Timing:
    """The median wall time of some runs, that of their processor time, and what the last one printed."""

    seconds: float
    processor: float
    runs: int
    output: str


class Disagreement(AssertionError):
    """Two ways to one number gave two numbers: their times are not worth comparing."""


def lyapcheck(*arguments, runs=REPEATS):
    """A command, start of the interpreter included."""
    return timed([LYAPCHECK, *arguments], runs)


def by_hand(script, *arguments, runs=REPEATS):
    """A script in by_hand/, start of the interpreter included."""
    return timed([sys.executable, str(HERE / "by_hand" / script), *arguments], runs)


def timed(command, runs=REPEATS):
    """A process, run again until that has taken long enough."""
    walls, processors = [], []
    for _ in range(runs):
        before, begin = resource.getrusage(resource.RUSAGE_CHILDREN), time.perf_counter()
        done = subprocess.run(command, capture_output=True, text=True, check=False)
        walls.append(time.perf_counter() - begin)
        after = resource.getrusage(resource.RUSAGE_CHILDREN)
        processors.append(after.ru_utime + after.ru_stime - before.ru_utime - before.ru_stime)
        if done.returncode not in VERDICTS:
            raise RuntimeError(f"{Path(command[0]).name} {command[1:]} failed: {done.stderr.strip()}")
        if sum(walls) > ENOUGH:
            break
    return Timing(statistics.median(walls), statistics.median(processors), len(walls), done.stdout)


def states_per_second(function, states, repeats=REPEATS):
    """States a second of a call that treats ``states`` of them; one call before that warms it up."""
    function()
    times = []
    for _ in range(repeats):
        begin = time.perf_counter()
        function()
        times.append(time.perf_counter() - begin)
    return states / statistics.median(times)
