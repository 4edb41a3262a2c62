"""The claims and what they rest on, as a graph from left to right."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Any

from lyapcheck.output.escapes import plot_text
from lyapcheck.report.figures.plot import Plot
from lyapcheck.report.figures.style import panels, styled
from lyapcheck.report.model import Data
from lyapcheck.report.text import SYMBOLS

FILL = {"proved": "#d6efe5", "refuted": "#fbdccb", "undecided": "#e3def2", "error": "#f6cdd5"}
EDGE = {"proved": "#00664a", "refuted": "#a33a00", "undecided": "#5d4a8a", "error": "#8a0f2c"}
FRAME = {"exact": "-", "enclosure": (0, (4, 2))}
"""The frame of a claim that is decided: solid where nothing was rounded, dashed where balls enclose."""
OTHER_FRAME = ":"
Place = tuple[float, float]
REACH = 0.2
"""From the middle of a box to where its arrows begin and end, in columns."""


def claims_plot(rows: Sequence[Data]) -> Plot:
    """Each claim that uses another or is used, right of all it uses; colour and sign say the verdict, frames
    the grade, and a thick arrow is a link that breaks.

    Args:
        rows: the claims of one proof for one m, with ``id``, ``uses``, ``broken``, ``verdict`` and ``grade``.
    """
    chosen = tied(rows)
    places = layout(chosen)
    tallest = max((y for _, y in places.values()), default=0.0) + 1
    with styled():
        figure, axes = panels(1, 1, width=7.6, height=1.2 + 0.27 * tallest)
        axis = axes[0, 0]
        axis.set_axis_off()
        for row in chosen:
            for used in row["uses"]:
                _arrow(axis, places[used], places[row["id"]], used in row["broken"])
        for row in chosen:
            _box(axis, places[row["id"]], row)
        deepest = max((x for x, _ in places.values()), default=0.0)
        axis.set(xlim=(-0.45, deepest + 0.45), ylim=(tallest - 0.4, -0.6))
        _legend(figure, chosen)
    return Plot(figure, ["claim", "verdict", "grade", "uses", "broken"], [_row(row) for row in chosen])


def tied(rows: Sequence[Data]) -> list[Data]:
    """The claims that use another one of the list, or are used by one."""
    known = {row["id"] for row in rows}
    used = {name for row in rows for name in row["uses"] if name in known}
    found = [row for row in rows if row["id"] in used or set(row["uses"]) & known]
    return [{**row, "uses": [name for name in row["uses"] if name in known]} for row in found]


def layout(rows: Sequence[Data]) -> dict[str, Place]:
    """Columns by the longest way to a claim that uses nothing, rows near the claims that are used."""
    uses = {row["id"]: row["uses"] for row in rows}
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


def _arrow(axis: object, start: Place, end: Place, broken: bool) -> None:
    axis.annotate(  # type: ignore[attr-defined]
        "",
        xy=(end[0] - REACH, end[1]),
        xytext=(start[0] + REACH, start[1]),
        arrowprops={
            "arrowstyle": "->",
            "color": EDGE["refuted"] if broken else "#b8c1ca",
            "linewidth": 1.3 if broken else 0.7,
            "connectionstyle": "arc3,rad=0.04",
        },
    )


def _box(axis: object, place: Place, row: Data) -> None:
    verdict = row["verdict"]
    style = {
        "boxstyle": "round,pad=0.25",
        "facecolor": FILL[verdict],
        "edgecolor": EDGE[verdict],
        "linestyle": FRAME.get(row["grade"], OTHER_FRAME),
    }
    axis.text(  # type: ignore[attr-defined]
        *place, plot_text(f"{SYMBOLS[verdict]} {row['id']}"), ha="center", va="center", fontsize=8, bbox=style
    )


def _legend(figure: Any, rows: Sequence[Data]) -> None:
    """What colours, frames and thick arrows mean; only what is there."""
    from matplotlib.lines import Line2D
    from matplotlib.patches import Patch

    verdicts = [name for name in FILL if any(row["verdict"] == name for row in rows)]
    grades = [name for name in (*FRAME, "numeric") if any(row["grade"] == name for row in rows)]
    handles: list[Any] = [
        Patch(facecolor=FILL[name], edgecolor=EDGE[name], label=f"{SYMBOLS[name]} {name}")
        for name in verdicts
    ]
    handles += [
        Patch(facecolor="white", edgecolor="#333333", linestyle=FRAME.get(name, OTHER_FRAME), label=name)
        for name in grades
    ]
    if any(row["broken"] for row in rows):
        handles.append(Line2D([], [], color=EDGE["refuted"], linewidth=1.3, label="broken link"))
    if handles:
        figure.legend(handles=handles, ncols=len(handles), loc="outside lower center", fontsize=8)


def _row(row: Data) -> list[str]:
    return [row["id"], row["verdict"], row["grade"] or "", " ".join(row["uses"]), " ".join(row["broken"])]
