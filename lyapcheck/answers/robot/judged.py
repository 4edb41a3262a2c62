"""Statements about an arm with the verdicts of a fresh process of the checker."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from dataclasses import dataclass

from lyapcheck.asked import over_ranges
from lyapcheck.certificate import Certificate
from lyapcheck.check.certificate import About
from lyapcheck.check.statement import Statement
from lyapcheck.claims.decision import Decision, decided
from lyapcheck.claims.fresh_check import Judged, judge_afresh
from lyapcheck.claims.handover import Key
from lyapcheck.claims.search_result import SearchResult
from lyapcheck.claims.statements import Missing
from lyapcheck.promise import Promise, promised
from lyapcheck.robots import Number, RobotModel


@dataclass(frozen=True)
class PropertyQuestion:
    """A statement in words and as data, with what a search proposes, and what was asked."""

    id: str
    says: str
    statement: Statement
    finding: SearchResult
    asked: Statement


@dataclass(frozen=True)
class DecidedProperty:
    """The decision, the certificate if the checker has accepted one, and a promise about all ranges."""

    question: PropertyQuestion
    decision: Decision
    certificate: Certificate | None
    over: Promise | None


def judged(model: RobotModel, questions: Iterable[PropertyQuestion]) -> list[DecidedProperty]:
    """The decisions, in order."""
    rows = list(questions)
    made = certificates(model, rows)
    return answered(model, rows, made, judge_afresh(made))


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
    model: RobotModel,
    questions: Iterable[PropertyQuestion],
    made: Mapping[Key, Certificate],
    judged: Mapping[Key, Judged],
) -> list[DecidedProperty]:
    """The decisions of that process, in order."""
    answers = []
    for row in questions:
        decision = decided(row.finding, judged.get((row.id, None)), row.asked)
        accepted = None if decision.certificate is None else made[row.id, None]
        over = about_ranges(row.asked, decision, model.parameters.values(), model)
        answers.append(DecidedProperty(row, decision, accepted, over))
    return answers


def about_ranges(
    stated: Statement | Missing, decision: Decision, numbers: Iterable[Number], model: RobotModel
) -> Promise | None:
    """The promise that what is proved holds for all values of the ranges, where it does.

    Args:
        stated: what was asked.
        decision: on it.
        numbers: of the arm that it is about.
        model: the arm.
    """
    if decision.promise is None or not isinstance(stated, Statement):
        return None
    if not any(number.ranged for number in numbers):
        return decision.promise
    asked = over_ranges(stated, model)
    return None if asked is None else promised(asked, decision.promise.shown)[0]
