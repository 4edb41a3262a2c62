"""Progress of work that is mostly quick: silent until it has taken long."""

from fractions import Fraction

import pytest

from lyapcheck.answers.gate import gate
from lyapcheck.cli import show
from lyapcheck.cli.show import PATIENCE, progress
from lyapcheck.control.gains import GainFile, GainSet
from tests.helpers.command import invoke
from tests.helpers.urdf_texts import ARMS


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


def test_the_gate_tells_of_certificates_and_of_nothing_else():
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
