"""The gate's results as rows of text, for a terminal and for a notebook."""

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

TYPE_CHECKING = False
if TYPE_CHECKING:
    from collections.abc import Sequence

    from lyapcheck.control.conditions import Check
    from lyapcheck.gating.gate import GateResult

HEADS = ("", "condition", "joint", "value", "limit", "margin", "largest admissible")


def title(result: GateResult) -> str:
    """The gain set, its verdict and where it is from."""
    verdict = result.verdict
    return f"{SYMBOLS[verdict]} {result.name}: {verdict}  ({about(result)}, {result.file.path})"


def row(result: GateResult, check: Check) -> tuple[str, ...]:
    """One check; a star for one that does not decide."""
    return (
        SYMBOLS[check.verdict],
        check.id if check.id in result.deciding else f"{check.id} *",
        joint_name(result, check),
        value_text(check),
        limit_text(check),
        margin_text(check),
        largest_text(check),
    )


def sentences(result: GateResult) -> list[str]:
    """What to change, and what the conditions say about each other."""
    changes = [f"→ {advice(result, check)}" for check in result.failures]
    return [*changes, *[f"! {remark}" for remark in remarks(result)]]


def legend(results: Sequence[GateResult]) -> list[str]:
    """What the conditions say, and what the numbers rest on."""
    shown = dict.fromkeys([check.id for result in results for check in result.checks])
    lines = [f"({name})".ljust(6) + ("  " if len(name) > 3 else "") + RULES[name] for name in shown]
    deciding = {name for result in results for name in result.deciding}
    if any(name not in deciding for name in shown):
        lines.append("*     shown, but does not decide; --condition chooses what does")
    assumptions = dict.fromkeys([text for result in results for text in result.limits.assumptions])
    return [*lines, *[f"assumed: {text}" for text in assumptions]]


def summary(results: Sequence[GateResult]) -> str:
    """How many sets got which verdict."""
    verdicts = [result.verdict for result in results]
    counts = {verdict: verdicts.count(verdict) for verdict in SYMBOLS}
    return ", ".join([f"{count} {verdict}" for verdict, count in counts.items() if count])
