"""Gains to try in the page, in floating point that decides nothing, beside the certified map."""

from __future__ import annotations

import json

from lyapcheck.output.elements import Markup, element
from lyapcheck.report.bench import BOXES
from lyapcheck.report.map_cell import MapCell
from lyapcheck.report.model import Report
from lyapcheck.report.plain import plain

DRAWN = {
    "h": "The function h_m and its bound γ_m.",
    "tau": "(10p): k_p + k_v of each joint against its largest admissible value.",
    "damping": "(19): k_v of each joint against λmin(B)/(√n γ).",
    "step": "Step response of each joint by itself, in shares of the step.",
    "share": "Torque of each joint with its gravity bound, in shares of the motor's limit.",
}


def gains_section(report: Report) -> Markup:
    """Sliders with live curves, and the map; without a script the map alone."""
    data = json.dumps(plain(report.bench), ensure_ascii=True, allow_nan=False).replace("<", "\\u003c")
    plots = [
        element(
            "figure",
            element("svg", id=f"plot-{name}", viewBox="0 0 320 190", role="img", aria_label=words),
            element("figcaption", words),
        )
        for name, words in DRAWN.items()
    ]
    damped = element(
        "figure", element("div", id="plot-words"), element("figcaption", "Near the goal, joint by joint.")
    )
    tries = element(
        "div",
        element("form", id="sliders", onsubmit="return false"),
        element("div", plots, damped, class_="plots"),
        class_="bench script-only",
    )
    warning = (
        "Floating point, one joint at a time: good for a first look, decides nothing. The gate decides: "
    )
    return element(
        "section",
        element("h2", "Your gains"),
        element(
            "p", warning, element("code", "lyapcheck gate gains.toml"), ".", class_="floating script-only"
        ),
        tries,
        element(
            "p",
            "With a script, sliders for m, gains, friction and posture stand here.",
            class_="without-script",
        ),
        _map(report),
        element("script", Markup(data), type="application/json", id="bench"),
        id="gains",
    )


def _map(report: Report) -> Markup | None:
    cells = report.bench.map
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
        "Certified ε₀ over m and k_v (N·m, the same in every joint, k_p as in the gain set of each m) on "
        f"{report.robot.name}, each a link to its certificate, found with {BOXES:,} boxes, so a little "
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
    eps0 = element("b", f"{float(cell.eps0):.3g}") if cell.eps0 else element("b", "none proved")
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
