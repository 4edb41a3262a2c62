"""The page of a report, from the templates of this folder: no file, no network and no script is needed."""

from __future__ import annotations

import re
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import replace
from functools import cache, partial
from importlib import resources
from itertools import groupby
from pathlib import PurePosixPath
from typing import TYPE_CHECKING, Any
from urllib.parse import quote

from lyapcheck.files.fields import file_stem
from lyapcheck.output.document import Block, Document, Figure
from lyapcheck.output.html import Markup, blocks, element, joined, latex, sentence
from lyapcheck.output.html import render as whole
from lyapcheck.report import findings
from lyapcheck.report.document import evidence, four_epsilons, known, rests
from lyapcheck.report.model import SIGNS, WEIGHTS, ClaimRow, Motion, Report, anchor, behind
from lyapcheck.report.verdict import badges, chain, route, sampled_section, sentences
from lyapcheck.verdicts import Verdict

if TYPE_CHECKING:
    from jinja2 import Environment

NEAR = 0.05
"""Sides that differ by less than this share of each other are told apart by their difference."""
LONG = 150
"""Letters of LaTeX from which on a formula is too wide for a sheet of paper."""
_BREAKS = re.compile(
    r"(?P<open>\\left\\?.|\\begin\{\w+\}|[{(\[])|(?P<close>\\right\\?.|\\end\{\w+\}|[})\]])"
    r"|\\;(?P<arrow> ?\\(?:Rightarrow|longrightarrow))|(?P<sign> [+>-] )|(?P<gap>\\q?quad )"
)
"""Where a formula may go on in the next line, outside all brackets."""


def render(report: Report) -> str:
    """The whole page."""
    files = ", ".join(dict.fromkeys(result.file.path for result in report.gate))
    about = f"Gains of {files} on {report.robot.name}"
    by_heading: dict[str, list[ClaimRow]] = {}
    used_by: dict[str, list[str]] = {}  # by the anchor of a claim those that use it
    for row in report.every_claim:
        by_heading.setdefault(row.heading, []).append(row)
        for name in row.uses:
            users = used_by.setdefault(anchor(row.proof, name), [])
            if (own := anchor(row.proof, row.id)) not in users:
                users.append(own)
    groups = [
        (heading, [list(rows) for _, rows in groupby(group, lambda row: (row.proof, row.id))])
        for heading, group in by_heading.items()
    ]
    first = [row for row in report.claims if row.m in (report.ms[0], None)]
    return markup(
        "page.html",
        title=about if report.own else f"Proof check: {report.notes.paper.title}",
        report=report,
        about=about,
        todo=to_do(report),
        figure=partial(_figure, report),
        shown=partial(_shown, report),
        groups=groups,
        here={anchor(row.proof, row.id) for row in report.every_claim},
        used_by=used_by,
        graph=graph(first, report.notes.titles),
        falls=falls(first),
        placed=partial(_placed, report),
        behind_epsilon=[
            (f"{row.name} {kind}", path) for row in report.epsilon for kind, path in row.certificates.items()
        ],
        epsilons=tuple(four_epsilons(report)),
        evidence=(*known(report), *evidence(report), *rests(report)),
        sampled=list(blocks(sampled_section(report), 3)),
    )


def compared_page(document: Document) -> str:
    """What changed since an older report, as a page of its own."""
    return markup("compare.html", title=document.title, body=Markup(whole(document, 1)))


def raw(name: str) -> Markup:
    """A style sheet or script of this folder, as it is."""
    return Markup((resources.files("lyapcheck.report.page") / name).read_text(encoding="utf-8"))


def markup(template: str, **values: Any) -> Markup:
    """A template of this folder with values, all text in them escaped."""
    return Markup(_templates().get_template(template).render(**values))


