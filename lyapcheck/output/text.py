"""A document in a terminal: 80 columns, straight tables, colour where it is wanted."""

from __future__ import annotations

import re
from collections.abc import Iterable, Iterator, Sequence
from itertools import zip_longest
from textwrap import wrap
from unicodedata import combining, east_asian_width

from lyapcheck.output import document as doc
from lyapcheck.output.escapes import printable

WIDTH = 80
GAP = "  "
LEAST = 12
"""A column of words is not made narrower than this, nor than its longest word."""
MOST = 24
"""A longer word of a sentence in a table is broken where the column ends; a cell of one word never is."""

BOLD, DIM, GREEN, RED, YELLOW, PLAIN = (f"\x1b[{code}m" for code in (1, 2, 32, 31, 33, 0))
COLOURS = {
    **dict.fromkeys(("✓", "proved", "accepted"), GREEN),
    **dict.fromkeys(("✗", "!", "refuted", "rejected", "refused", "error"), RED),
    **dict.fromkeys(("?", "undecided"), YELLOW),
}
"""Of cells that are one of these words, and of titles that begin with one."""


def render(document: doc.Document, colour: bool = False) -> str:
    """The whole document; lines end where they must, also within words that no line could hold."""
    writer = _Writer(colour)
    lines = [writer.title(document.title, "═"), *writer.blocks(document.body)]
    return "\n".join(lines) + "\n"


class _Writer:
    """What a block comes to in lines, with or without colour."""

    def __init__(self, colour: bool) -> None:
        self.colour = colour

    def title(self, text: str, rule: str) -> str:
        lines = _wrapped(text)
        long = max(map(_width, lines), default=0)
        return "\n".join([*(self._titled(line) for line in lines), self._in(DIM, rule * long)])

    def _titled(self, line: str) -> str:
        mark, space, rest = line.partition(" ")
        return (
            f"{self._in(COLOURS[mark], mark)}{space}{self._in(BOLD, rest)}"
            if mark in COLOURS
            else self._in(BOLD, line)
        )

    def blocks(self, blocks: Iterable[doc.Block]) -> Iterator[str]:
        for block in blocks:
            yield ""
            match block:
                case doc.Paragraph(text):
                    yield from _wrapped(text)
                case doc.Bullets(items):
                    yield from self.bullets(items)
                case doc.Code(text) | doc.Equation(text):
                    yield from (f"    {printable(line)}" for line in text.splitlines())
                case doc.Figure(path, caption):
                    yield from _wrapped(f"{caption} [{path}]")
                case doc.Section(title, inner):
                    yield self.title(title, "─")
                    yield from self.blocks(inner)
                case doc.Table():
                    yield from self.table(block)

    def bullets(self, items: Iterable[str]) -> Iterator[str]:
        for item in items:
            first, *rest = _wrapped(item, WIDTH - 2) or [""]
            yield f"- {first}"
            yield from (f"  {line}" for line in rest)

    def table(self, table: doc.Table) -> Iterator[str]:
        if table.caption:
            yield from _wrapped(table.caption)
        cells = [tuple(map(printable, row)) for row in (table.heads, *table.rows)]
        natural = _natural(cells)
        if _excess(natural) <= 0:
            yield from self._sheet(cells, natural, table.align)
            return
        for number, columns in enumerate(_sheets(table, cells)):
            if number:
                yield ""
            align = "".join(table.align[i] for i in columns)
            sheet = [tuple(row[i] for i in columns) for row in cells]
            yield from self._sheet(sheet, _fitting(sheet, align), align)

    def _sheet(self, cells: Sequence[tuple[str, ...]], widths: Sequence[int], align: str) -> Iterator[str]:
        heads, *rows = cells
        yield from self._row(heads, widths, align, BOLD)
        yield self._in(DIM, GAP.join("─" * width for width in widths))
        for row in rows:
            yield from self._row(row, widths, align)

    def _row(self, row: Sequence[str], widths: Sequence[int], align: str, style: str = "") -> Iterator[str]:
        """The lines of a row: one, unless a cell is wider than its column."""
        spaces = [width - _width(cell) for cell, width in zip(row, widths, strict=True)]
        if min(spaces) >= 0:
            yield self._line(row, spaces, align, style)
            return
        stacks = [_wrapped(cell, width, broken=True) or [""] for cell, width in zip(row, widths, strict=True)]
        for line in zip_longest(*stacks, fillvalue=""):
            spaces = [width - _width(cell) for cell, width in zip(line, widths, strict=True)]
            yield self._line(line, spaces, align, style)

    def _line(self, cells: Sequence[str], spaces: Sequence[int], align: str, style: str) -> str:
        """Cells that fit, each with the spaces that fill its column."""
        if self.colour:
            cells = [self._in(style or COLOURS.get(cell, ""), cell) for cell in cells]
        parts = [
            cell + " " * space if side == "l" else " " * space + cell
            for cell, space, side in zip(cells, spaces, align, strict=True)
        ]
        return GAP.join(parts).rstrip()

    def _in(self, style: str, text: str) -> str:
        return f"{style}{text}{PLAIN}" if self.colour and style and text else text


