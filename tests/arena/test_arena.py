"""Today's checker against the arena."""

from __future__ import annotations

import json
import sys

import pytest

from tests.arena.run import ARENA, faults


def test_the_arena_is_large_enough():
    entries = json.loads((ARENA / "expected.json").read_text())
    good = [entry for entry in entries if entry["expected"] == ["accepted"]]
    assert len(good) >= 60
    assert len(entries) - len(good) >= 200
    assert {entry["path"] for entry in entries} == {
        path.relative_to(ARENA).as_posix() for side in ("good", "bad") for path in (ARENA / side).iterdir()
    }


@pytest.mark.slow
def test_the_checker_says_of_each_entry_what_is_expected():
    assert faults([sys.executable, "-m", "lyapcheck.check"]) == []


def test_a_checker_that_believes_everything_is_found_out():
    found = faults([sys.executable, "-I", "-S", "-c", "pass"], jobs=2)
    assert all("got" not in line and "accepted, expected" in line for line in found)
    assert len(found) >= 200
