"""A document as a piece of HTML, for a notebook or a page."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Iterator, Sequence
from urllib.parse import quote

from lyapcheck.output import document as doc
from lyapcheck.output.escapes import html_text
from lyapcheck.output.mathml import Markup, element
from lyapcheck.output.mathml import latex as formula

_SIDES = {"l": "left", "r": "right"}
Drawn = Callable[[doc.Figure], Markup | None]


def linked(figure: doc.Figure) -> Markup:
    """A figure as a link to its file."""
    image = element("img", src=quote(figure.path), alt=figure.caption)
    return element("figure", image, element("figcaption", figure.caption))


def render(document: doc.Document, level: int = 2) -> str:
    """The whole document, its title a heading of a level; no script, no style sheet needed."""
    lines = [element(f"h{level}", document.title), *blocks(document.body, level + 1)]
    return "\n".join(lines) + "\n"


def blocks(result: Iterable[doc.Block], level: int, drawn: Drawn = linked) -> Iterator[Markup]:
    """Blocks one after the other.

    Args:
        drawn: what becomes of a figure.
    """
    for block in result:
        match block:
            case doc.Paragraph(text):
                yield element("p", text)
            case doc.Bullets(items):
                yield Markup("<ul>")
                yield from (element("li", item) for item in items)
                yield Markup("</ul>")
            case doc.Equation(_, latex):
                yield formula(latex)
            case doc.Code(text):
                shown = Markup("\n".join(map(html_text, text.splitlines())))
                yield element("pre", element("code", shown))
            case doc.Figure():
                if (shape := drawn(block)) is not None:
                    yield shape
            case doc.Section(title, inner):
                yield element(f"h{min(level, 6)}", title)
                yield from blocks(inner, level + 1, drawn)
            case doc.Table():
                yield Markup("<table>")
                if block.caption:
                    yield element("caption", block.caption)
                heads = [
                    element("th", head, style=_side(side), scope="col")
                    for head, side in zip(block.heads, block.align, strict=True)
                ]
                yield element("thead", element("tr", heads))
                yield Markup("<tbody>")
                yield from (element("tr", _cells(row, block)) for row in block.rows)
                yield from (Markup("</tbody>"), Markup("</table>"))


def _cells(row: Sequence[str], table: doc.Table) -> Iterator[Markup]:
    for cell, head, side in zip(row, table.heads, table.align, strict=True):
        yield element("td", cell, style=_side(side), data_label=head)


def _side(side: str) -> str:
    return f"text-align:{_SIDES[side]}"
