"""A document as Markdown, for a pull request or a step summary."""

from __future__ import annotations

import re
from collections.abc import Iterable, Iterator, Sequence
from urllib.parse import quote

from lyapcheck.output import document as doc
from lyapcheck.output.escapes import markdown_text, printable


def render(document: doc.Document, level: int = 1) -> str:
    """The whole document, its title a heading of a level."""
    lines = [f"{'#' * level} {markdown_text(document.title)}", *_blocks(document.body, level + 1)]
    return "\n".join(lines) + "\n"


def _blocks(blocks: Iterable[doc.Block], level: int) -> Iterator[str]:
    for block in blocks:
        yield ""
        match block:
            case doc.Paragraph(text):
                yield markdown_text(text)
            case doc.Bullets(items):
                yield from (f"- {markdown_text(item)}" for item in items)
            case doc.Code(text):
                yield from _fenced(text)
            case doc.Equation(_, latex):
                yield from _fenced(latex, "math")
            case doc.Figure(path, caption):
                yield from (f"![{markdown_text(caption)}]({quote(path)})", "", markdown_text(caption))
            case doc.Section(title, inner):
                yield f"{'#' * min(level, 6)} {markdown_text(title)}"
                yield from _blocks(inner, level + 1)
            case doc.Table():
                if block.caption:
                    yield from (markdown_text(block.caption), "")
                yield _row(block.heads)
                yield f"| {' | '.join('---' if side == 'l' else '---:' for side in block.align)} |"
                yield from map(_row, block.rows)


def _fenced(text: str, language: str = "") -> Iterator[str]:
    """Lines between fences longer than any in them; indented lines would go on a list that stands before."""
    fence = "`" * max(3, *(len(run) + 1 for run in re.findall("`+", text)), 3)
    yield f"{fence}{language}"
    yield from map(printable, text.splitlines())
    yield fence


def _row(cells: Sequence[str]) -> str:
    return f"| {' | '.join(map(markdown_text, cells))} |"
