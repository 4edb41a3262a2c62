"""The certificates of a proof: one for each claim of which a proof or a refutation is proposed."""

from __future__ import annotations

from collections.abc import Mapping

from lyapcheck.certificate import Certificate
from lyapcheck.check.certificate import About
from lyapcheck.claims.decision import Proposal
from lyapcheck.claims.handover import Key
from lyapcheck.claims.statements import Missing
from lyapcheck.files.fields import file_stem


def certificates(proposals: Mapping[Key, Proposal], proof: str) -> dict[Key, Certificate]:
    """The certificates of proposals that come each after those it uses; what is open has none.

    A certificate of a claim that uses others names the digests of theirs.
    """
    result: dict[Key, Certificate] = {}
    for key, row in proposals.items():
        if row.finding.proof is not None and not isinstance(row.stated, Missing):
            result[key] = Certificate(
                About(row.claim.id, row.claim.says, row.m, row.n, proof),
                row.stated,
                row.finding.verdict.value,
                row.finding.grade.label,
                row.finding.proof,
                {used: result[used, m].digest for used, m in row.used} if row.finding.is_proof else {},
            )
    return result


def file_name(claim: str, m: int | None) -> str:
    """``7a.m2.json`` for claim 7a and m = 2; characters that some file system refuses are escaped."""
    name = file_stem(claim)
    return f"{name}.json" if m is None else f"{name}.m{m}.json"
