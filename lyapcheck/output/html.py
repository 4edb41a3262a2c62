"""A document as a piece of HTML, for a notebook or a page."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Sequence

from lyapcheck.output.document import Block, Bullets, Code, Document, Paragraph, Section, Table
from lyapcheck.output.escapes import html_text

_SIDES = {"l": "left", "r": "right"}


def render(document: Document, level: int = 2) -> str:
    """The whole document, its title a heading of a level; no script, no style sheet needed."""
    lines = [_element(f"h{level}", document.title), *_blocks(document.body, level + 1)]
    return "\n".join(lines) + "\n"


def _blocks(blocks: Iterable[Block], level: int) -> Iterator[str]:
    for block in blocks:
        yield from _block(block, level)


def _block(block: Block, level: int) -> Iterator[str]:
    match block:
        case Paragraph(text):
            yield _element("p", text)
        case Bullets(items):
            yield from _bullets(items)
        case Code(text):
            shown = "\n".join(map(html_text, text.splitlines()))
            yield f"<pre><code>{shown}</code></pre>"
        case Section(title, blocks):
            yield _element(f"h{min(level, 6)}", title)
            yield from _blocks(blocks, level + 1)
        case Table():
            yield from _table(block)


def _bullets(items: Iterable[str]) -> Iterator[str]:
    yield "<ul>"
    yield from (_element("li", item) for item in items)
    yield "</ul>"


def _table(table: Table) -> Iterator[str]:
    yield "<table>"
    if table.caption:
        yield _element("caption", table.caption)
    yield f"<thead><tr>{_cells('th', table.heads, table.align)}</tr></thead>"
    yield "<tbody>"
    yield from (f"<tr>{_cells('td', row, table.align)}</tr>" for row in table.rows)
    yield from ("</tbody>", "</table>")


def _cells(name: str, cells: Sequence[str], align: str) -> str:
    return "".join(
        f'<{name} style="text-align:{_SIDES[side]}">{html_text(cell)}</{name}>'
        for cell, side in zip(cells, align, strict=True)
    )


def _element(name: str, text: str) -> str:
    return f"<{name}>{html_text(text)}</{name}>"
