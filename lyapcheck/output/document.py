"""A document as data: what is said and how it is laid out, in no format yet.

All text is plain: no markup, nothing escaped. Renderers escape all of it, so a name may hold anything.
"""

from __future__ import annotations

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
        keys: how many of the first columns say what a row is about, and come again where a table that is too
            wide for a terminal goes on below.
    """

    heads: tuple[str, ...]
    rows: tuple[tuple[str, ...], ...]
    caption: str = ""
    align: str = ""
    keys: int = 1

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
    """A whole answer.

    Args:
        title: the answer in one line, the verdict first where there is one.
        blocks: what supports it.
        notes: what holds for all of it: legends, assumptions.
    """

    title: str
    blocks: tuple[Block, ...]
    notes: tuple[str, ...] = ()

    @property
    def body(self) -> tuple[Block, ...]:
        """The blocks, then the notes: under a heading where they would else belong to the last block."""
        if not self.notes:
            return self.blocks
        notes = Bullets(self.notes)
        joined = self.blocks and isinstance(self.blocks[-1], (Section, Bullets))
        return (*self.blocks, Section("Notes", (notes,)) if joined else notes)
