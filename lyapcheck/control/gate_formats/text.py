"""The gate in a terminal."""

from __future__ import annotations

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

_HEADS = ("", "condition", "joint", "value", "limit", "margin", "largest admissible")


def render(results: Sequence[GateResult]) -> str:
    """One block a gain set, what to change under it, and a last line that counts."""
    blocks = [_block(result) for result in results]
    return "\n".join([*blocks, *_legend(results), _summary(results)]) + "\n"


def _block(result: GateResult) -> str:
    verdict, path = result.verdict, printable(result.file.path)
    title = f"{SYMBOLS[verdict]} {printable(result.name)}: {verdict}  ({about(result)}, {path})"
    rows = [_HEADS, *[_row(result, check) for check in result.checks]]
    widths = [max(map(len, column)) for column in zip(*rows, strict=True)]
    lines = ["  " + "   ".join(map(str.ljust, row, widths)).rstrip() for row in rows]
    failures = [f"  → {printable(advice(result, check))}" for check in result.failures]
    noted = [f"  ! {printable(remark)}" for remark in remarks(result)]
    return "\n".join([title, *lines, *failures, *noted, ""])


def _row(result: GateResult, check: Check) -> tuple[str, ...]:
    return (
        SYMBOLS[check.verdict],
        check.id if check.id in result.deciding else f"{check.id} *",
        printable(joint_name(result, check)),
        value_text(check),
        limit_text(check),
        margin_text(check),
        largest_text(check),
    )


def _legend(results: Sequence[GateResult]) -> list[str]:
    shown = dict.fromkeys([check.id for result in results for check in result.checks])
    lines = [f"({name})".ljust(6) + ("  " if len(name) > 3 else "") + RULES[name] for name in shown]
    deciding = {name for result in results for name in result.deciding}
    if any(name not in deciding for name in shown):
        lines.append("*     shown, but does not decide; --condition chooses what does")
    assumptions = dict.fromkeys([text for result in results for text in result.limits.assumptions])
    return [*lines, *[f"assumed: {printable(text)}" for text in assumptions], ""]


def _summary(results: Sequence[GateResult]) -> str:
    verdicts = [result.verdict for result in results]
    counts = {verdict: verdicts.count(verdict) for verdict in SYMBOLS}
    return ", ".join([f"{count} {verdict}" for verdict, count in counts.items() if count])
