"""What an answer says of its rows, once: keys for programs, columns for people and for spreadsheets."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Sequence
from typing import Any, NamedTuple

from lyapcheck.output.digits import shown
from lyapcheck.output.document import Table


class Field(NamedTuple):
    """One thing that is said of a row, or of each part of it, such as a joint.

    Args:
        key: its name in JSON; empty where it is not there.
        of: where a row has it, as ``indices.L2``, or what finds it there.
        head: of its column for people; empty where they do not see it.
        show: it, or one part of it, as text; a form is that of `lyapcheck.output.digits.shown`.
        to: it as plain data; ``None`` stays ``None``.
        align: ``l`` or ``r``.
        each: whether it is a sequence of which each part has a row; ``None`` counts for all parts.
        csv: its name there where that is not the key; ``None`` where it is not there.
    """

    key: str
    of: str | Callable[[Any], Any]
    head: str = ""
    show: str | Callable[[Any], str] = str
    to: Callable[[Any], Any] | None = None
    align: str = "r"
    each: bool = False
    csv: str | None = ""

    def found(self, row: Any) -> Any:
        """What a row has; ``None`` where a part of the way is missing."""
        if not isinstance(self.of, str):
            return self.of(row)
        for name in self.of.split("."):
            row = None if row is None else getattr(row, name)
        return row

    def data(self, row: Any) -> Any:
        """The same as plain data."""
        value = self.found(row)
        return value if self.to is None or value is None else self.to(value)

    def text(self, row: Any, *part: int) -> str:
        """The cell of a row, or of a part of it."""
        value = self.found(row)
        if part and value is not None:
            value = value[part[0]]
        return shown(value, self.show) if isinstance(self.show, str) else self.show(value)


def data(fields: Sequence[Field], row: Any) -> dict[str, Any]:
    """A row for programs."""
    return {field.key: field.data(row) for field in fields if field.key}


def records(fields: Sequence[Field], row: Any, parts: int = 1) -> list[dict[str, Any]]:
    """A row for spreadsheets, once for each part of it."""
    values = [
        (field.csv or field.key, field.each, field.data(row)) for field in fields if field.csv is not None
    ]
    return [
        {name: value[part] if each and value is not None else value for name, each, value in values}
        for part in range(parts)
    ]


def table(
    fields: Sequence[Field],
    rows: Iterable[tuple[Any, ...]],
    caption: str = "",
    keys: int = 1,
    drop: tuple[int, ...] = (),
    **words: Any,
) -> Table:
    """Rows for people: each a row alone, or a row and the number of a part; words fill in the heads."""
    seen = [field for field in fields if field.head]
    cells = tuple(tuple(field.text(*row) for field in seen) for row in rows)
    heads = tuple(field.head.format(**words) for field in seen)
    return Table(heads, cells, caption, "".join(field.align for field in seen), keys, drop)
