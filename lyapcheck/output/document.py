"""A document as data: what is said and how it is laid out, in no format yet.

All text is plain: no markup, nothing escaped. Renderers escape all of it, so a name may hold anything.
"""

from __future__ import annotations

import shlex
from dataclasses import dataclass


@dataclass(frozen=True)
class Paragraph:
    """One paragraph."""

    text: str


@dataclass(frozen=True)
class Bullets:
    """A list of sentences."""

    items: tuple[str, ...]


@dataclass(frozen=True)
class Code:
    """Lines that are shown as they are: a command, a file."""

    text: str


@dataclass(frozen=True)
class Equation:
    """A formula on lines of its own.

    Args:
        text: the formula in letters and signs, of several lines where it needs them.
        latex: the same in LaTeX, one expression; made by lyapcheck, never from a user's text.
    """

    text: str
    latex: str


@dataclass(frozen=True)
class Figure:
    """A drawing in a file beside the document.

    Args:
        path: of the file, from the folder of the document.
        caption: what it shows.
    """

    path: str
    caption: str


@dataclass(frozen=True)
class Table:
    """A table.

    Args:
        heads: of the columns.
        rows: cells of text, as many in each row as there are heads.
        caption: what it shows, where that is not plain from its place.
        align: a letter a column, ``l`` for words, ``r`` for numbers; words in the first column and numbers in
            the others if empty.
        keys: how many of the first columns say what a row is about; these are always shown.
        drop: columns that a narrow terminal leaves out first, in that order; then those on the right go.
    """

    heads: tuple[str, ...]
    rows: tuple[tuple[str, ...], ...]
    caption: str = ""
    align: str = ""
    keys: int = 1
    drop: tuple[int, ...] = ()

    def __post_init__(self) -> None:
        if not self.align:
            object.__setattr__(self, "align", ("l" + "r" * len(self.heads))[: len(self.heads)])
        widths = {len(self.align), len(self.heads), *map(len, self.rows)}
        if len(widths) > 1:
            raise ValueError(f"a table with rows of different lengths: {sorted(widths)}")


@dataclass(frozen=True)
class Section:
    """A heading with what stands under it."""

    title: str
    blocks: tuple[Block, ...]


Block = Paragraph | Bullets | Code | Equation | Figure | Table | Section


@dataclass(frozen=True)
class Document:
    """A whole answer: the short one that everybody reads, and what `-v` and `--explain` add in a terminal.

    Args:
        title: the answer in one line, true for the file as given, the verdict first where there is one.
        blocks: the table and at most three remarks; a report has sections and figures.
        notes: legends and what holds for all of it: `--explain`.
        lead: at most two more lines of the headline.
        details: formulas, methods, conditions that do not decide: `-v`.
        assumed: the one line about assumptions.
        next: one command that can be pasted.
    """

    title: str
    blocks: tuple[Block, ...] = ()
    notes: tuple[str, ...] = ()
    lead: tuple[str, ...] = ()
    details: tuple[Block, ...] = ()
    assumed: str = ""
    next: str = ""

    @property
    def body(self) -> tuple[Block, ...]:
        """All but the title, in the order of the page; notes under a heading if they follow a list."""
        lead, assumed = ([Paragraph(text) for text in part if text] for part in (self.lead, [self.assumed]))
        blocks = (*lead, *self.blocks, *self.details, *assumed, *([Code(self.next)] if self.next else []))
        if not self.notes:
            return blocks
        notes = Bullets(self.notes)
        joined = blocks and isinstance(blocks[-1], (Section, Bullets, Code))
        return (*blocks, Section("Notes", (notes,)) if joined else notes)


def command(*words: object) -> str:
    """A command line of lyapcheck that can be pasted into a shell."""
    return shlex.join(["lyapcheck", *map(str, words)])
