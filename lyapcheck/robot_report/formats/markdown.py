"""The report of an arm as Markdown."""

from __future__ import annotations

from collections.abc import Sequence

from lyapcheck.robot_report.build import RobotReport
from lyapcheck.robot_report.formats.words import (
    CONSTANT_HEADS,
    JOINT_HEADS,
    constant_row,
    evidence,
    headline,
    joint_rows,
    number_line,
)


def render(report: RobotReport) -> str:
    """Headings, tables and lists."""
    claims = [
        (row.id, row.verdict.value, row.finding.grade.label, row.statement, evidence(row))
        for row in report.properties
    ]
    lines = [f"# {headline(report)}", "", "## Properties", ""]
    lines += _table([("property", "verdict", "grade", "statement", "evidence"), *claims])
    if report.prints:
        rows = [(row.verdict.value, row.statement, evidence(row)) for row in report.prints]
        lines += ["", "## As the source prints it", ""]
        lines += _table([("verdict", "claim", "evidence"), *rows])
    lines += [
        "",
        "## Constants",
        "",
        "At nominal parameters; for k_c the last numbers are the direction x.",
        "",
    ]
    lines += _table([CONSTANT_HEADS, *map(constant_row, report.constants)])
    lines += ["", "## Joints", "", *_table([JOINT_HEADS, *joint_rows(report)]), "", "## Numbers", ""]
    lines += [f"- {number_line(name, number)}" for name, number in report.model.numbers.items()]
    if report.model.assumptions:
        lines += ["", "## Assumed", "", *(f"- {sentence}" for sentence in report.model.assumptions)]
    return "\n".join(lines) + "\n"


def _table(rows: Sequence[Sequence[str]]) -> list[str]:
    head, *body = (f"| {' | '.join(cell.replace('|', chr(92) + '|') for cell in cells)} |" for cells in rows)
    return [head, "|" + "---|" * len(rows[0]), *body]
