"""What was found out about one claim for one m, and how that is said."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from functools import cached_property
from typing import TYPE_CHECKING, Any

from lyapcheck.certificate import to_json
from lyapcheck.check.certificate import digest_of
from lyapcheck.check.judgement import shortened
from lyapcheck.check.statement import Statement
from lyapcheck.kernel.record import GRADE, accepted_before
from lyapcheck.promise import told
from lyapcheck.verdicts import Verdict

if TYPE_CHECKING:
    from lyapcheck.claims.decision import Decision
    from lyapcheck.claims.statements import Missing

SHOWN_COORDINATES = 12
"""Of a witness; the rest of them are counted."""
SIDES = ("point", "left", "operator", "right")
"""What every witness says; whatever else is in one is said after it."""
RELATIONS = {"<=": "≤"}
REASONS = {Verdict.REFUTED: "where it fails", Verdict.PROVED: "remark"}
"""What the reason of a decision is called, where it is not the reason that nothing was decided."""


def statement_text(stated: Statement) -> str:
    """A statement rendered from its data; cut where it is long, with a digest."""
    text = stated.text()
    short = shortened(text, full=False)
    return short if short == text else f"{short} [statement {digest_of(to_json(stated))[:12]}]"


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
        text = statement_text(self.stated) if isinstance(self.stated, Statement) else "no statement"
        return self.decision.says(text)

    @property
    def verdict(self) -> Verdict:
        """The verdict, with what the claim uses taken into account."""
        return self.decision.verdict

    @cached_property
    def grade(self) -> str:
        """The grade of the evidence: ``kernel`` if Coq's kernel has accepted what was decided."""
        stated, decision = self.stated, self.decision
        if isinstance(stated, Statement) and (proof := decision.certificate) is not None:
            known = accepted_before(stated, proof, decision.verdict.value)
            return GRADE if known else decision.grade.label
        return decision.grade.label

    @property
    def method(self) -> str:
        """How it was decided."""
        return self.decision.says(self.decision.method)

    @property
    def words(self) -> str:
        """What the author calls it, marked as such; empty where that is nothing."""
        return f"the author's words: “{one_line(self.comment)}”" if self.comment.strip() else ""

    @property
    def support(self) -> tuple[str, ...]:
        """What supports the verdict: the witness, the reason or a remark, the claims that broke it."""
        return tuple(self._support())

    def data(self, timings: bool = False) -> dict[str, Any]:
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
            "verdict": self.decision.word,
            "grade": self.grade,
            "uses": list(self.uses),
            "broken": list(self.broken),
            "witness": self.decision.witness,
            "reason": self.decision.reason,
            "method": self.method,
            "evidence": told(self.decision.promise, self.decision.evidence),
        }
        return {**row, "seconds": round(self.seconds, 3)} if timings else row

    def record(self, timings: bool = False) -> dict[str, Any]:
        """The row with a single value under each name, without what was found on the way."""
        row, witness = self.data(timings), self.decision.witness
        del row["evidence"]
        row |= {key: " ".join(row[key]) for key in ("uses", "broken")}
        return row | {"witness": None if witness is None else witness_text(witness)}

    def _support(self) -> Iterator[str]:
        witness, reason = self.decision.witness, one_line(self.decision.reason)
        if witness is not None:
            yield f"witness: {witness_text(witness)}"
        if reason:
            yield f"{REASONS.get(self.verdict, 'reason')}: {reason}"
        if self.broken and "rests on" not in reason:
            yield f"rests on {', '.join(self.broken)}, not proved"


def one_line(text: str) -> str:
    """The text with all white space as single spaces."""
    return " ".join(text.split())


def witness_text(witness: Mapping[str, Any]) -> str:
    """A point at which a relation fails, and both of its sides there; or what else shows that it fails."""
    extra = [f"{name}: {_span(value)}" for name, value in witness.items() if name not in SIDES]
    if "point" not in witness:
        return "; ".join(extra)
    point = [f"{name} = {value}" for name, value in witness["point"].items()]
    shown, more = point[:SHOWN_COORDINATES], len(point) - SHOWN_COORDINATES
    place = f"at {', '.join([*shown, *([f'and {more} more'] if more > 0 else [])])}, " if shown else ""
    relation = RELATIONS.get(witness["operator"], witness["operator"])
    sides = f"left {_span(witness['left'])} is not {relation} right {_span(witness['right'])}"
    return "; ".join([place + sides, *extra])


def _span(value: Any) -> str:
    """A number, or the two between which it lies."""
    if not isinstance(value, list):
        return str(value)
    low, high = value
    return str(low) if low == high else f"[{low}, {high}]"
