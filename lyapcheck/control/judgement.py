"""What the checker says of a statement about gains, by the first of some proofs that it accepts."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass

from lyapcheck.check.refusal import Refused
from lyapcheck.check.statement import Proof, Statement
from lyapcheck.check.verify import verify

ACCEPTED, REJECTED, UNDECIDED = "accepted", "rejected", "undecided"
VERDICTS = {"proved": ACCEPTED, "refuted": REJECTED}


@dataclass(frozen=True)
class JudgedStatement:
    """A statement with the verdict of ``lyapcheck.check.verify``; no proof where none was accepted.

    Args:
        statement: what is claimed.
        proof: that was accepted, of the statement or against it.
        shown: ``proved``, ``refuted`` or ``undecided``.
        grade: of the proof.
        reason: why the last proof was refused.
    """

    statement: Statement
    proof: Proof | None
    shown: str
    grade: str = ""
    reason: str = ""

    @property
    def verdict(self) -> str:
        """``accepted``, ``rejected`` or ``undecided``."""
        return VERDICTS.get(self.shown, UNDECIDED)


def judged_statement(statement: Statement, proofs: Iterable[Proof]) -> JudgedStatement:
    """The verdict on a statement.

    Soundness: that of ``lyapcheck.check.verify``.
    """
    reason = "no proof was tried"
    for proof in proofs:
        try:
            result = verify(statement, proof)
        except Refused as refused:
            reason = str(refused)
        else:
            return JudgedStatement(statement, proof, result.verdict, result.grade, "")
    return JudgedStatement(statement, None, UNDECIDED, "", reason)


def proves(statement: Statement, proof: Proof) -> bool:
    """Whether the checker accepts a proof of a statement."""
    return judged_statement(statement, [proof]).shown == "proved"


def refutes(statement: Statement, proof: Proof) -> bool:
    """Whether the checker accepts a refutation of a statement."""
    return judged_statement(statement, [proof]).shown == "refuted"
