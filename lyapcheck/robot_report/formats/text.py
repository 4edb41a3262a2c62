"""The report of an arm in a terminal."""

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
    """Properties, constants, joints, every number and what is assumed."""
    lines = [headline(report), "", "Properties", ""]
    for row in report.properties:
        lines.append(f"  {row.verdict.value:<9}  {row.id}  {row.statement} [{row.finding.grade.label}]")
        lines.append(f"             {evidence(row)}")
    if report.prints:
        lines += ["", "As the source prints it", ""]
        for row in report.prints:
            lines += [f"  {row.verdict.value:<9}  {row.statement}", f"             {evidence(row)}"]
    lines += [
        "",
        "Constants at nominal parameters, certified and in floating point; for k_c the last numbers are x",
        "",
    ]
    lines += _table([CONSTANT_HEADS, *(constant_row(report, one) for one in report.constants)])
    lines += ["", "Joints", "", *_table([JOINT_HEADS, *joint_rows(report)]), "", "Numbers", ""]
    lines += [f"  {number_line(name, number)}" for name, number in report.model.numbers.items()]
    if report.model.assumptions:
        lines += ["", "Assumed", "", *(f"  {sentence}" for sentence in report.model.assumptions)]
    return "\n".join(lines) + "\n"


def _table(rows: Sequence[Sequence[str]]) -> list[str]:
    widths = [max(map(len, column)) for column in zip(*rows, strict=True)]
    return [
        "  " + "  ".join(cell.ljust(w) for cell, w in zip(cells, widths, strict=True)).rstrip()
        for cells in rows
    ]
