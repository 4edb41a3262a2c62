"""The simulated run of each gain set, and the certified map over m and k_v."""

from __future__ import annotations

from lyapcheck.output.elements import Markup, element
from lyapcheck.report.drawings import file_stem
from lyapcheck.report.gain_map import BOXES
from lyapcheck.report.map_cell import MapCell
from lyapcheck.report.model import Report
from lyapcheck.report.page.drawing import figure

DRAWN = {"errors": "position errors", "torques": "torques"}
"""The figures of a run."""


def gains_section(report: Report) -> Markup:
    """What ``simulate`` did with each gain set, as it is drawn; no script, nothing that moves."""
    words = (
        "Reference simulation of (11), in floating point: good for a look, decides nothing. Other gains: ",
        element("code", "lyapcheck simulate gains.toml"),
        " shows their run, ",
        element("code", "lyapcheck gate gains.toml"),
        " decides.",
    )
    runs = [
        element(
            "div",
            [
                figure(report, f"{file_stem(row.name)}_{name}", f"{row.name}: {caption}.")
                for name, caption in DRAWN.items()
            ],
            class_="run",
        )
        for row in report.runs
    ]
    heading = element("h2", "Gains in motion")
    return element("section", heading, element("p", *words, class_="quiet"), runs, _map(report), id="gains")


def _map(report: Report) -> Markup | None:
    cells = report.map
    if not cells:
        return None
    scales = list(dict.fromkeys(cell.kv for cell in cells))
    ms = list(dict.fromkeys(cell.m for cell in cells))
    at = {(cell.m, cell.kv): cell for cell in cells}
    largest = max((float(cell.eps0 or 0) for cell in cells), default=0.0) or 1.0
    heads = [element("th", f"k_v = {kv}", scope="col") for kv in scales]
    rows = [
        element(
            "tr", element("th", f"m = {m}", scope="row"), [_cell(report, at[m, kv], largest) for kv in scales]
        )
        for m in ms
    ]
    caption = (
        "The ε₀ of certificates over m and k_v (N·m, the same in all joints, k_p as in the set of each m) "
        f"on {report.robot.name}, each a link to its certificate, found with {BOXES:,} boxes, so a little "
        "below what more boxes give; below it the settling time of the slowest joint and the largest share "
        "of a motor's torque in the reference simulation, in floating point. A frame: (19) holds."
    )
    table = element(
        "table",
        element("caption", caption),
        element("thead", element("tr", element("td"), heads)),
        element("tbody", rows),
        class_="map",
    )
    return element("div", element("h3", "The map of m and k_v"), element("div", table, class_="scroll"))


def _cell(report: Report, cell: MapCell, largest: float) -> Markup:
    eps0 = element("b", cell.eps0 or "none proved")
    if cell.path in report.certificates:
        eps0 = element("a", eps0, href=cell.path)
    settling = "not settled" if cell.settling is None else f"{cell.settling:.2f} s"
    share = "" if cell.share is None else f", {100 * cell.share:.0f} %"
    shade = round(45 * float(cell.eps0 or 0) / largest)
    style = f"background:color-mix(in srgb,var(--good) {shade}%,var(--paper))"
    return element(
        "td",
        eps0,
        element("br"),
        f"{settling}{share}",
        style=style,
        class_="within" if cell.within_19 else None,
    )
