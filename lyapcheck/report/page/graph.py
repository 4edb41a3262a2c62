"""The claims and what they rest on, as a picture whose boxes are links."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import replace

from lyapcheck.output.elements import Markup, element
from lyapcheck.report.claim_row import ClaimRow
from lyapcheck.report.text import SYMBOLS

WIDE, HIGH = 138, 34
ACROSS, DOWN = 184, 42
MARGIN = 8
LETTERS = 22
"""The longest title that fits a box."""
Place = tuple[float, float]


def graph(rows: Sequence[ClaimRow], words: str, titles: Mapping[str, str]) -> Markup:
    """Each claim that uses another or is used, right of all it uses; a thick line is a link that breaks.

    Args:
        rows: the claims of one proof for one m.
        words: what it shows, for who cannot see it.
        titles: of claims, in at most ``LETTERS`` letters.
    """
    chosen = tied(rows)
    places = layout(chosen)
    at = {name: (MARGIN + x * ACROSS, MARGIN + (y + 0.5) * DOWN) for name, (x, y) in places.items()}
    width = max((x for x, _ in at.values()), default=0.0) + WIDE + MARGIN
    height = max((y for _, y in at.values()), default=0.0) + HIGH + MARGIN
    lines = [_line(at[used], at[row.id], used, row) for row in chosen for used in row.uses]
    boxes = [_box(at[row.id], row, titles.get(row.id, "")) for row in chosen]
    view = f"0 0 {width:g} {height:g}"
    return element(
        "svg",
        lines,
        boxes,
        viewBox=view,
        class_="claim-graph",
        role="group",
        aria_label=words,
        style=f"min-width:{width:g}px",
    )


def _line(start: Place, end: Place, used: str, row: ClaimRow) -> Markup:
    (x0, y0), (x1, y1) = (start[0] + WIDE, start[1]), end
    bend = (x1 - x0) / 2
    path = f"M{x0:g} {y0:g}C{x0 + bend:g} {y0:g} {x1 - bend:g} {y1:g} {x1:g} {y1:g}"
    broken = " broken" if used in row.broken else ""
    return element("path", d=path, class_=f"edge{broken}", data_from=used, data_to=row.id)


def _box(place: Place, row: ClaimRow, short: str) -> Markup:
    x, y = place
    rests = f"Rests on {', '.join(row.uses)}." if row.uses else "Rests on no other claim."
    title = element("title", f"{row.id}, {row.word} [{row.grade}]: {row.comment} {rests}")
    shape = element("rect", x=f"{x:g}", y=f"{y - HIGH / 2:g}", width=WIDE, height=HIGH, rx=4)
    middle = f"{x + WIDE / 2:g}"
    words = [
        element("text", f"{SYMBOLS[row.verdict]} {row.id}", x=middle, y=f"{y - (3 if short else -4):g}"),
        element("text", short, x=middle, y=f"{y + 11:g}", class_="short") if short else None,
    ]
    return element(
        "a",
        title,
        shape,
        words,
        href=f"#{row.id}",
        class_=f"box {row.verdict} {row.grade}",
        data_claim=row.id,
    )


def tied(rows: Sequence[ClaimRow]) -> list[ClaimRow]:
    """The claims that use another one of the list, or are used by one."""
    known = {row.id for row in rows}
    used = {name for row in rows for name in row.uses if name in known}
    result = [row for row in rows if row.id in used or set(row.uses) & known]
    return [replace(row, uses=tuple(name for name in row.uses if name in known)) for row in result]


def layout(rows: Sequence[ClaimRow]) -> dict[str, Place]:
    """Columns by the longest way to a claim that uses nothing, rows near the claims that are used."""
    uses = {row.id: row.uses for row in rows}
    columns: dict[int, list[str]] = {}
    for name in uses:
        columns.setdefault(depth(name, uses), []).append(name)
    tallest = max(map(len, columns.values()), default=0)
    places: dict[str, Place] = {}
    for column in sorted(columns):
        names = sorted(columns[column], key=lambda name: _height(name, uses, places))
        step = tallest / len(names)
        places |= {name: (float(column), (k + 0.5) * step - 0.5) for k, name in enumerate(names)}
    return places


def depth(name: str, uses: Mapping[str, Sequence[str]]) -> int:
    """The length of the longest chain of uses below a claim."""
    return 1 + max((depth(used, uses) for used in uses[name]), default=-1)


def _height(name: str, uses: Mapping[str, Sequence[str]], places: Mapping[str, Place]) -> float:
    """The middle of the claims that it uses; those that use nothing keep their order."""
    heights = [places[used][1] for used in uses[name]]
    return sum(heights) / len(heights) if heights else 0.0
