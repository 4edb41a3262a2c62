"""A checker that proves and refutes one statement is wrong: no verdict of that run is shown."""

import json
from subprocess import CompletedProcess

import pytest

from lyapcheck.claims import decision
from tests.helpers.command import invoke

SCRIPT = """
from lyapcheck.claims import Constant, Proof, expr

proof = Proof("one", "One")
proof.add("a", "1 ≤ 2", Constant(expr(1) <= 2))
"""


@pytest.fixture
def contradicting(monkeypatch):
    """A checker that finds one statement both true and false."""
    answer = {
        "alarms": [{"statement": "1 ≤ 2", "proved": ["0.json"], "refuted": ["1.json"]}],
        "certificates": [],
    }

    def run(*_, **__):
        return CompletedProcess((), 4, json.dumps(answer).encode(), b"")

    monkeypatch.setattr(decision.subprocess, "run", run)


def test_an_alarm_of_the_checker_is_the_only_thing_that_is_said(contradicting, tmp_path):
    (tmp_path / "one.py").write_text(SCRIPT, encoding="utf-8")
    shown = invoke("check", str(tmp_path / "one.py"))
    assert shown.exit_code == 4
    assert "proved and refuted" in shown.output
    assert "1 ≤ 2" in shown.output
    assert "1 proved" not in shown.output
