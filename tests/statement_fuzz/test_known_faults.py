"""Statements that were once accepted though false or undefined are proved through no door."""

from __future__ import annotations

import json
import subprocess
import sys
from pathlib import Path

import pytest

from tests.statement_fuzz.known_faults import FAULTS, RAISING, KnownFault
from tests.statement_fuzz.oracle.kinds import confirms, objection
from tests.statement_fuzz.subject import About, Certificate, decide

ROOT = Path(__file__).parents[2]
SCRIPT = Path(__file__).with_name("known_faults_script.py")
CHECK = "import sys; sys.argv = ['lyapcheck', *sys.argv[1:]]; from lyapcheck.cli.main import main; main()"

each_fault = pytest.mark.parametrize("fault", FAULTS, ids=lambda fault: fault.name)


@each_fault
def test_the_oracle_objects(fault: KnownFault) -> None:
    if fault.verdict == "proved":
        assert objection(fault.statement, 0) is not None
    else:
        point = {name: str(value) for name, value in getattr(fault.proof, "point", ())}
        assert confirms(fault.statement, {"point": point}) is False


@each_fault
def test_it_does_not_get_the_verdict(fault: KnownFault) -> None:
    assert decide(fault.statement).verdict.value != fault.verdict


@pytest.mark.parametrize("name", RAISING)
def test_a_decision_is_made(name: str) -> None:
    assert decide(RAISING[name]).verdict.value in ("undecided", "proved", "refuted")


def run(*arguments: object) -> subprocess.CompletedProcess[str]:
    command = [sys.executable, *map(str, arguments)]
    return subprocess.run(command, capture_output=True, text=True, cwd=ROOT, check=False, timeout=300)


@pytest.fixture(scope="module")
def verdicts_of_the_script() -> dict[str, str]:
    result = run("-c", CHECK, "check", SCRIPT, "--format", "json", "--m", 2)
    return {row["id"]: row["verdict"] for row in json.loads(result.stdout)["claims"]}


@pytest.mark.slow
@pytest.mark.parametrize("number", range(len(FAULTS)), ids=lambda number: FAULTS[number].name)
def test_a_script_does_not_get_it_either(verdicts_of_the_script: dict[str, str], number: int) -> None:
    verdicts = {"undecided", "proved", "refuted"} - {FAULTS[number].verdict}
    assert verdicts_of_the_script[f"F{number}"] in verdicts


@pytest.fixture(scope="module")
def accepted_certificates(tmp_path_factory: pytest.TempPathFactory) -> set[str]:
    """The ids of the claims whose certificates the checker, started by itself, accepts."""
    folder = tmp_path_factory.mktemp("certificates")
    for number, fault in enumerate(FAULTS):
        about = About(f"F{number}", fault.name, None, None, "known-faults")
        made = Certificate(about, fault.statement, fault.verdict, fault.grade, fault.proof)
        (folder / f"F{number}.json").write_text(made.text(), encoding="utf-8")
    result = run("-P", "-m", "lyapcheck.check", folder, "--format", "json")
    rows = json.loads(result.stdout)["certificates"]
    assert len(rows) == len(FAULTS)
    return {Path(row["file"]).stem for row in rows if row["accepted"]}


@pytest.mark.parametrize("number", range(len(FAULTS)), ids=lambda number: FAULTS[number].name)
def test_the_checker_refuses_its_certificate(accepted_certificates: set[str], number: int) -> None:
    accepted = f"F{number}" in accepted_certificates
    assert not accepted
