"""The gate as Markdown, for a pull request or a step summary."""

from __future__ import annotations

from lyapcheck.gating.formats.words import (
    RULES,
    SYMBOLS,
    about,
    advice,
    joint_name,
    largest_text,
    limit_text,
    margin_text,
    value_text,
)
from lyapcheck.gating.stability import remarks
from lyapcheck.output.escapes import markdown_text

TYPE_CHECKING = False
if TYPE_CHECKING:
    from collections.abc import Sequence

    from lyapcheck.control.conditions import Check
    from lyapcheck.gating.gate import GateResult


def render(results: Sequence[GateResult]) -> str:
    """A table a gain set, and what to change."""
    return "\n".join(_section(result) for result in results)


def _section(result: GateResult) -> str:
    lines = [
        f"### {SYMBOLS[result.verdict]} {markdown_text(result.name)} ({about(result)}): {result.verdict}",
        "",
        "| | condition | joint | value | limit | margin | largest admissible |",
        "|---|---|---|---:|---:|---:|---:|",
        *(_row(result, check) for check in result.checks),
        "",
        *(f"- {markdown_text(advice(result, check))}" for check in result.failures),
        *(f"- {markdown_text(remark)}" for remark in remarks(result)),
    ]
    return "\n".join(lines) + "\n"


def _row(result: GateResult, check: Check) -> str:
    note = "" if check.id in result.deciding else " (does not decide)"
    cells = (
        SYMBOLS[check.verdict],
        f"({check.id}) {markdown_text(RULES[check.id])}{note}",
        markdown_text(joint_name(result, check)),
        value_text(check),
        limit_text(check),
        margin_text(check),
        largest_text(check),
    )
    return f"| {' | '.join(cells)} |"
