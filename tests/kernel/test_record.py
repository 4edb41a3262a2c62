"""What Coq's kernel has accepted before: known by the printed proposition, without Coq."""

import json
from dataclasses import replace

from lyapcheck import kernel as record
from lyapcheck.answers.check import ClaimResult
from lyapcheck.check.certificate import certificate_of
from lyapcheck.check.kinds.stability import Property
from lyapcheck.claims.decision import Decision
from lyapcheck.control.judgement import JudgedStatement
from lyapcheck.kernel import Kernel
from lyapcheck.promise import Promise
from lyapcheck.verdicts import Grade, Verdict
from tests.kernel.test_statements import GOOD

ONE = certificate_of((GOOD / "ext.V-is-positive-definite.json").read_bytes())[0]


def result(one, decision):
    return ClaimResult("V", 1, None, "", "", "", "", (), (), decision, one, 0.0, "quoted")  # type: ignore[arg-type]


def test_check_shows_the_grade_of_what_the_record_has(monkeypatch):
    monkeypatch.setattr(record.shutil, "which", lambda name: None)
    promise = Promise(ONE.statement, JudgedStatement(ONE.statement, ONE.proof, "proved"))
    decision = Decision(Verdict.PROVED, Grade.EXACT, "", certificate=ONE.proof, promise=promise)
    assert result(ONE.statement, decision).grade == "kernel"
    assert isinstance(ONE.statement, Property)
    argument = ONE.statement.argument
    functions = tuple(
        replace(f, member=replace(f.member, value=("h", 77, ("var", "x"))))  # type: ignore[type-var]
        for f in argument.system.functions
    )
    system = replace(argument.system, functions=functions)
    other = replace(ONE.statement, argument=replace(argument, system=system))
    assert result(other, decision).grade == "exact"


def test_another_page_of_definitions_makes_the_record_void(tmp_path, monkeypatch):
    accepted = json.loads(record.FILE.read_text(encoding="utf-8"))
    old = tmp_path / "accepted.json"
    old.write_text(json.dumps(accepted | {"definitions": "0" * 64}), encoding="utf-8")
    monkeypatch.setattr(record, "FILE", old)
    record._record.cache_clear()
    try:
        assert not record.accepted_before(ONE.statement, ONE.proof, ONE.verdict)
    finally:
        record._record.cache_clear()


def test_only_what_coq_accepted_enters_the_record():
    written = json.loads(
        record.written([Kernel("a", True, "", "0 = 0", "real"), Kernel("b", False, "no", "0 = 1", "")])
    )
    assert written["accepted"][record.digest("0 = 0")] == "real"
    assert record.digest("0 = 1") not in written["accepted"]
