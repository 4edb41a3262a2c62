"""Tuned gains as Markdown."""

from __future__ import annotations

from collections.abc import Sequence

from lyapcheck.markdown import markdown_table
from lyapcheck.output.escapes import markdown_text
from lyapcheck.tune.formats.rows import compared_rows, notes, tuned_rows
from lyapcheck.tune.gain_file import targets_text
from lyapcheck.tune.results import TUNED, TunedSet, Tuning


def render(tuning: Tuning) -> str:
    """A table a member, and one for what it is compared with."""
    head = f"## {markdown_text(tuning.robot)}: the largest gains within (10p) and (19)"
    blocks = [line for item in tuning.sets for line in [*_section(item, tuning.targets.digits), ""]]
    below = [f"- {markdown_text(note)}" for note in notes(tuning)]
    return "\n".join([head, "", f"{targets_text(tuning)}.", "", *blocks, *below]).rstrip("\n") + "\n"


def _section(item: TunedSet, digits: int) -> list[str]:
    if item.status != TUNED:
        reasons = [f"- {markdown_text(text)}" for text in item.reasons]
        return [f"### ✗ {markdown_text(item.name)}: {item.status}", "", *reasons]
    lines = [f"### ✓ {markdown_text(item.name)}", "", *_table(tuned_rows(item, digits))]
    if item.comparison is not None:
        name, source = map(markdown_text, (item.comparison.name, item.comparison.source))
        lines += ["", f"Beside {name} of {source}:", "", *_table(compared_rows(item.comparison))]
    return lines


def _table(rows: Sequence[Sequence[str]]) -> list[str]:
    return markdown_table(rows[0], rows[1:])
