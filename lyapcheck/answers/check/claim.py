"""The result of a proof: one row a claim and m, ready to be printed or compared."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field
from functools import cached_property
from typing import Any

from lyapcheck.check.certificate import Certificate, digest_of
from lyapcheck.check.codec import to_json
from lyapcheck.check.finding import shortened
from lyapcheck.check.statement import Statement
from lyapcheck.claims.decision import Decision
from lyapcheck.claims.statements import Missing
from lyapcheck.verdicts import Exit, Verdict, exit_code

SCHEMA = "lyapcheck/check/2"


@dataclass(frozen=True)
class ClaimResult:
    """What was found out about one claim for one m (``None``: the claim does not depend on m).

    ``stated`` is what was decided, ``comment`` the author's words for it; ``decision`` takes into account
    what the claim uses.
    """

    id: str
    m: int | None
    n: int | None
    comment: str
    place: str
    section: str
    kind: str
    uses: tuple[str, ...]
    broken: tuple[str, ...]
    decision: Decision
    stated: Statement | Missing
    seconds: float

    @cached_property
    def statement(self) -> str:
        """What was decided, rendered by the checker from its data; cut where it is long, with a digest."""
        if isinstance(self.stated, Missing):
            return "no statement"
        text = self.stated.text()
        short = shortened(text, full=False)
        digest = "" if short == text else f" [statement {digest_of(to_json(self.stated))[:12]}]"
        return short + digest

    @property
    def verdict(self) -> Verdict:
        """The verdict, with what the claim uses taken into account."""
        return self.decision.verdict

    def to_json(self, timings: bool = False) -> dict[str, Any]:
        """The row as plain data; ``seconds`` only when asked for."""
        row: dict[str, Any] = {
            "id": self.id,
            "m": self.m,
            "n": self.n,
            "statement": self.statement,
            "comment": self.comment,
            "place": self.place,
            "section": self.section,
            "kind": self.kind,
            "verdict": self.verdict.value,
            "grade": self.decision.grade.label,
            "uses": list(self.uses),
            "broken": list(self.broken),
            "witness": self.decision.witness,
            "reason": self.decision.reason,
            "method": self.decision.method,
            "evidence": self.decision.evidence,
        }
        return {**row, "seconds": round(self.seconds, 3)} if timings else row


@dataclass(frozen=True)
class ProofResult:
    """All rows of a proof, in the order of the text.

    ``claims`` are the rows that were asked for; ``certificates``, by file name, are those that the checker
    has accepted, also of what these rows use.
    """

    name: str
    title: str
    ms: tuple[int, ...]
    n: int
    robot: str | None
    claims: tuple[ClaimResult, ...]
    assumptions: tuple[str, ...] = ()
    certificates: Mapping[str, Certificate] = field(default_factory=dict)

    @property
    def exit_code(self) -> Exit:
        """0 all proved, 1 something refuted, 3 something undecided, 4 an internal error."""
        return exit_code(row.verdict for row in self.claims)

    def counts(self) -> dict[str, int]:
        """How many rows have each verdict."""
        return {v.value: sum(row.verdict is v for row in self.claims) for v in Verdict}

    def to_json(self, timings: bool = False) -> dict[str, Any]:
        """The result as plain data of a versioned form."""
        return {
            "schema": SCHEMA,
            "proof": self.name,
            "title": self.title,
            "m": list(self.ms),
            "n": self.n,
            "robot": self.robot,
            "assumptions": list(self.assumptions),
            "counts": self.counts(),
            "claims": [row.to_json(timings) for row in self.claims],
        }
