"""The gate as GitHub annotations, at the line and column of the gain."""

from __future__ import annotations

from lyapcheck.gating.formats.words import KEYS, advice
from lyapcheck.gating.stability import remarks
from lyapcheck.output.escapes import github_property, github_text

TYPE_CHECKING = False
if TYPE_CHECKING:
    from collections.abc import Sequence

    from lyapcheck.control.conditions import Check
    from lyapcheck.gating.gate import GateResult


def render(results: Sequence[GateResult]) -> str:
    """``::error …`` for each failed check, ``::warning …`` for an undecided one, notices for the rest.

    The rest: what the conditions say about each other, and how many sets passed.
    """
    lines = [_annotation(result, check) for result in results for check in result.failures]
    lines += [_notice(result, remark) for result in results for remark in remarks(result)]
    passed = sum(result.verdict == "accepted" for result in results)
    return (
        "\n".join([*lines, f"::notice title=lyapcheck gate::{passed} of {len(results)} gain sets accepted"])
        + "\n"
    )


def _annotation(result: GateResult, check: Check) -> str:
    level = "error" if result.failed(check) else "warning"
    place = result.file.place(result.gains, KEYS[check.id], check.joint)
    where = "" if place is None else f",line={place.line},col={place.column}"
    file, title = github_property(result.file.path), github_property(f"{result.name}: {check.verdict}")
    return f"::{level} file={file}{where},title={title}::{github_text(advice(result, check))}"


def _notice(result: GateResult, remark: str) -> str:
    place = result.file.place(result.gains)
    where = "" if place is None else f",line={place.line},col={place.column}"
    file, title = github_property(result.file.path), github_property(result.name)
    return f"::notice file={file}{where},title={title}::{github_text(remark)}"
