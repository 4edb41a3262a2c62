"""Printed numbers beside what the assumed arms do, and what each assumption does to the L2 index."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

from lyapcheck.output.escapes import plot_text
from lyapcheck.report.experiment import NumberRow, SetRow
from lyapcheck.report.figures.motion import TICK
from lyapcheck.report.figures.style import COLOURS, Plot, panels, styled

TITLES = {"L2": "L2 index [°]", "settling": "settling time [s]", "final_error": "error after 5 s [°]"}
UNITS = {"L2": "deg", "settling": "s", "final_error": "deg", "start_torque": "N·m"}
END = 5.0
"""s: a joint that does not settle within the run is drawn there, open to the right."""
MOST = 7
"""Assumptions shown for each gain set."""
SEEN, TYPICAL = "#b8c1ca", COLOURS[5]


def spread_plot(sets: Sequence[SetRow]) -> Plot:
    """For each printed number: all values seen (line), the middle 90 % (bar), the nominal arm, the print."""
    with styled():
        rows = max(len(one.of("settling")) for one in sets) * len(sets)
        figure, axes = panels(1, len(TITLES), height=0.9 + 0.22 * rows)
        for axis, quantity in zip(axes[0], TITLES, strict=True):
            _panel(axis, sets, quantity)
        figure.legend(handles=_handles(), ncols=4, loc="outside lower center", fontsize=8)
    header = ["gains", "quantity", "joint", "unit", "printed", "printed as a bound", "nominal", "least seen"]
    header += ["5 % of the spread", "95 % of the spread", "largest seen", "share not settled", "explained"]
    return Plot(figure, header, [_row(one, number) for one in sets for number in one.numbers])


def _row(one: SetRow, number: NumberRow) -> list[Any]:
    given = [number.printed, str(number.at_most).lower(), number.nominal, number.low]
    seen = [*number.typical, number.high, number.unsettled, number.answer]
    return [one.name, number.quantity, number.joint or "", UNITS[number.quantity], *given, *seen]


def _panel(axis: Any, sets: Sequence[SetRow], quantity: str) -> None:
    labels: list[str] = []
    for one in sets:
        for number in one.of(quantity):
            _draw(axis, len(labels), number)
            labels.append(plot_text(" ".join(filter(None, (one.name, number.joint))), TICK))
    axis.set_yticks(range(len(labels)), labels, fontsize=7 if len(labels) > len(sets) else 9)
    axis.set(ylim=(len(labels) - 0.4, -0.6), xlabel=TITLES[quantity])
    axis.grid(axis="y", visible=False)
    if quantity == "settling":
        axis.set_xlim(0.0, END * 1.04)
    if quantity == "final_error":
        axis.axvline(0.0, color="black", linewidth=0.6)


def _draw(axis: Any, place: int, number: NumberRow) -> None:
    low, high, (left, right) = number.low, number.high, number.typical
    never = number.quantity == "settling" and number.unsettled > 0
    if low is not None:
        axis.plot([low, END if never else high], [place, place], color=SEEN, linewidth=1.6, zorder=1)
    if left is not None:
        axis.barh(place, (END if right is None else right) - left, left=left, height=0.55, color=TYPICAL)
    if never:
        axis.plot(END, place, marker=">", markersize=4, color=SEEN, clip_on=False, zorder=2)
    if number.nominal is not None:
        axis.plot([number.nominal] * 2, [place - 0.36, place + 0.36], color="black", linewidth=1.6, zorder=3)
    axis.plot(number.printed, place, zorder=4, **_mark(number.at_most, number.answer == "yes"))


def _mark(at_most: bool, explained: bool) -> dict[str, Any]:
    marker = "<" if at_most else "D"
    return {
        "marker": marker,
        "markersize": 5.5,
        "linestyle": "none",
        "color": COLOURS[1],
        "markerfacecolor": COLOURS[1] if explained else "white",
        "markeredgewidth": 1.3,
    }


def _handles() -> list[Any]:
    from matplotlib.lines import Line2D
    from matplotlib.patches import Patch

    return [
        Line2D([], [], label="printed, some arm does it", **_mark(at_most=False, explained=True)),
        Line2D([], [], label="printed, no arm seen does it", **_mark(at_most=False, explained=False)),
        Line2D([], [], color="black", linestyle="none", marker="|", markersize=9, label="nominal arm"),
        Patch(color=TYPICAL, label="middle 90 % of arms"),
        Line2D([], [], color=SEEN, label="all arms seen"),
        Line2D([], [], color=SEEN, linestyle="none", marker=">", label="does not settle in 5 s"),
        Line2D([], [], label="printed as a bound", **_mark(at_most=True, explained=True)),
    ]


def alone_plot(sets: Sequence[SetRow], words: dict[str, str]) -> Plot:
    """The range of L2 when one assumption alone runs over its range, widest first, beside the print.

    Args:
        words: the assumptions as they stand in a sentence, by name.
    """
    columns = min(2, len(sets))
    with styled():
        lines = -(-len(sets) // columns)
        figure, axes = panels(lines, columns, height=0.5 + 1.9 * lines)
        for axis in axes.flat[len(sets) :]:
            axis.set_axis_off()
        for axis, one in zip(axes.flat, sets, strict=False):
            _tornado(axis, one, words)
        handles, labels = axes[0, 0].get_legend_handles_labels()
        figure.legend(handles, labels, ncols=3, loc="outside lower center")
    rows = [
        [one.name, name, *one.of("L2")[0].alone[name], _share(one.of("L2")[0], name)]
        for one in sets
        for name in words
    ]
    return Plot(
        figure, ["gains", "assumption", "least L2 [deg]", "largest L2 [deg]", "share of variance"], rows
    )


def _share(number: NumberRow, name: str) -> float | None:
    return None if number.shares is None else number.shares[name]


def _tornado(axis: Any, one: SetRow, words: dict[str, str]) -> None:
    number = one.of("L2")[0]
    ranges = {
        name: (low, high)
        for name, (low, high) in number.alone.items()
        if low is not None and high is not None
    }
    widest = sorted(ranges, key=lambda name: ranges[name][0] - ranges[name][1])[:MOST]
    for place, name in enumerate(widest):
        low, high = ranges[name]
        axis.barh(place, high - low, left=low, height=0.6, color=TYPICAL)
    axis.use_sticky_edges = False
    axis.axvline(number.nominal, color="black", linewidth=1.2, label="nominal arm")
    axis.axvline(number.printed, color=COLOURS[1], linestyle="--", linewidth=1.4, label="printed")
    axis.set_yticks(range(len(widest)), [words[name] for name in widest], fontsize=8)
    axis.set(ylim=(len(widest) - 0.4, -0.6), xlabel="L2 index [°]", title=plot_text(one.name))
    axis.grid(axis="y", visible=False)