def _sheets(table: doc.Table, cells: Sequence[Sequence[str]]) -> list[list[int]]:
    """The columns that fit side by side, the keys with each lot of them."""
    least = [_least(column, side) for column, side in zip(zip(*cells, strict=True), table.align, strict=True)]
    keys = list(range(min(table.keys, len(least))))
    used = sum(least[i] + len(GAP) for i in keys)
    sheets: list[list[int]] = [[]]
    free = WIDTH - used
    for i in range(len(keys), len(least)):
        if sheets[-1] and least[i] > free:
            sheets.append([])
            free = WIDTH - used
        sheets[-1].append(i)
        free -= least[i] + len(GAP)
    return [[*keys, *sheet] for sheet in sheets]


def _fitting(cells: Sequence[Sequence[str]], align: str) -> list[int]:
    """Widths of columns that make lines of at most `WIDTH`, where wrapping words can do it."""
    widths = _natural(cells)
    excess = _excess(widths)
    if excess <= 0:
        return widths
    least = [_least(column, side) for column, side in zip(zip(*cells, strict=True), align, strict=True)]
    while excess > 0:
        spare = [width - low for width, low in zip(widths, least, strict=True)]
        if max(spare) <= 0:
            break
        widest = max((i for i in range(len(widths)) if spare[i] > 0), key=lambda i: widths[i])
        others = [widths[i] for i in range(len(widths)) if spare[i] > 0 and widths[i] < widths[widest]]
        step = min(excess, spare[widest], max(1, widths[widest] - max(others, default=0)))
        widths[widest] -= step
        excess -= step
    return widths


def _natural(cells: Sequence[Sequence[str]]) -> list[int]:
    """The widths of columns in which no cell is wrapped."""
    return [max(map(_width, column)) for column in zip(*cells, strict=True)]


def _excess(widths: Sequence[int]) -> int:
    """By how much columns of these widths are too wide for a line."""
    return sum(widths) + len(GAP) * (len(widths) - 1) - WIDTH


def _least(column: Sequence[str], side: str) -> int:
    """The least width of a column: heads and words may be wrapped at spaces, numbers are not."""
    head, *body = column
    lowest = max(map(_width, head.split()), default=0)
    if side == "l":
        natural = max(map(_width, body), default=0)
        longest = max(map(_longest, body), default=0)
        return max(lowest, min(natural, max(longest, LEAST)))
    return max([lowest, *map(_width, body)])


def _longest(cell: str) -> int:
    """The width that the words of a cell need."""
    words = cell.split()
    longest = max(map(_width, words), default=0)
    return longest if len(words) < 2 else min(longest, MOST)


def _wrapped(text: str, width: int = WIDTH, broken: bool = False) -> list[str]:
    """The lines of a text; a word that is longer than a line stands on one of its own, or is broken."""
    shown = printable(text)
    if _width(shown) <= width:
        return [shown]
    return wrap(shown, width, break_long_words=broken, break_on_hyphens=False)


_ODD = re.compile("[^\x20-\u02ff\u0370-\u0482\u2010-\u20cf\u2100-\u22ff\u2500-\u257f✓✗]")
"""All but letters, signs and lines of which each takes one column."""


def _width(text: str) -> int:
    """How many columns a terminal needs."""
    if text.isascii() or not _ODD.search(text):
        return len(text)
    return sum(0 if combining(c) else 2 if east_asian_width(c) in "WF" else 1 for c in text)
