"""The gate as Markdown, for a pull request or a step summary."""

from __future__ import annotations

import re
from collections.abc import Sequence

from lyapcheck.control.conditions import Check
from lyapcheck.control.gate import GateResult
from lyapcheck.control.gate_formats.words import (
    RULES,
    SYMBOLS,
    advice,
    joint_name,
    largest_text,
    limit_text,
    margin_text,
)
from lyapcheck.files import decimal_text, printable

_ENTITIES = {"&": "&amp;", "<": "&lt;", ">": "&gt;"}
_MEANT = re.compile(r"[\\`*\[\]|~#!:@&<>]|(?<![^\W_])_|_(?![^\W_])")
"""What Markdown would take for its own; an underscore within a word is none."""


def render(results: Sequence[GateResult]) -> str:
    """A table a gain set, and what to change."""
    return "\n".join(_section(result) for result in results)


def _section(result: GateResult) -> str:
    about = f"m = {result.m}" if result.m is not None else result.gains.family
    lines = [
        f"### {SYMBOLS[result.verdict]} {_escaped(result.name)} ({about}): {result.verdict}",
        "",
        "| | condition | joint | value | limit | margin | largest admissible |",
        "|---|---|---|---:|---:|---:|---:|",
        *(_row(result, check) for check in result.checks),
        "",
        *(f"- {_escaped(advice(result, check))}" for check in result.failures),
    ]
    return "\n".join(lines) + "\n"


def _row(result: GateResult, check: Check) -> str:
    note = "" if check.id in result.deciding else " (does not decide)"
    cells = (
        SYMBOLS[check.verdict],
        f"({check.id}) {_escaped(RULES[check.id])}{note}",
        _escaped(joint_name(result, check)),
        decimal_text(check.value),
        limit_text(check),
        margin_text(check),
        largest_text(check),
    )
    return f"| {' | '.join(cells)} |"


def _escaped(text: str) -> str:
    """The text as Markdown that shows it, on one line."""
    return _MEANT.sub(lambda found: _ENTITIES.get(found[0], f"\\{found[0]}"), printable(text))
