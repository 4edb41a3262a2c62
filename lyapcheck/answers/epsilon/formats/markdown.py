"""The four ε₀ as Markdown."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING

from lyapcheck.admissible.formats.words import heads, notes, remarks, row
from lyapcheck.markdown import markdown_table
from lyapcheck.output.escapes import markdown_text

if TYPE_CHECKING:
    from lyapcheck.admissible import EpsilonResult


def render(results: Sequence[EpsilonResult], seconds: Sequence[float] | None = None) -> str:
    """A table with a row a gain set, what follows from each, and what is assumed."""
    times = seconds if seconds is not None else [None] * len(results)
    rows = [row(result, time) for result, time in zip(results, times, strict=True)]
    top = heads(seconds)
    lines = markdown_table(top, rows, words=len(top) - 1)
    for result in results:
        said = [f"- {markdown_text(remark)}" for remark in remarks(result)]
        lines += ["", f"**{markdown_text(result.name)}**", "", *said]
    return "\n".join([*lines, "", *(f"- {markdown_text(note)}" for note in notes(results))]) + "\n"
