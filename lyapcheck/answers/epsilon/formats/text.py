"""The four ε₀ in a terminal."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING

from lyapcheck.admissible.formats.words import heads, notes, remarks, row

if TYPE_CHECKING:
    from lyapcheck.admissible import EpsilonResult


def render(results: Sequence[EpsilonResult], seconds: Sequence[float] | None = None) -> str:
    """A table with a row a gain set, what follows from each, and what is assumed."""
    times = seconds if seconds is not None else [None] * len(results)
    rows = [heads(seconds), *(row(result, time) for result, time in zip(results, times, strict=True))]
    widths = [max(map(len, column)) for column in zip(*rows, strict=True)]
    lines = [
        "  ".join(cell.ljust(w) for cell, w in zip(cells, widths, strict=True)).rstrip() for cells in rows
    ]
    for result in results:
        lines += ["", f"{result.name}:", *(f"  {remark}" for remark in remarks(result))]
    return "\n".join([*lines, "", *notes(results)]) + "\n"
