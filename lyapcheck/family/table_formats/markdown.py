"""The table of constants as Markdown."""

from __future__ import annotations

from lyapcheck.escapes import markdown_text
from lyapcheck.family.table import Table
from lyapcheck.family.table_formats.blocks import constants, notes, others
from lyapcheck.markdown import markdown_table


def render(table: Table) -> str:
    """One table of constants, one for each thing asked for beside them; all digits correct."""
    block = constants(table)
    lines = markdown_table(block.heads, block.rows)
    for block in others(table):
        lines += ["", markdown_text(block.title), "", *markdown_table(block.heads, block.rows)]
    return "\n".join([*lines, "", *notes(table)]) + "\n"
