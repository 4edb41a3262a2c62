"""The verdict on a gain set as one certificate: of all that decides, or against the first that fails."""

from __future__ import annotations

from dataclasses import replace
from typing import TYPE_CHECKING

from lyapcheck.answers.gate.statement import verdict_statement
from lyapcheck.answers.gate.words import joint_name
from lyapcheck.certificate import Certificate
from lyapcheck.check.certificate import About
from lyapcheck.check.kinds.all_of import AllOf, EveryPart, OnePart
from lyapcheck.check.kinds.gate_accepted import GateAccepted
from lyapcheck.check.statement import Proof
from lyapcheck.check.verify import weakest
from lyapcheck.control.conditions import ACCEPTED, REJECTED

if TYPE_CHECKING:
    from lyapcheck.answers.gate.judge import GateResult
    from lyapcheck.control.judgement import JudgedStatement


PROOF = "gate"


def whole(result: GateResult) -> Certificate | None:
    """The certificate of the verdict on a gain set; none where it is undecided.

    One statement about the arm, its ranges and the gains where there is one, else one on numbers alone.

    Soundness: every part is a judgement of ``lyapcheck.check.verify``.
    """
    checks = [check for check in result.checks if result.decides(check)]
    known = [(check, check.judgement) for check in checks if check.judgement is not None]
    if result.verdict not in (ACCEPTED, REJECTED) or len(known) < len(checks):
        return None  # without a limit there is no statement to certify
    about = About(
        result.name, f"{result.name}: {', '.join(result.deciding)}", result.m, result.limits.n, PROOF
    )
    one = verdict_statement(result)
    if one is not None:
        kept = one.statement
        if isinstance(kept, GateAccepted) and not kept.stability and one.shown == "proved":
            about = replace(about, says=f"{result.name}: {', '.join(kept.conditions)}")
        return Certificate(about, one.statement, one.shown, one.grade, _proof(one))
    names = [f"{check.id} {joint_name(result, check)}" for check in checks]
    parts = AllOf(tuple((name, outcome.statement) for name, (_, outcome) in zip(names, known, strict=True)))
    if result.verdict == REJECTED:
        first = next(k for k, (check, _) in enumerate(known) if check.verdict == REJECTED)
        outcome = known[first][1]
        proof = OnePart(first, _proof(outcome))
        return Certificate(about, parts, "refuted", outcome.grade, proof)
    every = EveryPart(tuple(_proof(outcome) for _, outcome in known))
    return Certificate(about, parts, "proved", weakest(outcome.grade for _, outcome in known), every)


def _proof(result: JudgedStatement) -> Proof:
    assert result.proof is not None
    return result.proof
