"""A document as LaTeX for ``\\input``: sections, lists and ``tabular`` environments, no package needed."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Sequence

from lyapcheck.output import document as doc
from lyapcheck.output.escapes import latex_text, printable

LONGEST = 40
"""Characters of a cell beyond which its column is a paragraph."""
PARAGRAPH = 0.4
HEADINGS = (r"\section*", r"\subsection*", r"\subsubsection*", r"\paragraph*")


def render(document: doc.Document) -> str:
    """The whole document; signs beyond letters and formulas need a typesetter that knows Unicode."""
    lines = [f"{HEADINGS[0]}{{{latex_text(document.title)}}}", *_blocks(document.body, 1)]
    return "\n".join(lines) + "\n"


def _blocks(blocks: Iterable[doc.Block], level: int) -> Iterator[str]:
    for block in blocks:
        yield ""
        match block:
            case doc.Paragraph(text):
                yield latex_text(text)
            case doc.Bullets(items):
                yield r"\begin{itemize}"
                yield from (rf"  \item {{}}{latex_text(item)}" for item in items)
                yield r"\end{itemize}"
            case doc.Code(text):
                yield r"\begin{quote}\ttfamily"
                yield from (rf"{latex_text(printable(x))}\\" for x in text.splitlines() if x.strip())
                yield r"\end{quote}"
            case doc.Equation(_, latex):
                yield from (r"\[", printable(latex), r"\]")
            case doc.Figure(path, caption):
                yield from (latex_text(caption), r"\begin{quote}\ttfamily", latex_text(path), r"\end{quote}")
            case doc.Section(title, inner):
                yield f"{HEADINGS[min(level, len(HEADINGS) - 1)]}{{{latex_text(title)}}}"
                yield from _blocks(inner, level + 1)
            case doc.Table():
                if block.caption:
                    yield from (latex_text(block.caption), "")
                columns = map(_column, zip(block.heads, *block.rows, strict=True), block.align)
                yield rf"\begin{{tabular}}{{{''.join(columns)}}}"
                yield r"\hline"
                yield _row(block.heads)
                yield r"\hline"
                yield from map(_row, block.rows)
                yield from (r"\hline", r"\end{tabular}")


def _column(cells: Sequence[str], side: str) -> str:
    """Long words are set as a paragraph."""
    long = side == "l" and max(map(len, cells)) > LONGEST
    return rf"p{{{PARAGRAPH}\textwidth}}" if long else side


def _row(cells: Sequence[str]) -> str:
    return " & ".join(map(latex_text, cells)) + r" \\"
