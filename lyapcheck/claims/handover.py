"""What a proof script hands over: its claims in words, and their statements as plain data.

The script runs in a process of its own, see ``script_process``; all that comes back is the JSON of a
:class:`Handover`, in which unknown keys, other types and statements that are not well written are refused.
"""

from __future__ import annotations

import json
from collections.abc import Iterable
from dataclasses import dataclass, replace
from typing import Any

from lyapcheck.certificate import to_json
from lyapcheck.check.certificate import TOO_DEEP as DOCUMENT_TOO_DEEP
from lyapcheck.check.certificate import parse
from lyapcheck.check.codec import from_json
from lyapcheck.check.expressions.grammar import MAX_DEPTH
from lyapcheck.check.judgement import MAX_BYTES
from lyapcheck.check.refusal import Refused, require
from lyapcheck.check.statement import Statement
from lyapcheck.claims.claim import Lacking
from lyapcheck.claims.statements import Missing
from lyapcheck.verdicts import STANDS

CaseData = tuple[int, int, Any, Any]
"""m, n, a robot or none, and a gain set or none."""
TOO_DEEP = f"is nested deeper than {MAX_DEPTH} levels"
"""The rule of the checker that a statement of many joints may break: it is then undecided."""
Key = tuple[str, int | None]
"""The id of a claim and the m it is decided for, none if it does not depend on m."""


@dataclass(frozen=True)
class ScriptRequest:
    """What a script is asked for.

    Args:
        path: the script.
        shown: its name in messages.
        asked: the cases that are wanted; without one, only what the claims are.
        others: more cases, only to see what a claim depends on; there it may fail.
        only: the claims wanted, with what they use; all by default.
        answer: the file that receives the JSON.
    """

    path: str
    shown: str
    asked: tuple[CaseData, ...] = ()
    others: tuple[CaseData, ...] = ()
    only: tuple[str, ...] = ()
    answer: str = ""


@dataclass(frozen=True)
class ScriptAnswer:
    """The statement for one case by its number, or why there is none, and what the function looked at."""

    statement: int | None
    lacking: str
    read: tuple[str, ...]


@dataclass(frozen=True)
class ClaimData:
    """A claim as the script states it, with an answer for each case; none if nobody asked for the claim."""

    id: str
    says: str
    place: str
    section: str
    uses: tuple[str, ...]
    stands: str = "ours"
    answers: tuple[ScriptAnswer, ...] = ()


@dataclass(frozen=True)
class Handover:
    """A proof as its script states it, or what is wrong with the script."""

    name: str = ""
    title: str = ""
    reference: str = ""
    claims: tuple[ClaimData, ...] = ()
    problems: tuple[tuple[str, int | None, str, str, str, str], ...] = ()
    statements: tuple[Statement | Missing, ...] = ()

    def stated(self, answer: ScriptAnswer) -> Statement | Missing:
        """What an answer states."""
        return Missing(answer.lacking) if answer.statement is None else self.statements[answer.statement]


def write(handover: Handover, statements: Iterable[str]) -> str:
    """A handover as JSON, and below it one line a statement."""
    return "\n".join([json.dumps(to_json(handover)), *statements])


def statement_json(statement: Statement) -> str:
    """A statement as a line of JSON.

    Raises:
        Lacking: it is longer than any that the checker reads.
        RecursionError: it is nested deeper.
        ValueError, TypeError: it is not plain data.
    """
    line = json.dumps(to_json(statement), separators=(",", ":"), allow_nan=False)
    if len(line) > MAX_BYTES:
        raise Lacking(f"its statement, written out, is above {MAX_BYTES} characters")
    return line


def read(text: str, cases: int) -> Handover:
    """A handover as :func:`write` writes it.

    Args:
        text: untrusted.
        cases: how many answers there are to each claim that has any.

    Raises:
        Refused, ValueError: it is not exactly of that form.
    """
    first, *lines = text.split("\n")
    handover = from_json(Handover, parse(first), "handover")
    require(not handover.statements, "statements", len(handover.statements), "are on lines of their own")
    ids = [claim.id for claim in handover.claims]
    require(len(set(ids)) == len(ids), "claims", ", ".join(ids), "must have different ids")
    makers: dict[int, str] = {}
    for claim in handover.claims:
        require(claim.stands in STANDS, claim.id, claim.stands, f"must stand as one of {', '.join(STANDS)}")
        require(len(claim.answers) in (0, cases), claim.id, len(claim.answers), f"must have {cases} answers")
        for number in (answer.statement for answer in claim.answers if answer.statement is not None):
            require(0 <= number < len(lines), claim.id, number, "is not the number of a statement")
            makers.setdefault(number, claim.id)
    statements: list[Statement | Missing] = []
    for k, line in enumerate(lines):
        try:
            statements.append(from_json(Statement, parse(line), makers.get(k, "?")))
        except Refused as refusal:
            if refusal.rule not in (TOO_DEEP, DOCUMENT_TOO_DEEP):
                raise
            statements.append(Missing(f"its statement {refusal.rule}"))
    return replace(handover, statements=tuple(statements))
