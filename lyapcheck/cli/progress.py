"""Progress on standard error: a bar on a terminal, a few plain lines elsewhere."""

from __future__ import annotations

import sys
from collections.abc import Iterator
from contextlib import ExitStack, contextmanager
from time import monotonic
from typing import TYPE_CHECKING

from lyapcheck._types import Progress, silent

if TYPE_CHECKING:
    from threading import Timer

SILENCE = 1.0
"""Seconds between two lines where there is no terminal."""
PATIENCE = 2.0
"""Seconds of work that need no word about it, where most work is quick."""


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
def patient(label: str) -> Iterator[Progress]:
    """The same for work that is mostly quick: nothing is shown of what ends within `PATIENCE`.

    The time counts from the first call on, and what was said last is shown when it is over, whether or not
    the work speaks again soon. Work that says nothing costs nothing.
    """
    waiting = _Waiting(label)
    try:
        yield waiting.advance
    finally:
        waiting.end()


class _Waiting:
    """Progress that keeps to itself until a timer, in a thread of its own, calls for it."""

    def __init__(self, label: str) -> None:
        self._label, self._last = label, (0.0, "")
        self._shown: Progress | None = None
        self._timer: Timer | None = None
        self._stack = ExitStack()
        self._over = False

    def advance(self, fraction: float, note: str) -> None:
        if self._timer is None:
            from threading import Lock, Timer  # here, as quick work does without

            self._lock, self._timer = Lock(), Timer(PATIENCE, self._show)
            self._last, self._timer.daemon = (fraction, note), True
            self._timer.start()
            return
        with self._lock:
            self._last = fraction, note or self._last[1]
            if self._shown is not None:
                self._shown(fraction, note)

    def end(self) -> None:
        if self._timer is not None:
            self._timer.cancel()
            with self._lock:
                self._over = True
                self._stack.close()

    def _show(self) -> None:
        with self._lock:
            if not self._over:
                self._shown = self._stack.enter_context(progress(self._label))
                self._shown(*self._last)


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
