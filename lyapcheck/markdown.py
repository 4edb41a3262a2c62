"""Tables in Markdown."""

from __future__ import annotations

from lyapcheck.output.escapes import markdown_text

TYPE_CHECKING = False
if TYPE_CHECKING:
    from collections.abc import Sequence


def markdown_table(heads: Sequence[str], rows: Sequence[Sequence[str]], words: int = 0) -> list[str]:
    """The lines of a table of plain text: the first column to the left, numbers to the right.

    The last ``words`` columns hold words, which stand to the left as well.
    """
    numbers = len(heads) - 1 - words
    rule = f"| {' | '.join(['---', *['---:'] * numbers, *['---'] * words])} |"
    first, *others = (f"| {' | '.join(map(markdown_text, cells))} |" for cells in (heads, *rows))
    return [first, rule, *others]
