"""The gate as HTML for a notebook."""

from __future__ import annotations

from collections.abc import Sequence

from lyapcheck.gating.formats.rows import HEADS, legend, row, sentences, summary, title
from lyapcheck.gating.gate import GateResult
from lyapcheck.notebook import html_paragraph, html_table


def render(results: Sequence[GateResult]) -> str:
    """A table a gain set, what to change under it, and what it all rests on."""
    blocks = [part for result in results for part in _block(result)]
    notes = [*legend(results), summary(results)]
    return "\n".join([*blocks, *map(html_paragraph, notes)]) + "\n"


def _block(result: GateResult) -> list[str]:
    rows = [row(result, check) for check in result.checks]
    return [html_table(HEADS, rows, title(result)), *map(html_paragraph, sentences(result))]
