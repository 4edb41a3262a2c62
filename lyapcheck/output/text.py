"""A document in a terminal: the headline, one table, remarks, assumptions and the next command.

Tables are never folded: in a narrow terminal they lose columns, which `-v` shows below with the keys.
"""

from __future__ import annotations

import re
from collections.abc import Callable, Iterable, Iterator, Sequence
from dataclasses import dataclass
from enum import IntEnum
from textwrap import wrap
from unicodedata import combining, east_asian_width

from lyapcheck.output import document as doc
from lyapcheck.output.escapes import printable
from lyapcheck.output.names import spelled

WIDTH, LEAST, MOST = 100, 60, 120
"""Columns where there is no terminal, and the ends of what is used of one."""
PROSE = 90
"""Sentences are not wider."""
GAP = INDENT = "  "
HEADLINE = 80 - len(INDENT)
"""Letters of a sentence of the headline, which is a line at 80 columns; what is longer is a remark."""

BOLD, DIM, GREEN, RED, YELLOW, PLAIN = (f"\x1b[{code}m" for code in (1, 2, 32, 31, 33, 0))
COLOURS = {
    **dict.fromkeys(("✓", "[ok]", "proved", "accepted"), GREEN),
    **dict.fromkeys(("✗", "[x]", "refuted", "rejected", "refused", "error"), RED),
    **dict.fromkeys(("?", "!", "undecided"), YELLOW),
}
"""Of cells that are one of these words, and of titles that begin with one."""
_NUMBER = re.compile(r"[-−]?\d+(\.\d+)?")


class Depth(IntEnum):
    """How much is shown; each level shows what the one before does, and more."""

    QUIET = 0
    """The first line."""
    SHORT = 1
    """The short answer."""
    VERBOSE = 2
    """With details."""
    EXPLAINED = 3
    """With notes."""


@dataclass(frozen=True)
class View:
    """How a document is shown.

    Args:
        depth: how much of it.
        colour: with the escape sequences of a terminal.
        width: columns; held within `LEAST` and `MOST`.
        following: the next command with the options of this one that it needs.
        encoding: what takes the text; signs that it lacks are written as names.
    """

    depth: Depth = Depth.SHORT
    colour: bool = False
    width: int = WIDTH
    following: Callable[[str], str] = str
    encoding: str = "utf-8"


def render(document: doc.Document, view: View | None = None) -> str:
    """The document as far as a view shows it; only commands and very long words pass the width."""
    writer = _Writer(view or View())
    return "\n".join(writer.lines(document)) + "\n"


