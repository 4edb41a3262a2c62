"""The report on paper: typeset by Typst, which needs no browser.

All text is in string literals, in which nothing but the quote and the backslash has a meaning.
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from pathlib import Path

from lyapcheck.errors import argument_error
from lyapcheck.output import document as doc
from lyapcheck.output.escapes import printable
from lyapcheck.process_tree import temporary_folder
from lyapcheck.report.document import ReportAnswer
from lyapcheck.report.model import Report

LAYOUT = """#set document(title: {title}, date: none)
#set page(paper: "a4", margin: (x: 17mm, top: 18mm, bottom: 15mm), numbering: "1 / 1",
  header: context if counter(page).get().first() > 1 {{ text(8pt, fill: gray.darken(40%))[#{running}] }})
#set text(font: ("Libertinus Serif", "New Computer Modern", "DejaVu Sans Mono"), size: 9.2pt, lang: "en")
#set par(justify: false, leading: 0.55em, spacing: 0.7em)
#set list(spacing: 0.45em)
#show heading: set block(above: 1.1em, below: 0.55em, sticky: true)
#show heading.where(level: 1): set text(15pt)
#show heading.where(level: 2): set text(12pt)
#show heading.where(level: 3): set text(10pt)
#show raw: set text(8pt)
#show figure.caption: set text(8pt)
#set table(inset: (x: 4pt, y: 2.6pt), stroke: (x, y) => (bottom: 0.4pt + gray))
#show table.cell: set text(8.2pt)
#show table.cell.where(y: 0): strong
"""
SIDES = {"l": "left", "r": "right"}
WIDE = 9
"""A column of words that is longer than this many characters shares the width that others leave."""


def require_typst() -> None:
    """Refuse before any work what could not be written at its end.

    Raises:
        InputError: the typesetter is not installed.
    """
    try:
        import typst  # noqa: F401
    except ImportError as error:
        repair = "install it with: pip install lyapcheck[pdf]"
        raise argument_error("--format", "pdf", "needs the package typst", repair) from error


def render(report: Report, appendix: bool = False) -> bytes:
    """A PDF of a few pages; the same report gives the same bytes.

    Args:
        appendix: whether claims, gate and runs follow one by one.
    """
    import typst

    document = ReportAnswer(report, appendix).document()
    running = document.title if report.own else f"{document.title} · {report.notes.paper.source}"
    with temporary_folder() as folder:
        source = Path(folder, "report.typ")
        source.write_text(markup(document, running), encoding="utf-8")
        for name, drawing in report.figures.items():
            path = Path(folder, "figures", name)
            path.parent.mkdir(exist_ok=True)
            path.write_text(drawing, encoding="utf-8")
        pages = typst.compile(str(source), root=folder, ignore_system_fonts=True)
    assert isinstance(pages, bytes)
    return pages


def markup(document: doc.Document, running: str) -> str:
    """The whole document.

    Args:
        document: what is said; figures are files beside the document.
        running: what stands above every page but the first.
    """
    lines = [LAYOUT.format(title=quoted(document.title), running=quoted(running))]
    lines.append(f"#heading(level: 1, {quoted(document.title)})")
    return "\n".join([*lines, *_blocks(document.body, 2)]) + "\n"


def quoted(text: str) -> str:
    """A string literal."""
    return '"' + printable(text).replace("\\", "\\\\").replace('"', '\\"') + '"'


def _blocks(blocks: Iterable[doc.Block], level: int) -> Iterator[str]:
    for block in blocks:
        yield ""
        match block:
            case doc.Paragraph(text):
                yield f"#par[#{quoted(text)}]"
            case doc.Bullets(items):
                yield from (f"- #{quoted(item)}" for item in items)
            case doc.Code(text) | doc.Equation(text):
                lines = ' + "\\n" + '.join(map(quoted, text.splitlines())) or '""'
                breakable = str(not isinstance(block, doc.Equation)).lower()  # no sheet ends inside a formula
                yield f"#block(breakable: {breakable}, raw(block: true, {lines}))"
            case doc.Figure(path, caption):
                words = f"caption: [#{quoted(caption)}]"
                image = f"image({quoted(path)}, height: 28mm)"
                yield f"#figure({image}, {words}, numbering: none)"
            case doc.Section(title, inner):
                yield f"#heading(level: {level}, {quoted(title)})"
                if _ends_drawn(inner):  # words on the left, the drawing that ends them on the right
                    yield "#grid(columns: (1fr, 62mm), column-gutter: 5mm, ["
                    yield from _blocks(inner[:-1], 0)
                    yield "], ["
                    yield from _blocks(inner[-1:], 0)
                    yield "])"
                else:
                    yield from _blocks(inner, level + 1)
            case doc.Table():
                yield from _table(block)


def _ends_drawn(blocks: tuple[doc.Block, ...]) -> bool:
    """Whether words, and nothing wide, end with a drawing."""
    *words, last = blocks or (None,)
    return (
        bool(words)
        and isinstance(last, doc.Figure)
        and all(isinstance(one, doc.Paragraph | doc.Bullets) for one in words)
    )


def _table(table: doc.Table) -> Iterator[str]:
    columns = zip(table.heads, *table.rows, strict=True)
    widths = (
        "1fr" if side == "l" and max(map(len, cells)) > 3 * WIDE else "auto"
        for cells, side in zip(columns, table.align, strict=True)
    )
    if table.caption:
        yield f"#text(8.4pt)[#{quoted(table.caption)}]"
        yield ""
    sides = ", ".join(SIDES[side] for side in table.align)
    yield f"#table(columns: ({', '.join(widths)},), align: ({sides},),"
    yield f"  table.header({', '.join(f'[#{quoted(head)}]' for head in table.heads)}),"
    yield from (f"  {', '.join(f'[#{quoted(cell)}]' for cell in row)}," for row in table.rows)
    yield ")"
