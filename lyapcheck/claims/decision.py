"""What was found out about one claim, and on what evidence."""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import Any

from lyapcheck.check.statement import Proof
from lyapcheck.verdicts import Grade, Verdict


@dataclass(frozen=True)
class Decision:
    """A verdict with its grade, the method, and a witness (refuted) or a reason with advice (undecided).

    ``evidence`` holds what else was found, as plain data (boxes used, samples without a counterexample, the
    value that would have made a printed number right). ``certificate`` is what the checker accepted.
    """

    verdict: Verdict
    grade: Grade
    method: str
    reason: str = ""
    witness: dict[str, Any] | None = None
    evidence: dict[str, Any] = field(default_factory=dict)
    certificate: Proof | None = None

    def __post_init__(self) -> None:
        decided = self.verdict in (Verdict.PROVED, Verdict.REFUTED)
        if decided and self.grade is Grade.NUMERIC:
            raise ValueError("numeric evidence alone neither proves nor refutes")
        if self.verdict is Verdict.REFUTED and not self.witness:
            raise ValueError("a refutation carries a witness")
        if self.verdict is Verdict.UNDECIDED and not self.reason:
            raise ValueError("an undecided claim says why, and what to try next")
        if decided and self.certificate is None:
            raise ValueError("a verdict carries the certificate that the checker accepted")


def proved(grade: Grade, method: str, certificate: Proof | None = None, **evidence: Any) -> Decision:
    """The decision that a statement holds, as the checker found from a certificate."""
    return Decision(Verdict.PROVED, grade, method, evidence=evidence, certificate=certificate)


def refuted(
    grade: Grade,
    method: str,
    witness: dict[str, Any],
    reason: str = "",
    certificate: Proof | None = None,
    **evidence: Any,
) -> Decision:
    """The decision that a statement fails, as the checker found from a certificate with that witness."""
    return Decision(Verdict.REFUTED, grade, method, reason, witness, evidence, certificate)


def undecided(reason: str, method: str, **evidence: Any) -> Decision:
    """The decision that nothing could be decided, with a reason that says what to try next."""
    return Decision(Verdict.UNDECIDED, Grade.NUMERIC, method, reason, evidence=evidence)
