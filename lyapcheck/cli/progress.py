"""Progress on standard error: a bar on a terminal, a few plain lines elsewhere."""

from __future__ import annotations

import sys
from collections.abc import Iterator
from contextlib import contextmanager
from time import monotonic

from lyapcheck._types import Progress, silent

SILENCE = 1.0
"""Seconds between two lines where there is no terminal."""


@contextmanager
def progress(label: str, quiet: bool = False) -> Iterator[Progress]:
    """Show how far a piece of work has come; yields the function that the work calls to say so.

    What is shown never falls: work that begins anew, with fewer boxes or another ε₀, stays where it was.
    """
    if quiet:
        yield silent
        return
    reached = 0.0
    with _bar(label) if sys.stderr.isatty() else _lines(label) as advance:

        def upwards(fraction: float, note: str) -> None:
            nonlocal reached
            reached = max(reached, fraction)
            advance(reached, note)

        yield upwards


@contextmanager
def _bar(label: str) -> Iterator[Progress]:
    from rich.console import Console
    from rich.progress import BarColumn, Progress, TextColumn, TimeElapsedColumn

    label_column, note_column = TextColumn("{task.description}"), TextColumn("{task.fields[note]}")
    columns = (label_column, BarColumn(), TimeElapsedColumn(), note_column)
    with Progress(*columns, console=Console(stderr=True), transient=True) as bar:
        task = bar.add_task(label, total=1.0, note="")
        yield lambda fraction, note: bar.update(task, completed=fraction, note=note)


@contextmanager
def _lines(label: str) -> Iterator[Progress]:
    last, shown_at = "", -SILENCE

    def advance(fraction: float, note: str) -> None:
        nonlocal last, shown_at
        if note and note != last and monotonic() - shown_at >= SILENCE:
            print(f"{label}: {round(100 * fraction):3d} % {note}", file=sys.stderr)
            last, shown_at = note, monotonic()

    yield advance
