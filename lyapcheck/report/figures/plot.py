"""One figure in every form a report hands out: SVG, PNG, and the data as CSV."""

from __future__ import annotations

import csv
from collections.abc import Iterable, Sequence
from dataclasses import dataclass
from io import StringIO
from typing import Any

from lyapcheck.output.escapes import csv_text
from lyapcheck.report.figures.style import png, settle, svg

Files = dict[str, str | bytes]
DIGITS = 7
"""Significant digits of the data: more than anybody can read off."""


@dataclass(frozen=True, eq=False)
class Plot:
    """A figure and the numbers in it.

    Args:
        figure: of matplotlib, not yet drawn.
        header: the columns of the data, with units.
        rows: numbers, words, and ``None`` where there is nothing.
    """

    figure: Any
    header: Sequence[str]
    rows: Iterable[Sequence[Any]]

    def files(self, stem: str) -> Files:
        """``stem.svg``, ``stem.png`` and ``stem.csv``; equal data give equal bytes."""
        settle(self.figure)
        return {f"{stem}.svg": svg(self.figure), f"{stem}.png": png(self.figure), f"{stem}.csv": self.csv()}

    def csv(self) -> str:
        """The data, one line a row."""
        text = StringIO()
        writer = csv.writer(text, lineterminator="\n")
        writer.writerow(map(csv_text, self.header))
        writer.writerows([_cell(value) for value in row] for row in self.rows)
        return text.getvalue()


def _cell(value: Any) -> str:
    if value is None:
        return ""
    if isinstance(value, str):
        return csv_text(value)
    if isinstance(value, (bool, int)):
        return str(value)
    return f"{float(value) + 0.0:.{DIGITS}g}"
