"""Progress of work that is mostly quick: silent until it has taken long."""

from __future__ import annotations

import threading
from collections.abc import Callable
from fractions import Fraction
from typing import Any

import pytest

from lyapcheck.answers.gate import gate
from lyapcheck.cli.progress import patient
from lyapcheck.control.gains import GainFile, GainSet
from tests.helpers.command import invoke
from tests.helpers.urdf_texts import ARMS


class Hand:
    """A timer that goes off when a test says so."""

    def __init__(self, seconds: float, action: Callable[[], None]) -> None:
        self.action, self.running, self.daemon = action, False, False
        timers.append(self)

    def start(self) -> None:
        self.running = True

    def cancel(self) -> None:
        self.running = False


timers: list[Hand] = []


@pytest.fixture
def by_hand(monkeypatch: pytest.MonkeyPatch) -> list[Hand]:
    timers.clear()
    monkeypatch.setattr(threading, "Timer", Hand)
    return timers


def test_quick_work_shows_nothing(by_hand: list[Hand], capsys: pytest.CaptureFixture[str]) -> None:
    with patient("work") as advance:
        advance(0.0, "begun")
        advance(0.5, "half")
    (timer,) = by_hand
    assert not timer.running
    timer.action()  # one that went off at the very end
    assert capsys.readouterr().err == ""


def test_long_work_shows_what_it_said_last(by_hand: list[Hand], capsys: pytest.CaptureFixture[str]) -> None:
    with patient("work") as advance:
        advance(0.0, "begun")
        advance(0.5, "half")
        by_hand[0].action()
    assert capsys.readouterr().err == "work:  50 % half\n"


def test_the_gate_tells_of_certificates_and_of_nothing_else(by_hand: list[Hand]) -> None:
    one = GainSet("one", 1, (*map(Fraction, (20, 5)),), (*map(Fraction, ("0.1", "0.1")),))
    said: list[tuple[float, str]] = []

    def judge(*conditions: str) -> Any:
        file = GainFile("gains.toml", "reyes-kelly2", (one,))
        return gate(file, deciding=conditions, on_progress=lambda *step: said.append(step))

    assert judge("10p", "19")[0].verdict == "accepted"
    assert said == []
    assert judge("scalar", "global")[0].verdict == "accepted"
    assert said[0] == (0.0, "one: scalar certificate")
    assert (0.5, "one: global certificate") in said
    assert any(note.startswith("one: global certificate, ") for _, note in said)
    assert all(0 <= fraction <= 1 for fraction, _ in said)
    assert invoke("gate", str(ARMS / "ur5_gains.toml")).stderr == ""
    assert by_hand == []
