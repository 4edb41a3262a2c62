"""Tuned gains as Markdown."""

from __future__ import annotations

from collections.abc import Sequence

from lyapcheck.tune.formats.rows import compared_rows, notes, tuned_rows
from lyapcheck.tune.gain_file import targets_text
from lyapcheck.tune.results import TUNED, TunedSet, Tuning


def render(tuning: Tuning) -> str:
    """A table a member, and one for what it is compared with."""
    head = [f"## {tuning.robot}: the largest gains within (10p) and (19)", "", f"{targets_text(tuning)}.", ""]
    blocks = [line for item in tuning.sets for line in [*_section(item, tuning.targets.digits), ""]]
    return "\n".join([*head, *blocks, *(f"- {note}" for note in notes(tuning))]).rstrip("\n") + "\n"


def _section(item: TunedSet, digits: int) -> list[str]:
    if item.status != TUNED:
        return [f"### ✗ {item.name}: {item.status}", "", *(f"- {text}" for text in item.reasons)]
    lines = [f"### ✓ {item.name}", "", *_table(tuned_rows(item, digits))]
    if item.comparison is not None:
        beside = f"Beside `{item.comparison.name}` of `{item.comparison.source}`:"
        lines += ["", beside, "", *_table(compared_rows(item.comparison))]
    return lines


def _table(rows: Sequence[Sequence[str]]) -> list[str]:
    head, *body = rows
    rule = ["---", *["---:"] * (len(head) - 1)]
    return [f"| {' | '.join(cells)} |" for cells in (head, rule, *body)]
