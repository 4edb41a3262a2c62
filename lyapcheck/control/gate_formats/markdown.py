"""The gate as Markdown, for a pull request or a step summary."""

from __future__ import annotations

import re

from lyapcheck.control.gate_formats.words import (
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
from lyapcheck.control.stability import remarks
from lyapcheck.files.printable import printable

TYPE_CHECKING = False
if TYPE_CHECKING:
    from collections.abc import Sequence

    from lyapcheck.control.conditions import Check
    from lyapcheck.control.gate import GateResult

_ENTITIES = {"&": "&amp;", "<": "&lt;", ">": "&gt;"}
_MEANT = re.compile(r"[\\`*\[\]|~#!:@&<>]|(?<![^\W_])_|_(?![^\W_])")
"""What Markdown would take for its own; an underscore within a word is none."""


def render(results: Sequence[GateResult]) -> str:
    """A table a gain set, and what to change."""
    return "\n".join(_section(result) for result in results)


def _section(result: GateResult) -> str:
    lines = [
        f"### {SYMBOLS[result.verdict]} {_escaped(result.name)} ({about(result)}): {result.verdict}",
        "",
        "| | condition | joint | value | limit | margin | largest admissible |",
        "|---|---|---|---:|---:|---:|---:|",
        *(_row(result, check) for check in result.checks),
        "",
        *(f"- {_escaped(advice(result, check))}" for check in result.failures),
        *(f"- {_escaped(remark)}" for remark in remarks(result)),
    ]
    return "\n".join(lines) + "\n"


def _row(result: GateResult, check: Check) -> str:
    note = "" if check.id in result.deciding else " (does not decide)"
    cells = (
        SYMBOLS[check.verdict],
        f"({check.id}) {_escaped(RULES[check.id])}{note}",
        _escaped(joint_name(result, check)),
        value_text(check),
        limit_text(check),
        margin_text(check),
        largest_text(check),
    )
    return f"| {' | '.join(cells)} |"


def _escaped(text: str) -> str:
    """The text as Markdown that shows it, on one line."""
    return _MEANT.sub(lambda found: _ENTITIES.get(found[0], f"\\{found[0]}"), printable(text))
