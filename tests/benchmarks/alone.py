"""The commands that nothing by hand compares with."""

from __future__ import annotations

import tempfile
from collections.abc import Iterator
from pathlib import Path

from .measure import lyapcheck
from .results import CommandResult

SHORT = (
    ("check", "published.py", "--m", "2"),
    ("explain", "7a"),
    ("robot", "buap3"),
    ("tune", "buap3"),
)


def benchmark(runs: int = 5, commands: tuple[tuple[str, ...], ...] = SHORT) -> Iterator[CommandResult]:
    """The short commands, then recheck of every certificate of the paper's proof, then the whole report."""
    for line in commands:
        yield _result(f"lyapcheck {' '.join(line)}", line, runs)
    with tempfile.TemporaryDirectory() as folder:
        certificates, report = str(Path(folder) / "certificates"), str(Path(folder) / "report")
        lyapcheck("check", "published.py", "--m", "2", "--certificates", certificates, runs=1)
        count = len(list(Path(certificates).iterdir()))
        yield _result(f"lyapcheck recheck, {count} certificates", ("recheck", certificates), runs)
        yield _result("lyapcheck report, m = 1, 2, 3 and PD", ("report", "--out", report), 1)


def _result(shown: str, line: tuple[str, ...], runs: int) -> CommandResult:
    timing = lyapcheck(*line, runs=runs)
    return CommandResult(shown, timing.seconds, timing.runs)
