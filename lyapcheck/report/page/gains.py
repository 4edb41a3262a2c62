"""The simulated run of each gain set, what SymPy derives, and the evidence."""

from __future__ import annotations

import re
from collections.abc import Iterable
from pathlib import PurePosixPath

from lyapcheck.output.document import Block, Figure, Section
from lyapcheck.output.html import blocks, fold
from lyapcheck.output.mathml import Markup, element
from lyapcheck.report.evidence import evidence, four_epsilons, known, rests
from lyapcheck.report.model import Report
from lyapcheck.report.plots_of_runs import file_stem
from lyapcheck.report.verdict import sampled_section

# --- Figures inside the page, in the colours of the page.


FORMS = ("svg", "png", "csv")


def figure(report: Report, name: str, caption: str) -> Markup | None:
    """A figure by its name; nothing where there is none."""
    text = report.figures.get(f"{name}.svg")
    return drawn(name, text, caption) if isinstance(text, str) else None


def drawn(name: str, text: str, caption: str) -> Markup:
    """A figure by its SVG, with a caption and links to its forms in ``figures``."""
    links = [element("a", form.upper(), href=f"figures/{name}.{form}") for form in FORMS]
    words = element(
        "figcaption", caption, " ", element("span", [[" ", link] for link in links], class_="forms")
    )
    return element("figure", inline(text, caption), words, class_="drawing")


def inline(svg: str, words: str) -> Markup:
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
    card = list(blocks(sampled_section(report), 3))
    moving = heading, element("p", *words, class_="quiet"), runs
    sampled = element("div", card, class_="card blocks scroll") if card else None
    return element("section", *moving, sampled, id="gains")


# --- What SymPy derives; what the verdicts rest on: ε₀ between brackets, the runs, digests and seeds.


def derive_section(report: Report) -> Markup:
    """The comparison of SymPy with the checker; the formulas folded."""
    section = report.derived.section()
    formulas = [block for block in section.blocks if isinstance(block, Section)]
    return element(
        "section",
        element("h2", section.title),
        shown(report, section.blocks[: -len(formulas)]),
        [fold(one.title, shown(report, one.blocks)) for one in formulas],
        id="derive",
    )


def evidence_section(report: Report) -> Markup:
    """ε₀ first, all else folded."""
    return element(
        "section",
        element("h2", "Evidence"),
        element("h3", "ε₀ from both sides"),
        shown(report, four_epsilons(report)),
        _certificates(report),
        [
            fold(section.title, shown(report, section.blocks))
            for section in (*known(report), *evidence(report), *rests(report))
        ],
        id="evidence",
    )


def _certificates(report: Report) -> Markup | None:
    """Links to what each ε₀ rests on."""
    parts: list[Markup | str] = []
    for row in report.epsilon:
        for kind, path in row.certificates.items():
            parts += [", " if parts else "", element("a", f"{row.name} {kind}", href=path)]
    return element("p", "Certificates: ", parts, ".") if parts else None


def shown(report: Report, result: Iterable[Block]) -> Markup:
    """Blocks of the document with their figures inside the page; errors stand beside the torques already."""

    def drawn(block: Figure) -> Markup | None:
        name = PurePosixPath(block.path).stem
        return None if name.endswith("_errors") else figure(report, name, f"{block.caption}.")

    return element("div", list(blocks(result, 4, drawn)), class_="blocks scroll")
