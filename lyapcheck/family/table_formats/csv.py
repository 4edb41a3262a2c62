"""The table of constants as CSV: a lower and an upper column for each quantity."""

from __future__ import annotations

import csv
import io
from collections.abc import Iterator

from lyapcheck.check.numbers.enclosure import Enclosure
from lyapcheck.escapes import csv_text
from lyapcheck.family.table import Table, slope_at_zero


def render(table: Table) -> str:
    """A line for each m; cells are empty at infinity and where a joint has no budget."""
    text = io.StringIO()
    writer = csv.writer(text, lineterminator="\n")
    for index, row in enumerate(table.rows):
        columns = list(_columns(table, index))
        if index == 0:
            ends = [f"{name}_{end}" for name, _ in columns for end in ("lower", "upper")]
            writer.writerow(["m", *map(csv_text, ends), "slope_at_0"])
        cells = [end for _, value in columns for end in _ends(value, table.digits)]
        writer.writerow([row.m, *cells, slope_at_zero(row.m)])
    return text.getvalue()


def _columns(table: Table, index: int) -> Iterator[tuple[str, Enclosure | None]]:
    """The quantities of one row by name."""
    row = table.rows[index]
    for name in ("gamma", "rho", "L", "gamma_at", "rho_at", "L_at"):
        yield name, getattr(row, name)
    if table.asymptotes is not None:
        for name in ("gamma", "rho", "L"):
            yield f"{name}_leading", getattr(table.asymptotes[index], name)
            yield f"{name}_rest", getattr(table.asymptotes[index], f"{name}_rest")
    if table.budget is not None:
        for joint, limit in zip(table.budget.joints, table.budget.rows[index], strict=True):
            yield f"budget_{joint}", limit


def _ends(value: Enclosure | None, digits: int) -> tuple[str, str]:
    return ("", "") if value is None else value.decimals(digits)
