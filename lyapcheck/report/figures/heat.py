"""Maps over m and k_v."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence

from lyapcheck.report.figures.style import Plot, panels, styled

SHADES = "cividis"
"""Even steps, for colour-blind readers and grey prints too."""
LEGIBLE = 14
"""Columns up to which every cell has its number."""
TICKS = 20


def heat_plot(
    rows: Sequence[str],
    columns: Sequence[str],
    cells: Mapping[tuple[str, str], float | None],
    title: str,
    text: Callable[[float | None], str],
) -> Plot:
    """A value for each m (rows) and k_v (columns, N·m), by colour; a cell without one stays empty.

    Args:
        rows: the m, from above.
        columns: the k_v.
        cells: the values.
        title: what they are, with their unit.
        text: of a value, as it is to be read.
    """
    import numpy as np

    values = np.array([[_number(cells.get((m, kv))) for kv in columns] for m in rows])
    with styled():
        figure, axes = panels(1, 1, height=1.6 + 0.32 * len(rows))
        axis = axes[0, 0]
        image = axis.pcolormesh(values, cmap=SHADES)
        axis.invert_yaxis()
        every = max(1, -(-len(columns) // TICKS))
        places = range(0, len(columns), every)
        axis.set_xticks(
            [k + 0.5 for k in places],
            [columns[k] for k in places],
            rotation=90 if len(columns) > LEGIBLE else 0,
        )
        axis.set_yticks([k + 0.5 for k in range(len(rows))], rows)
        axis.set(xlabel="k_v [N·m]", ylabel="m", title=title)
        axis.grid(visible=False)
        if len(columns) <= LEGIBLE:
            dark = (np.nanmin(values) + np.nanmax(values)) / 2
            for (i, j), value in np.ndenumerate(values):
                if not np.isnan(value):
                    colour = "white" if value < dark else "black"
                    axis.text(
                        j + 0.5,
                        i + 0.5,
                        text(float(value)),
                        ha="center",
                        va="center",
                        color=colour,
                        fontsize=7,
                    )
        figure.colorbar(image, ax=axis)
    data = [[m, kv, cells.get((m, kv))] for m in rows for kv in columns]
    return Plot(figure, ["m", "k_v [N·m]", title], data)


def _number(value: float | None) -> float:
    return float("nan") if value is None else value
