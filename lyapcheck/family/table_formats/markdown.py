"""The table of constants as Markdown."""

from __future__ import annotations

from collections.abc import Iterable

from lyapcheck.family.table import Table
from lyapcheck.family.table_formats.blocks import Block, constants, notes, others
from lyapcheck.files.printable import printable


def render(table: Table) -> str:
    """One table of constants, one for each thing asked for beside them; all digits correct."""
    lines = _table(constants(table))
    for block in others(table):
        lines += ["", printable(block.title), "", *_table(block)]
    return "\n".join([*lines, "", *notes(table)]) + "\n"


def _table(block: Block) -> list[str]:
    rule = ["---:"] * len(block.heads)
    return [_piped(map(_cell, block.heads)), _piped(rule), *map(_piped, block.rows)]


def _cell(name: str) -> str:
    return printable(name).replace("|", "\\|").replace("<", "&lt;")


def _piped(cells: Iterable[str]) -> str:
    return f"| {' | '.join(cells)} |"
