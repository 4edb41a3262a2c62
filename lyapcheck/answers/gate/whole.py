"""The verdict on a gain set as one certificate: of all that decides, or against the first that fails."""

from __future__ import annotations

from typing import TYPE_CHECKING

from lyapcheck.answers.gate.certificates import PROOF, gravity_bounds_of
from lyapcheck.answers.gate.words import joint_name
from lyapcheck.certificate import Certificate
from lyapcheck.check.certificate import About
from lyapcheck.check.kinds.all_of import AllOf, EveryPart, OnePart
from lyapcheck.check.statement import Proof
from lyapcheck.check.verify import weakest
from lyapcheck.control.conditions import ACCEPTED, REJECTED

if TYPE_CHECKING:
    from lyapcheck.answers.gate.judge import GateResult
    from lyapcheck.control.judgement import JudgedStatement


def whole(result: GateResult) -> tuple[Certificate, ...]:
    """The certificate of a gain set, and those of gravity that it uses; none where it is undecided.

    Soundness: every part is a judgement of ``lyapcheck.check.verify``.
    """
    checks = [check for check in result.checks if check.id in result.deciding]
    known = [(check, check.judgement) for check in checks if check.judgement is not None]
    if result.verdict not in (ACCEPTED, REJECTED) or len(known) < len(checks):
        return ()  # without a limit there is no statement to certify
    names = [f"{check.id} {joint_name(result, check)}" for check in checks]
    parts = AllOf(tuple((name, outcome.statement) for name, (_, outcome) in zip(names, known, strict=True)))
    about = About(
        result.name, f"{result.name}: {', '.join(result.deciding)}", result.m, result.limits.n, PROOF
    )
    if result.verdict == REJECTED:
        first = next(k for k, (check, _) in enumerate(known) if check.verdict == REJECTED)
        outcome = known[first][1]
        proof = OnePart(first, _proof(outcome))
        return (Certificate(about, parts, "refuted", outcome.grade, proof),)
    used = gravity_bounds_of(result) if {"10", "10p", "10i"} & set(result.deciding) else ()
    every = EveryPart(tuple(_proof(outcome) for _, outcome in known))
    grade = weakest(outcome.grade for _, outcome in known)
    uses = {one.claim.id: one.digest for one in used}
    return (Certificate(about, parts, "proved", grade, every, uses), *used)


def _proof(result: JudgedStatement) -> Proof:
    assert result.proof is not None
    return result.proof
