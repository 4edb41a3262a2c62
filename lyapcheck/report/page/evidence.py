"""What SymPy derives; what the verdicts rest on: ε₀ between brackets, the runs, digests and seeds."""

from __future__ import annotations

from collections.abc import Iterable
from pathlib import PurePosixPath

from lyapcheck.output.document import Block, Figure, Section
from lyapcheck.output.elements import Markup, element
from lyapcheck.output.html import blocks, fold
from lyapcheck.report.evidence import evidence, four_epsilons, known, rests
from lyapcheck.report.model import Report
from lyapcheck.report.page.drawing import figure


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
