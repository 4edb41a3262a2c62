"""The table of constants as HTML for a notebook."""

from __future__ import annotations

from lyapcheck.family.table import Table
from lyapcheck.family.table_formats.blocks import constants, notes, others
from lyapcheck.notebook import html_paragraph, html_table


def render(table: Table) -> str:
    """The constants, what was asked for beside them, and the notes."""
    parts = [html_table(block.heads, block.rows, block.title) for block in (constants(table), *others(table))]
    return "\n".join([*parts, *map(html_paragraph, notes(table))]) + "\n"
