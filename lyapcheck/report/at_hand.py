"""Claims about the gains at hand: one a gain set, by its name, and of what the gate has judged of it.

A script knows one gain set for each m, and the arm at its nominal numbers. The gate knows all sets and the
limits that count; so that no page says two things of one set, its statements are those of the claims, too.
"""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING

from lyapcheck.answers.check.proof import ClaimResult
from lyapcheck.answers.gate.words import Row
from lyapcheck.certificate import Certificate
from lyapcheck.check.certificate import About
from lyapcheck.check.kinds.all_of import AllOf
from lyapcheck.check.statement import Statement
from lyapcheck.claims.decision import decided, judge_afresh
from lyapcheck.claims.procedures import propose
from lyapcheck.claims.statements import Missing
from lyapcheck.files.fields import file_stem
from lyapcheck.report.model import ClaimRow

if TYPE_CHECKING:
    from lyapcheck.answers.gate.judge import GateResult
    from lyapcheck.claims.handover import Key

CONDITIONS = {"10p.gains": "10p", "19.gains": "19"}
"""Claims that are conditions of the gate."""


def as_the_gate_judges(
    rows: Sequence[ClaimRow], gate: Sequence[GateResult]
) -> tuple[list[ClaimRow], dict[str, str]]:
    """The claims, those of ``CONDITIONS`` once for each gain set of their m, and the certificates of these.

    Args:
        rows: of the paper's proof.
        gate: what the gate says of each set.
    """
    asked: dict[Key, tuple[ClaimRow, str, Statement | Missing]] = {}
    for row in rows:
        for result in gate:
            if row.id in CONDITIONS and result.m == row.m is not None:
                stated = _stated(result, CONDITIONS[row.id])
                asked[f"{row.id}.{file_stem(result.name)}", row.m] = row, result.name, stated
    found = {key: propose(stated) for key, (_, _, stated) in asked.items()}
    made = {}
    for key, finding in found.items():
        row, name, stated = asked[key]
        if finding.proof is not None and isinstance(stated, Statement):
            about = About(row.id, f"{name}: {row.comment}", row.m, row.n, row.proof)
            made[key] = Certificate(about, stated, finding.verdict.value, finding.grade.label, finding.proof)
    judged = judge_afresh(made)
    fresh: dict[tuple[str, int | None], list[ClaimRow]] = {}
    for key, (row, name, stated) in asked.items():
        claim = ClaimResult(
            id=row.id,
            m=row.m,
            n=row.n,
            comment=row.comment,
            place=row.place,
            section=row.section,
            kind=type(stated).__name__,
            uses=row.uses,
            broken=(),
            decision=decided(found[key], judged.get(key), stated),
            stated=stated,
            seconds=0.0,
            stands=row.stands,
        )
        certificate = made.get(key)
        path, digest = (None, None) if certificate is None else (_path(key), certificate.digest)
        one = ClaimRow.of(claim, row.proof, row.title, path, digest, name)
        fresh.setdefault((row.id, row.m), []).append(one)
    every: list[ClaimRow] = []
    for row in rows:
        own = fresh.get((row.id, row.m))
        if own is None or own[0] not in every:
            every += own or [row]
    return every, {_path(key): one.text() for key, one in made.items()}


def _stated(result: GateResult, condition: str) -> Statement | Missing:
    """What the gate judged, all joints together."""
    checks = [check for check in result.checks if check.id == condition]
    parts = [(Row(result, one).joint, one.judgement.statement) for one in checks if one.judgement is not None]
    if len(parts) < len(checks) or not parts:
        reasons = [one.reason for one in checks if one.judgement is None]
        return Missing(reasons[0] if reasons else "the gate has not looked at it")
    return AllOf(tuple(parts))


def _path(key: Key) -> str:
    return f"certificates/published/{key[0]}.json"
