"""Today's checker against the arena."""

from __future__ import annotations

import json
import sys
from collections import Counter
from collections.abc import Iterator
from contextlib import nullcontext
from typing import Any

import pytest

from lyapcheck.check import recheck
from lyapcheck.check.certificate import judged
from lyapcheck.check.codec import members
from lyapcheck.check.guard import Guard
from lyapcheck.check.judgement import Limits
from lyapcheck.check.recheck import Unreadable, gather
from lyapcheck.check.statement import Piece, Proof, Statement
from lyapcheck.check.verify import rule_for
from tests.arena.run import ARENA, ENDS, faults

NEVER_ALONE = {"Sturm", "Taylor boxes", "tree of boxes", "bounds along the links"}
"""Proofs that are part of others."""
ENTRIES = json.loads((ARENA / "expected.json").read_text())


def test_the_arena_is_large_enough():
    good = [entry for entry in ENTRIES if entry["expected"] == ["accepted"]]
    assert len(good) >= 130
    assert len(ENTRIES) - len(good) >= 1100
    assert {entry["path"] for entry in ENTRIES} == {
        path.relative_to(ARENA).as_posix() for side in ("good", "bad") for path in (ARENA / side).iterdir()
    }


def documents(side: str) -> Iterator[Any]:
    """For each entry of one side the document that it is about, of those that can be read."""
    for path in sorted((ARENA / side).iterdir()):
        try:
            result = json.loads((path / "0.json" if path.is_dir() else path).read_bytes())
        except (ValueError, RecursionError):
            continue
        if isinstance(result, dict):
            yield result


def rules_in(value: Any) -> Iterator[str]:
    """The rules of a proof and of the proofs inside it."""
    if isinstance(value, dict):
        yield from (value["rule"] for _ in range(isinstance(value.get("rule"), str)))
    inner = value.values() if isinstance(value, dict) else value if isinstance(value, list) else ()
    for part in inner:
        yield from rules_in(part)


def kind_of(document: Any, key: str, name: str) -> str:
    result = document.get(key)
    return str(result.get(name)) if isinstance(result, dict) else ""


def test_every_kind_by_every_rule_has_good_files_and_bad_ones():
    pairs = {
        (kind, by)
        for kind, one in members(Statement).items()
        for by, proof in members(Proof).items()
        if rule_for(one, proof)
    }
    counted = {
        side: Counter(
            (kind_of(one, "statement", "kind"), kind_of(one, "proof", "rule")) for one in documents(side)
        )
        for side in ("good", "bad")
    }
    assert {pair for pair in pairs if counted["good"][pair] < 1} == set()
    assert {pair for pair in pairs if counted["bad"][pair] < 2} == set()


def test_every_rule_inside_others_has_good_files_and_bad_ones():
    rules = {*members(Proof), *members(Piece)}
    assert rules >= NEVER_ALONE
    counted = {
        side: Counter(rule for one in documents(side) for rule in set(rules_in(one.get("proof"))))
        for side in ("good", "bad")
    }
    assert {rule for rule in rules if counted["good"][rule] < 1} == set()
    assert {rule for rule in rules if counted["bad"][rule] < 2} == set()


def smallest_of_each():
    """Of each kind by each rule, good and bad, the smallest file; false bounds take seconds."""
    result = {}
    for entry in ENTRIES:
        path = ARENA / entry["path"]
        if path.is_file() and len(entry["expected"]) == 1 and "/false." not in entry["path"]:
            try:
                document = json.loads(path.read_bytes())
            except (ValueError, RecursionError):
                continue
            if isinstance(document, dict):
                key = kind_of(document, "statement", "kind"), kind_of(document, "proof", "rule")
                result.setdefault((*key, *entry["expected"]), []).append(entry)
    return [min(entries, key=lambda one: (ARENA / one["path"]).stat().st_size) for entries in result.values()]


def test_one_of_each_kind_and_rule_is_accepted_or_refused_as_expected():
    """In this process; the slow test below has all entries."""
    entries = smallest_of_each()
    assert len(entries) > 200
    assert [
        entry
        for entry in entries
        if bool(judged((ARENA / entry["path"]).read_bytes()).reason) is (entry["expected"] == ["accepted"])
    ] == []


@pytest.mark.slow
def test_the_checker_says_of_each_entry_what_is_expected(monkeypatch):
    """Entry by entry, by one process that judges them all."""

    def said(path):
        try:
            return recheck.recheck(gather([path])).code
        except Unreadable:
            return 2

    with Guard(Limits()) as guard:
        monkeypatch.setattr(recheck, "Guard", lambda limits: nullcontext(guard))
        outcomes = {entry["path"]: ENDS.get(said(ARENA / entry["path"])) for entry in ENTRIES}
    assert [
        path for path, entry in zip(outcomes, ENTRIES, strict=True) if outcomes[path] not in entry["expected"]
    ] == []


@pytest.mark.slow
def test_so_does_the_command_which_judges_in_a_process_for_each():
    assert faults([sys.executable, "-P", "-m", "lyapcheck.check"], one_in=40) == []


@pytest.mark.slow
def test_a_checker_that_believes_everything_is_found_out():
    result = faults(["true"], one_in=5)
    assert all("accepted, expected" in line for line in result)
    assert len(result) >= 200
