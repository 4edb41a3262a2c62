"""Statements that were once accepted though false or undefined are proved through no door."""

import json
import subprocess
import sys
from pathlib import Path

import pytest

from lyapcheck.certificate import Certificate
from lyapcheck.check.certificate import About
from tests.oracle import confirms, objection
from tests.statement_fuzz.judge import decide
from tests.statement_fuzz.known_faults import FAULTS, RAISING

ROOT = Path(__file__).parents[2]

each_fault = pytest.mark.parametrize("fault", FAULTS, ids=lambda fault: fault.name)


@each_fault
def test_the_oracle_objects(fault):
    if fault.verdict == "proved":
        assert objection(fault.statement, 0) is not None
    else:
        point = {name: str(value) for name, value in getattr(fault.proof, "point", ())}
        assert confirms(fault.statement, point) is False


@each_fault
def test_it_does_not_get_the_verdict(fault):
    assert decide(fault.statement).verdict.value != fault.verdict


@pytest.mark.parametrize("name", RAISING)
def test_a_decision_is_made(name):
    assert decide(RAISING[name]).verdict.value in ("undecided", "proved", "refuted")


def test_the_checker_alone_refuses_all_their_certificates(tmp_path):
    for number, fault in enumerate(FAULTS):
        about = About(f"F{number}", fault.name, None, None, "known-faults")
        made = Certificate(about, fault.statement, fault.verdict, fault.grade, fault.proof)
        (tmp_path / f"F{number}.json").write_text(made.text(), encoding="utf-8")
    command = [sys.executable, "-P", "-m", "lyapcheck.check", tmp_path, "--format", "json"]
    result = subprocess.run(command, capture_output=True, text=True, cwd=ROOT, check=False, timeout=300)
    rows = json.loads(result.stdout)["certificates"]
    assert len(rows) == len(FAULTS)
    assert [row["file"] for row in rows if row["accepted"]] == []
