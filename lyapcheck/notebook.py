"""Small HTML for notebooks: results show themselves as tables, whatever is in their names."""

from __future__ import annotations

from collections.abc import Sequence

from lyapcheck.output.escapes import html_text

_LEFT = ' style="text-align:left"'


def html_paragraph(text: str) -> str:
    """One paragraph of plain text."""
    return f"<p>{html_text(text)}</p>"


def html_table(heads: Sequence[str], rows: Sequence[Sequence[str]], caption: str = "") -> str:
    """A table of plain text: a caption if there is one, a row of heads, and the rows."""
    title = [f"<caption{_LEFT}>{html_text(caption)}</caption>"] if caption else []
    head = "".join(f"<th{_LEFT}>{html_text(cell)}</th>" for cell in heads)
    body = [f"<tr>{_cells(row)}</tr>" for row in rows]
    return "\n".join(
        ["<table>", *title, f"<thead><tr>{head}</tr></thead>", "<tbody>", *body, "</tbody>", "</table>"]
    )


def _cells(row: Sequence[str]) -> str:
    return "".join(f"<td{_LEFT}>{html_text(cell)}</td>" for cell in row)
