"""Statements that were once accepted though false or undefined are proved through no door.

They are the certificates ``known.*`` of the arena, each with the proof that was accepted; more are welcome,
none goes. A decision must be made on those of ``raising.json``, if only that there is none.
"""

import json
from pathlib import Path

from lyapcheck.check.certificate import judged
from lyapcheck.check.codec import from_json
from lyapcheck.check.statement import Statement
from tests.arena.run import ARENA
from tests.helpers.committed import read
from tests.oracle import confirms, objection
from tests.statement_fuzz.judge import decide

FAULTS = sorted((ARENA / "bad").glob("known.*.json"))
RAISING = json.loads(Path(__file__).with_name("raising.json").read_text(encoding="utf-8"))


def test_the_oracle_objects_and_neither_search_nor_checker_says_it_again():
    assert len(FAULTS) >= 38
    for path in FAULTS:
        data = json.loads(path.read_text(encoding="utf-8"))
        statement, proof = read(f"bad/{path.stem}")
        if data["verdict"] == "proved":
            assert objection(statement, 0) is not None, path.name
        else:
            point = {name: str(value) for name, value in getattr(proof, "point", ())}
            assert confirms(statement, point) is False, path.name
        assert decide(statement).verdict.value != data["verdict"], path.name
        assert judged(path.read_bytes()).reason, path.name


def test_a_decision_is_made():
    for name, data in RAISING.items():
        verdict = decide(from_json(Statement, data, "")).verdict.value
        assert verdict in ("undecided", "proved", "refuted"), name
