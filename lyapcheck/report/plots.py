"""How every figure looks: colours that colour-blind readers can tell apart, the same bytes each time."""

from __future__ import annotations

import csv
from collections.abc import Iterable, Sequence
from dataclasses import dataclass
from io import BytesIO, StringIO
from typing import Any

from lyapcheck.output.escapes import csv_text

COLOURS = ("#0072B2", "#D55E00", "#009E73", "#CC79A7", "#E69F00", "#56B4E9", "#000000")
"""Okabe and Ito's palette, strongest contrasts first."""
DASHES = ("-", "--", "-.", ":")
"""A line style for each curve as well, for grey prints."""
DOTS_PER_INCH = 200
SETTINGS = {
    "svg.hashsalt": "lyapcheck",
    "svg.fonttype": "none",
    "font.family": "sans-serif",
    "font.sans-serif": ["DejaVu Sans", "Arial", "Helvetica"],
    "font.size": 9,
    "axes.titlesize": 10,
    "axes.titlelocation": "left",
    "axes.spines.top": False,
    "axes.spines.right": False,
    "axes.grid": True,
    "axes.axisbelow": True,
    "grid.color": "#dddddd",
    "grid.linewidth": 0.6,
    "lines.linewidth": 1.6,
    "legend.frameon": False,
    "path.simplify": True,
    "path.simplify_threshold": 0.3,
}


def panels(rows: int, columns: int, width: float = 7.2, height: float = 3.0) -> tuple[Any, Any]:
    """A figure of ``rows`` × ``columns`` axes, sizes in inches; drawn without any global state."""
    from matplotlib.figure import Figure

    figure = Figure(figsize=(width, height), layout="constrained")
    return figure, figure.subplots(rows, columns, squeeze=False)


def svg(figure: Any) -> str:
    """The figure as SVG text: no date, no random ids, so that equal data give equal bytes."""
    text = StringIO()
    with styled():
        figure.savefig(text, format="svg", metadata={"Date": None, "Creator": None})
    return "\n".join(line.rstrip() for line in text.getvalue().splitlines()) + "\n"


def png(figure: Any) -> bytes:
    """The figure as PNG for print, 200 dots an inch, without the version of what drew it."""
    data = BytesIO()
    with styled():
        figure.savefig(data, format="png", dpi=DOTS_PER_INCH, metadata={"Software": None})
    return _with_palette(data)


def _with_palette(data: BytesIO) -> bytes:
    """The same picture in 256 colours: a drawing of lines needs no more, and a third of the bytes."""
    from PIL import Image

    flat = Image.open(data).convert("RGB")
    few = flat.quantize(method=Image.Quantize.FASTOCTREE, dither=Image.Dither.NONE)
    paper, colours = 3 * few.tobytes()[0], few.getpalette() or []
    colours[paper : paper + 3] = flat.tobytes()[:3]  # rounding must not tint it
    few.putpalette(colours)
    smaller = BytesIO()
    few.save(smaller, format="png", dpi=(DOTS_PER_INCH, DOTS_PER_INCH))
    return smaller.getvalue()


def styled() -> Any:
    """The context in which figures are built: the settings above, undone afterwards."""
    import matplotlib as mpl

    return mpl.rc_context(SETTINGS)


# --- One figure in every form a report hands out: SVG, PNG, and the data as CSV.


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
        with styled():  # everything in its place: without this each form would compute the layout twice
            self.figure.draw_without_rendering()
            self.figure.set_layout_engine(None)
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
