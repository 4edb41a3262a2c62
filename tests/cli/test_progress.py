"""Progress of work that is mostly quick: silent until it has taken long."""

import threading
from fractions import Fraction

import pytest

from lyapcheck.answers.gate import gate
from lyapcheck.cli.progress import patient
from lyapcheck.control.gains import GainFile, GainSet
from tests.helpers.command import invoke
from tests.helpers.urdf_texts import ARMS


class Hand:
    """A timer that goes off when a test says so."""

    def __init__(self, seconds, action):
        self.action, self.running, self.daemon = action, False, False
        timers.append(self)

    def start(self):
        self.running = True

    def cancel(self):
        self.running = False


timers = []


@pytest.fixture
def by_hand(monkeypatch):
    timers.clear()
    monkeypatch.setattr(threading, "Timer", Hand)
    return timers


def test_quick_work_shows_nothing(by_hand, capsys):
    with patient("work") as advance:
        advance(0.0, "begun")
        advance(0.5, "half")
    (timer,) = by_hand
    assert not timer.running
    timer.action()  # one that went off at the very end
    assert capsys.readouterr().err == ""


def test_long_work_shows_what_it_said_last(by_hand, capsys):
    with patient("work") as advance:
        advance(0.0, "begun")
        advance(0.5, "half")
        by_hand[0].action()
    assert capsys.readouterr().err == "work:  50 % half\n"


def test_the_gate_tells_of_certificates_and_of_nothing_else(by_hand):
    one = GainSet("one", 1, (*map(Fraction, (20, 5)),), (*map(Fraction, ("0.1", "0.1")),))
    said = []

    def judge(*conditions):
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
