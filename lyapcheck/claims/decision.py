"""What was found out about one claim, and on what evidence."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass, field, replace
from typing import Any

from lyapcheck.verdicts import Grade, Verdict


@dataclass(frozen=True)
class Decision:
    """A verdict with its grade, the method, and a witness (refuted) or a reason with advice (undecided).

    ``evidence`` holds what else was found, as plain data (boxes used, samples without a counterexample, the
    value that would have made a printed number right).
    """

    verdict: Verdict
    grade: Grade
    method: str
    reason: str = ""
    witness: dict[str, Any] | None = None
    evidence: dict[str, Any] = field(default_factory=dict)

    def __post_init__(self) -> None:
        if self.verdict in (Verdict.PROVED, Verdict.REFUTED) and self.grade is Grade.NUMERIC:
            raise ValueError("numeric evidence alone neither proves nor refutes")
        if self.verdict is Verdict.REFUTED and not self.witness:
            raise ValueError("a refutation carries a witness")
        if self.verdict is Verdict.UNDECIDED and not self.reason:
            raise ValueError("an undecided claim says why, and what to try next")


def proved(grade: Grade, method: str, **evidence: Any) -> Decision:
    """The decision that a statement holds."""
    return Decision(Verdict.PROVED, grade, method, evidence=evidence)


def refuted(
    grade: Grade, method: str, witness: dict[str, Any], reason: str = "", **evidence: Any
) -> Decision:
    """The decision that a statement fails, at a witness."""
    return Decision(Verdict.REFUTED, grade, method, reason, witness, evidence)


def undecided(reason: str, method: str, **evidence: Any) -> Decision:
    """The decision that nothing could be decided, with a reason that says what to try next."""
    return Decision(Verdict.UNDECIDED, Grade.NUMERIC, method, reason, evidence=evidence)


def conjunction(parts: Iterable[tuple[str, Decision]]) -> Decision:
    """The decision on "all of these": refuted by the first refuted part, proved only if every part is."""
    named = list(parts)
    evidence = {
        "parts": [{"part": name, "verdict": d.verdict.value, "method": d.method} for name, d in named]
    }
    for wanted in (Verdict.REFUTED, Verdict.UNDECIDED):
        for name, decision in named:
            if decision.verdict is wanted:
                reason = f"{name}: {decision.reason}" if decision.reason else name
                return replace(decision, reason=reason, evidence={**decision.evidence, **evidence})
    methods = "; ".join(dict.fromkeys(d.method for _, d in named))
    return Decision(Verdict.PROVED, min(d.grade for _, d in named), methods, evidence=evidence)
