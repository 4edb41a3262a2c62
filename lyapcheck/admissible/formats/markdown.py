"""The four ε₀ as Markdown."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING

from lyapcheck.admissible.formats.words import heads, notes, remarks, row

if TYPE_CHECKING:
    from lyapcheck.admissible import EpsilonResult


def render(results: Sequence[EpsilonResult], seconds: Sequence[float] | None = None) -> str:
    """A table with a row a gain set, what follows from each, and what is assumed."""
    times = seconds if seconds is not None else [None] * len(results)
    top = heads(seconds)
    lines = [_row(top), _row(["---"] * len(top))]
    lines += [_row(row(result, time)) for result, time in zip(results, times, strict=True)]
    for result in results:
        lines += ["", f"**{result.name}**", "", *(f"- {remark}" for remark in remarks(result))]
    return "\n".join([*lines, "", *(f"- {note}" for note in notes(results))]) + "\n"


def _row(cells: Sequence[str]) -> str:
    return "| " + " | ".join(cells) + " |"
