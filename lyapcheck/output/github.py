"""What was judged as GitHub annotations, at the line and column of the file."""

from __future__ import annotations

from collections.abc import Mapping

from lyapcheck.errors import Problem
from lyapcheck.output.answer import Annotation, Answer, Level
from lyapcheck.output.escapes import github_property, github_text

COMMANDS: Mapping[Level, str] = {Level.FAILED: "error", Level.UNDECIDED: "warning", Level.REMARK: "notice"}


def render(answer: Answer) -> str:
    """``::error …``, ``::warning …`` and ``::notice …`` lines, the answer's title as the last."""
    result = answer.annotations()
    order = {Level.REMARK: 1}  # what must be seen first
    shown = sorted((one for one in result if one.level in COMMANDS), key=lambda one: order.get(one.level, 0))
    title = f"lyapcheck {answer.schema.split('/')[1]}"
    last = f"::notice title={github_property(title)}::{github_text(answer.document().title)}"
    return "\n".join([*map(_problem, answer.problems), *map(_line, shown), last]) + "\n"


def _problem(problem: Problem) -> str:
    place = [f"file={github_property(problem.path)}"] if problem.path else []
    place += [f"line={problem.line}"] if problem.path and problem.line else []
    properties = ",".join([*place, f"title={github_property(problem.key)}"])
    return f"::error {properties}::{github_text(problem.said)}"


def _line(one: Annotation) -> str:
    place = [f"file={github_property(one.path)}"] if one.path else []
    place += [f"line={one.line}", f"col={one.column}"] if one.path and one.line else []
    title = one.subject if one.level is Level.REMARK else f"{one.subject}: {one.level.value}"
    properties = ",".join([*place, f"title={github_property(title)}"])
    return f"::{COMMANDS[one.level]} {properties}::{github_text(one.message)}"
