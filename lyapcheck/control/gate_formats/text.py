"""The gate in a terminal."""

from __future__ import annotations

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

_HEADS = ("", "condition", "joint", "value", "limit", "margin", "largest admissible")


def render(results: Sequence[GateResult]) -> str:
    """One block a gain set, what to change under it, and a last line that counts."""
    blocks = [_block(result) for result in results]
    return "\n".join([*blocks, *_legend(results), _summary(results)]) + "\n"


def _block(result: GateResult) -> str:
    title = f"{SYMBOLS[result.verdict]} {printable(result.name)}: {result.verdict}"
    about = f"m = {result.m}" if result.m is not None else result.gains.family
    rows = [_HEADS, *(_row(result, check) for check in result.checks)]
    widths = [max(len(row[i]) for row in rows) for i in range(len(_HEADS))]
    lines = [
        "   ".join(cell.ljust(width) for cell, width in zip(row, widths, strict=True)).rstrip()
        for row in rows
    ]
    failures = [f"  → {printable(advice(result, check))}" for check in result.failures]
    return "\n".join(
        [
            f"{title}  ({about}, {printable(result.file.path)})",
            *(f"  {line}" for line in lines),
            *failures,
            "",
        ]
    )


def _row(result: GateResult, check: Check) -> tuple[str, ...]:
    shown = check.id if check.id in result.deciding else f"{check.id} *"
    return (
        SYMBOLS[check.verdict],
        shown,
        printable(joint_name(result, check)),
        decimal_text(check.value),
        limit_text(check),
        margin_text(check),
        largest_text(check),
    )


def _legend(results: Sequence[GateResult]) -> list[str]:
    shown = dict.fromkeys(check.id for result in results for check in result.checks)
    lines = [f"({name})".ljust(6) + RULES[name] for name in shown]
    if any(check.id not in result.deciding for result in results for check in result.checks):
        lines.append("*     shown, but does not decide; --condition chooses what does")
    assumptions = dict.fromkeys(text for result in results for text in result.limits.assumptions)
    return [*lines, *(f"assumed: {printable(text)}" for text in assumptions), ""]


def _summary(results: Sequence[GateResult]) -> str:
    counts = {verdict: sum(result.verdict == verdict for result in results) for verdict in SYMBOLS}
    return ", ".join(f"{count} {verdict}" for verdict, count in counts.items() if count)