@cache
def _templates() -> Environment:
    """Templates in which ``output.html.joined`` escapes whatever is not markup."""
    from jinja2 import Environment, PackageLoader, StrictUndefined

    result = Environment(
        loader=PackageLoader("lyapcheck.report", "page"),
        autoescape=True,
        finalize=lambda value: joined(str(value) if isinstance(value, int | float) else value),
        undefined=StrictUndefined,
        trim_blocks=True,
        lstrip_blocks=True,
    )
    verdicts = (badges, chain, route, sentences)
    texts = (anchor, apart, drawn_arm, file_stem, finding_id, latex, lines, quote, raw, sentence)
    result.globals |= {one.__name__: one for one in (*verdicts, *texts)}
    result.globals |= {"findings": findings, "SIGNS": SIGNS, "WEIGHTS": WEIGHTS}
    result.globals |= {"VERDICTS": tuple(Verdict)}
    return result


# --- Figures inside the page, in the colours of the page.


def _figure(report: Report, name: str, caption: str) -> Markup | None:
    """A figure by its name; nothing where there is none."""
    svg = report.figures.get(f"{name}.svg")
    if svg is None:
        return None
    return element("figure", _inline(svg, caption), element("figcaption", caption), class_="drawing")


def _inline(svg: str, words: str) -> Markup:
    """An SVG of matplotlib as part of a page: its black and white are those of the page.

    Equal parts of different figures have equal ids, as these are digests of what they name; all others go.
    """
    text = svg[svg.index("<svg") :]
    text = re.sub(r"<metadata>.*?</metadata>|<!--.*?-->", "", text, flags=re.DOTALL)
    text = re.sub(r' id="(?![pmh][0-9a-f]{10}")[^"]*"', "", text)
    text = re.sub(r'(<svg[^>]*?) width="[^"]*" height="[^"]*"', r"\1", text, count=1)
    text = re.sub(r"(fill|stroke): #(000000|000)\b", r"\1: currentColor", text)
    text = re.sub(r"fill: #ffffff", "fill: none", text)
    text = re.sub(r"stroke: #dddddd", "stroke: var(--grid)", text)
    text = re.sub(r"\n\s*", "\n", text)
    label = element("svg", role="img", aria_label=words)
    return Markup(text.replace("<svg", label.removesuffix("></svg>"), 1).strip())


def _shown(report: Report, result: Iterable[Block]) -> list[Markup]:
    """Blocks of the document with their figures inside the page; errors stand beside the torques already."""

    def inside(block: Figure) -> Markup | None:
        name = PurePosixPath(block.path).stem
        return None if name.endswith("_errors") else _figure(report, name, f"{block.caption}.")

    return list(blocks(result, 4, inside))


# --- One's own arm: what is to be done, and its picture.


def to_do(report: Report) -> list[tuple[str, dict[str, list[str]]]]:
    """Each command once with what it is for, and the tiles that ask for it; what is wrong first."""
    order = ("bad", "warn", "open")
    every = [
        (tile, f"{name}, {tile.subject}" if len(report.tiles) > 1 else tile.subject)
        for name, known in report.tiles.items()
        for tile in known
        if tile.todo[0] and tile.tone in order
    ]
    result: dict[str, dict[str, list[str]]] = {}
    for tile, about in sorted(every, key=lambda one: order.index(one[0].tone)):
        what, command = tile.todo
        result.setdefault(command, {}).setdefault(what, []).append(about)
    return list(result.items())


def drawn_arm(motion: Motion, wide: float = 320.0, margin: float = 14.0) -> dict[str, Any]:
    """The arm at each time as points of a picture, with the size of the picture."""
    points = [point for frame in motion.frames for point in frame]
    points += [(-1.0, -1.0), (1.0, 1.0)] if motion.joint else []  # of a dial, whatever its hand shows
    (left, low), (right, high) = (tuple(map(end, zip(*points, strict=True))) for end in (min, max))
    scale = (wide - 2 * margin) / (max(right - left, high - low) or 1.0)
    frames = [
        [(margin + (x - left) * scale, margin + (high - y) * scale) for x, y in frame]
        for frame in motion.frames
    ]
    size = ((end - start) * scale + 2 * margin for start, end in ((left, right), (low, high)))
    return dict(zip(("width", "height"), size, strict=True)) | {"frames": frames}


# --- Findings and claims.


def finding_id(subject: str) -> str:
    """The anchor of a finding: an id has no spaces."""
    return f"finding-{subject.replace(' ', '-')}"


