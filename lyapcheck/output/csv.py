"""The records of an answer as comma-separated values."""

from __future__ import annotations

import csv
import io
import math
from collections.abc import Iterator, Mapping
from typing import Any

from lyapcheck.output.answer import Answer
from lyapcheck.output.escapes import csv_text


def render(answer: Answer) -> str:
    """A line a record, under the names of all that any of them has; what is inside another gets both names.

    ``{"gamma": {"lower": 1}}`` is a column ``gamma_lower``, the parts of a list are counted from 1; cells
    without a value are empty, and so are those whose number is none or infinite.
    """
    rows = [dict(_flat("", record)) for record in answer.records()]
    names = dict.fromkeys(name for row in rows for name in row)
    # not those that have no value anywhere, but parts in some record
    heads = [
        name
        for name in names
        if any(row.get(name) for row in rows) or not any(other.startswith(f"{name}_") for other in names)
    ]
    text = io.StringIO()
    writer = csv.writer(text, lineterminator="\n")
    writer.writerow(map(csv_text, heads))
    writer.writerows([row.get(name, "") for name in heads] for row in rows)
    return text.getvalue()


def _flat(name: str, value: Any) -> Iterator[tuple[str, str]]:
    if isinstance(value, Mapping):
        for key, inner in value.items():
            yield from _flat(f"{name}_{key}" if name else str(key), inner)
    elif isinstance(value, (list, tuple)):
        for index, inner in enumerate(value, start=1):
            yield from _flat(f"{name}_{index}", inner)
    else:
        yield name, _cell(value)


def _cell(value: object) -> str:
    """Numbers as they are, so that a spreadsheet computes with them; text so that none does."""
    if value is None:
        return ""
    if isinstance(value, bool):
        return "yes" if value else "no"
    if isinstance(value, float) and not math.isfinite(value):
        return ""
    text = str(value)
    try:
        float(text)
    except ValueError:
        return csv_text(text)
    return text
