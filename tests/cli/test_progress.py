"""Progress: silent for quick work, one line now and then without a terminal, and never back."""

import io
import sys

import pytest

from lyapcheck.cli import show
from lyapcheck.cli.show import PATIENCE, SILENCE, progress


@pytest.fixture
def clock(monkeypatch):
    """A clock that a test sets."""
    now = [100.0]
    monkeypatch.setattr(show, "monotonic", lambda: now[0])
    return now


class Terminal(io.StringIO):
    def isatty(self):
        return True


def test_a_log_gets_a_line_every_half_minute(clock, capsys):
    with progress("work") as advance:
        for part in range(10):
            advance(part / 10, f"part {part}")
            clock[0] += 0.4 * SILENCE
    assert capsys.readouterr().err == "work:  30 % part 3\nwork:  60 % part 6\nwork:  90 % part 9\n"


@pytest.mark.parametrize(("share", "shown"), [(0.9, False), (1.0, True)])
def test_a_terminal_gets_a_bar_after_some_seconds(share, shown, clock, monkeypatch):
    monkeypatch.setattr(sys, "stderr", terminal := Terminal())
    with progress("work") as advance:
        advance(0.0, "begun")
        clock[0] += share * PATIENCE
        advance(0.5, "half")
    assert ("50%" in terminal.getvalue() and "half" in terminal.getvalue()) == shown
    assert bool(terminal.getvalue()) == shown


def test_progress_never_falls(clock, capsys):
    with progress("work") as advance:
        for share, note in ((0.5, "first"), (0.1, "second"), (0.7, "third")):
            clock[0] += SILENCE
            advance(share, note)
    assert [line.split()[1] for line in capsys.readouterr().err.splitlines()] == ["50", "50", "70"]
