"""Tuned gains as HTML for a notebook."""

from __future__ import annotations

from collections.abc import Sequence

from lyapcheck.notebook import html_paragraph, html_table
from lyapcheck.tune.formats.rows import compared_rows, notes, tuned_rows
from lyapcheck.tune.gain_file import targets_text
from lyapcheck.tune.results import TUNED, TunedSet, Tuning


def render(tuning: Tuning) -> str:
    """A table a member, one for what it is compared with, and what it all rests on."""
    head = f"{tuning.robot}: the largest gains within (10p) and (19), {targets_text(tuning)}"
    blocks = [part for item in tuning.sets for part in _set(item, tuning.targets.digits)]
    return "\n".join([html_paragraph(head), *blocks, *map(html_paragraph, notes(tuning))]) + "\n"


def _set(item: TunedSet, digits: int) -> list[str]:
    if item.status != TUNED:
        return [html_paragraph(f"✗ {item.name}: {text}") for text in item.reasons]
    parts = [_table(tuned_rows(item, digits), f"✓ {item.name} (m = {item.m}), N·m")]
    if item.comparison is not None:
        beside = f"Beside {item.comparison.name} of {item.comparison.source}"
        parts.append(_table(compared_rows(item.comparison), beside))
    return parts


def _table(rows: Sequence[Sequence[str]], caption: str) -> str:
    head, *body = rows
    return html_table(head, body, caption)
