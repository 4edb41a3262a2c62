"""The report of an arm as Markdown."""

from __future__ import annotations

from collections.abc import Sequence

from lyapcheck.markdown import markdown_table
from lyapcheck.output.escapes import markdown_text
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
    lines = [f"# {markdown_text(headline(report))}", "", "## Properties", ""]
    lines += _words(("property", "verdict", "grade", "statement", "evidence"), claims)
    if report.prints:
        rows = [(row.verdict.value, row.statement, evidence(row)) for row in report.prints]
        lines += ["", "## As the source prints it", "", *_words(("verdict", "claim", "evidence"), rows)]
    lines += [
        "",
        "## Constants",
        "",
        "At nominal parameters, certified and numeric; for k_c the last numbers are the direction x.",
        "",
        *_words(CONSTANT_HEADS, [constant_row(report, constant) for constant in report.constants]),
    ]
    lines += ["", "## Joints", "", *_words(JOINT_HEADS, joint_rows(report)), "", "## Numbers", ""]
    lines += _list([number_line(name, number) for name, number in report.model.numbers.items()])
    if report.model.assumptions:
        lines += ["", "## Assumed", "", *_list(report.model.assumptions)]
    return "\n".join(lines) + "\n"


def _words(heads: Sequence[str], rows: Sequence[Sequence[str]]) -> list[str]:
    return markdown_table(heads, rows, words=len(heads) - 1)


def _list(sentences: Sequence[str]) -> list[str]:
    return [f"- {markdown_text(sentence)}" for sentence in sentences]
