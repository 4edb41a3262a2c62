"""Progress of work that is mostly quick: silent until it has taken long."""

import pytest

from lyapcheck.cli import show
from lyapcheck.cli.show import PATIENCE, progress


@pytest.fixture
def clock(monkeypatch):
    """A clock that a test sets."""
    now = [100.0]
    monkeypatch.setattr(show, "monotonic", lambda: now[0])
    return now


def test_quick_work_shows_nothing(clock, capsys):
    with progress("work", PATIENCE) as advance:
        advance(0.0, "begun")
        clock[0] += 0.9 * PATIENCE
        advance(0.5, "half")
    assert capsys.readouterr().err == ""


def test_long_work_shows_what_it_says_when_it_has_taken_long(clock, capsys):
    with progress("work", PATIENCE) as advance:
        advance(0.0, "begun")
        clock[0] += PATIENCE
        advance(0.5, "half")
    assert capsys.readouterr().err == "work:  50 % half\n"
