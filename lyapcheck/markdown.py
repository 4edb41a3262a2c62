"""Text of users as Markdown that shows it, and tables of it."""

from __future__ import annotations

import re
from collections.abc import Sequence

from lyapcheck.files.printable import printable

_ENTITIES = {"&": "&amp;", "<": "&lt;", ">": "&gt;"}
_MEANT = re.compile(r"[\\`*\[\]|~#!@&<>]|:(?=\S)|(?<![^\W_])_|_(?![^\W_])")
"""What Markdown would take for its own; an underscore within a word is none."""


def markdown_text(text: str) -> str:
    """The text as Markdown that shows it, on one line."""
    return _MEANT.sub(lambda found: _ENTITIES.get(found[0], f"\\{found[0]}"), printable(text))


def markdown_table(heads: Sequence[str], rows: Sequence[Sequence[str]]) -> list[str]:
    """The lines of a table of plain text: the first column to the left, numbers to the right."""
    rule = f"| {' | '.join(['---', *['---:'] * (len(heads) - 1)])} |"
    first, *others = (f"| {' | '.join(map(markdown_text, cells))} |" for cells in (heads, *rows))
    return [first, rule, *others]
