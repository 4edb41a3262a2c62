"""Statements about an arm with the verdicts of a fresh process of the checker."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from dataclasses import dataclass

from lyapcheck.certificate import Certificate
from lyapcheck.check.certificate import About
from lyapcheck.check.statement import Statement
from lyapcheck.claims.decision import Decision, decided
from lyapcheck.claims.fresh_check import Judged, judge_afresh
from lyapcheck.claims.handover import Key
from lyapcheck.claims.search_result import SearchResult
from lyapcheck.robots import RobotModel


@dataclass(frozen=True)
class PropertyQuestion:
    """A statement in words and as data, with what a search proposes."""

    id: str
    says: str
    statement: Statement
    finding: SearchResult


@dataclass(frozen=True)
class DecidedProperty:
    """The decision, and the certificate if the checker has accepted one."""

    question: PropertyQuestion
    decision: Decision
    certificate: Certificate | None


def judged(model: RobotModel, questions: Iterable[PropertyQuestion]) -> list[DecidedProperty]:
    """The decisions, in order."""
    rows = list(questions)
    made = certificates(model, rows)
    return answered(rows, made, judge_afresh(made))


def certificates(model: RobotModel, questions: Iterable[PropertyQuestion]) -> dict[Key, Certificate]:
    """What a fresh process of the checker is to judge."""
    return {
        (row.id, None): Certificate(
            About(row.id, row.says, None, model.n, model.name),
            row.statement,
            row.finding.verdict.value,
            row.finding.grade.label,
            row.finding.proof,
        )
        for row in questions
        if row.finding.proof is not None
    }


def answered(
    questions: Iterable[PropertyQuestion], made: Mapping[Key, Certificate], judged: Mapping[Key, Judged]
) -> list[DecidedProperty]:
    """The decisions of that process, in order."""
    answers = []
    for row in questions:
        decision = decided(row.finding, judged.get((row.id, None)))
        accepted = None if decision.certificate is None else made[row.id, None]
        answers.append(DecidedProperty(row, decision, accepted))
    return answers
