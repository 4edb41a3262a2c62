"""The table of constants in a terminal."""

from __future__ import annotations

from collections.abc import Sequence

from lyapcheck.family.table import Table
from lyapcheck.family.table_formats.blocks import Block, notes, others, places, values
from lyapcheck.files.printable import printable

LEGEND = (
    "Constants of h_m(x) = sinh^(2m-1)x cosh x / (1 + sinh^(2m)x), certified.\n"
    "γ = sup h_m   ρ = sup |h_m'|   L = sup h_m(x)/x.   Digits are cut off, not rounded."
)


def render(table: Table) -> str:
    """Blocks of aligned columns: the constants, where each is reached, and what else was asked for."""
    blocks = [LEGEND]
    for block in (values(table), places(table), *others(table)):
        blocks += [printable(block.title)] if block.title else []
        blocks.append(_aligned(block))
    return "\n\n".join([*blocks, "\n".join(notes(table))]) + "\n"


def _aligned(block: Block) -> str:
    heads = [printable(head) for head in block.heads]
    widths = [max(map(len, column)) for column in zip(heads, *block.rows, strict=True)]
    lines = [_padded(heads, widths), "  ".join("─" * width for width in widths)]
    return "\n".join(lines + [_padded(row, widths) for row in block.rows])


def _padded(cells: Sequence[str], widths: Sequence[int]) -> str:
    first, *rest = zip(cells, widths, strict=True)
    return "  ".join([first[0].rjust(first[1]), *(cell.ljust(width) for cell, width in rest)]).rstrip()