def lines(formula: str) -> list[str]:
    """A formula in parts, between which a line may end: at an arrow, and of a long one at every sign."""
    result, depth, start = [""], 0, 0
    for found in _BREAKS.finditer(formula):
        depth += bool(found["open"]) - bool(found["close"])
        if not depth and (found["arrow"] or (len(formula) > LONG and (found["sign"] or found["gap"]))):
            result[-1] += formula[start : found.start()]
            # an empty term before a sign keeps its space after it
            result.append(f"{{}}{found['sign']}" if found["sign"] else found["arrow"] or "")
            start = found.end()
    result[-1] += formula[start:]
    return [part.strip() for part in result]


def apart(row: ClaimRow) -> str:
    """How far the two sides of a relation that fails are from each other."""
    witness = row.decision.witness or {}
    low, high = float(witness["left"][0]), float(witness["right"][0])
    if low * high <= 0 or witness["operator"] == "=" or low == high:
        return ""
    ratio = low / high
    return f" (ratio {ratio:.3g})" if abs(ratio - 1) > NEAR else f" ({abs(ratio - 1):.2%} apart)"


def _placed(report: Report, place: str) -> list[Markup | str]:
    """Where the paper says it, the numbers of formulas as links to them."""
    parts = re.split(r"(\(\d+\))", place)
    known = {f"({number})": f"#equation-{number}" for number in report.notes.equations}
    return [element("a", part, href=known[part]) if part in known else part for part in parts]


# --- The claims and what they rest on, as a picture whose boxes are links.


WIDE, HIGH = 138, 34
ACROSS, DOWN = 184, 42
MARGIN = 8
LETTERS = 22
"""The longest title that fits a box."""


def graph(rows: Sequence[ClaimRow], titles: Mapping[str, str]) -> Markup:
    """Each claim that uses another or is used, right of all it uses; a thick line is a link that breaks.

    Args:
        rows: the claims of one proof for one m.
        titles: of claims, in at most ``LETTERS`` letters.
    """
    chosen = tied(rows)
    at = {name: (MARGIN + x * ACROSS, MARGIN + (y + 0.5) * DOWN) for name, (x, y) in layout(chosen).items()}
    width, height = (max((end[k] for end in at.values()), default=0.0) + MARGIN for k in (0, 1))
    return markup(
        "graph.html",
        rows=chosen,
        at=at,
        titles=titles,
        width=width + WIDE,
        height=height + HIGH,
        wide=WIDE,
        high=HIGH,
    )


def falls(rows: Sequence[ClaimRow]) -> list[tuple[ClaimRow, list[ClaimRow]]]:
    """The refuted claims that others rest on, each with all that falls with it, directly or not."""
    result = [
        (row, [one for one in rows if one.id != row.id and row.id in behind(one.id, rows)])
        for row in rows
        if row.verdict is Verdict.REFUTED
    ]
    return [(row, fallen) for row, fallen in result if fallen]


def tied(rows: Sequence[ClaimRow]) -> list[ClaimRow]:
    """The claims that use another one of the list, or are used by one."""
    known = {row.id for row in rows}
    used = {name for row in rows for name in row.uses if name in known}
    result = [row for row in rows if row.id in used or set(row.uses) & known]
    return [replace(row, uses=tuple(name for name in row.uses if name in known)) for row in result]


def layout(rows: Sequence[ClaimRow]) -> dict[str, tuple[float, float]]:
    """Columns by the longest way to a claim that uses nothing, rows near the claims that are used."""
    uses = {row.id: row.uses for row in rows}

    def depth(name: str) -> int:
        return 1 + max(map(depth, uses[name]), default=-1)

    columns: dict[int, list[str]] = {}
    for name in uses:
        columns.setdefault(depth(name), []).append(name)
    tallest = max(map(len, columns.values()), default=0)
    places: dict[str, tuple[float, float]] = {}
    for column in sorted(columns):
        heights = {
            name: sum(places[used][1] for used in uses[name]) / max(len(uses[name]), 1)
            for name in columns[column]
        }
        step = tallest / len(heights)
        for k, name in enumerate(sorted(heights, key=lambda name: heights[name])):
            places[name] = float(column), (k + 0.5) * step - 0.5
    return places