class _Writer:
    def __init__(self, view: View) -> None:
        self.colour, self.depth, self.encoding = view.colour, view.depth, view.encoding
        self.width = min(max(view.width, LEAST), MOST)

    def lines(self, document: doc.Document) -> Iterator[str]:
        yield from map(self._titled, self._wrapped(document.title))
        if self.depth == Depth.QUIET:
            return
        for text in document.lead:
            yield from self._inset(text)
        yield from self.blocks(document.blocks)
        if self.depth >= Depth.VERBOSE:
            yield from self.blocks(document.details)
        if self.depth >= Depth.EXPLAINED and document.notes:
            yield from self.blocks((doc.Section("Notes", (doc.Bullets(document.notes),)),))
        if document.assumed or document.next:
            yield ""
        for text in (document.assumed, document.next and f"next: {document.next}"):
            command = "lyapcheck " in text  # stays whole, to be pasted
            lines = [INDENT + self._said(text)] if command else self._inset(text)
            yield from (self._in(DIM, line) for line in lines)

    def _titled(self, line: str) -> str:
        mark, space, rest = line.partition(" ")
        if mark not in COLOURS:
            return self._in(BOLD, line)
        return f"{self._in(COLOURS[mark], mark)}{space}{self._in(BOLD, rest)}"

    def blocks(self, blocks: Iterable[doc.Block]) -> Iterator[str]:
        for block in blocks:
            yield ""
            match block:
                case doc.Paragraph(text):
                    yield from self._wrapped(text)
                case doc.Bullets(items):
                    for item in items:
                        for number, line in enumerate(self._wrapped(item, len(INDENT))):
                            yield f"{INDENT if number else '- '}{line}"
                case doc.Equation(text, latex) if "\n" in text and any(
                    self._said(x) != x for x in text.split("\n")
                ):
                    yield f"    {self._said(latex)}"  # names would move what stands in lines above each other
                case doc.Code(text) | doc.Equation(text):
                    yield from (f"    {self._said(line)}" for line in text.splitlines())
                case doc.Figure(path, caption):
                    yield from self._wrapped(f"{caption} [{path}]")
                case doc.Section(title, inner):
                    yield from map(self._titled, self._wrapped(title))
                    yield from self.blocks(inner)
                case doc.Table():
                    yield from self.table(block)

    def table(self, table: doc.Table) -> Iterator[str]:
        if table.caption:
            yield from self._wrapped(table.caption)
        cells = [tuple(map(self._said, row)) for row in (table.heads, *table.rows)]
        columns = [
            _pointed(column) if side == "r" else column
            for column, side in zip(zip(*cells, strict=True), table.align, strict=True)
        ]
        sheets = _sheets(table, [max(map(_width, column)) for column in columns], self.width)
        for number, sheet in enumerate(sheets if self.depth >= Depth.VERBOSE else sheets[:1]):
            if number:
                yield ""
            align = "".join(table.align[i] for i in sheet)
            yield from self._sheet(self._cut([columns[i] for i in sheet], align), align)

    def _cut(self, columns: Sequence[Sequence[str]], align: str) -> list[Sequence[str]]:
        """Words cut off where a line has no room for them and nobody asked for all."""
        shown = list(columns)
        widths = [max(map(_width, column)) for column in shown]
        excess = sum(widths) + len(GAP) * (len(widths) - 1) - self.width
        words = [i for i, side in enumerate(align) if side == "l"]
        while excess > 0 and words and self.depth < Depth.VERBOSE:
            widest = max(words, key=lambda i: widths[i])
            most = max(widths[widest] - excess, 8)
            dots = self._said("…")
            cut = most - len(dots)
            shown[widest] = [x if _width(x) <= most else f"{x[:cut]}{dots}" for x in shown[widest]]
            words.remove(widest)
            excess -= widths[widest] - most
        return shown

    def _sheet(self, columns: Sequence[Sequence[str]], align: str) -> Iterator[str]:
        widths = [max(map(_width, column)) for column in columns]
        for number, row in enumerate(zip(*columns, strict=True)):
            parts = []
            for cell, width, side in zip(row, widths, align, strict=True):
                space = " " * (width - _width(cell))
                said = self._in(COLOURS.get(cell, "") if number else BOLD, cell)
                parts.append(said + space if side == "l" else space + said)
            yield GAP.join(parts).rstrip()

    def _wrapped(self, text: str, less: int = 0) -> list[str]:
        width = min(self.width, PROSE) - less
        shown = self._said(text)
        if _width(shown) <= width:
            return [shown]
        return wrap(shown, width, break_long_words=False, break_on_hyphens=False)

    def _inset(self, text: str) -> Iterator[str]:
        return (INDENT + line for line in self._wrapped(text, len(INDENT)) if line)

    def _said(self, text: str) -> str:
        return spelled(printable(text), self.encoding)

    def _in(self, style: str, text: str) -> str:
        return f"{style}{text}{PLAIN}" if self.colour and style and text else text


def _pointed(column: Sequence[str]) -> Sequence[str]:
    """Numbers with their decimal points below each other."""
    # the characters from the decimal point on; none where the cell is no plain number
    after = [len(cell) - len(cell.partition(".")[0]) if _NUMBER.fullmatch(cell) else None for cell in column]
    most = max((places for places in after if places is not None), default=0)
    return [
        cell if places is None else cell + " " * (most - places)
        for cell, places in zip(column, after, strict=True)
    ]


def _sheets(table: doc.Table, widths: Sequence[int], most: int) -> list[list[int]]:
    """The columns that fit side by side, the most important first, the keys with each lot of them."""
    keys = list(range(min(table.keys, len(widths))))
    others = [i for i in range(len(keys), len(widths)) if i not in table.drop]
    others += reversed(table.drop)
    sheets: list[list[int]] = []
    while others or not sheets:
        taken: list[int] = []
        free = most - sum(widths[i] + len(GAP) for i in keys)
        while others and (widths[others[0]] <= free or not taken):
            free -= widths[others[0]] + len(GAP)
            taken.append(others.pop(0))
        sheets.append(sorted([*keys, *taken]))
    return sheets


_ODD = re.compile("[^\x20-\u02ff\u0370-\u0482\u2010-\u20cf\u2100-\u22ff\u2500-\u257f✓✗]")
"""All but letters, signs and lines of which each takes one column."""


def _width(text: str) -> int:
    """How many columns a terminal needs."""
    if text.isascii() or not _ODD.search(text):
        return len(text)
    return sum(0 if combining(c) else 2 if east_asian_width(c) in "WF" else 1 for c in text)
