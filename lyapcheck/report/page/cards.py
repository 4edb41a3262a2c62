"""Findings by weight: what breaks the proof and what is wrong as cards, misprints and experiment folded."""

from __future__ import annotations

import re

from lyapcheck.output.elements import Markup, element
from lyapcheck.output.html import fold
from lyapcheck.output.mathml import latex, sentence
from lyapcheck.report.model import WEIGHTS, Finding, Report, WitnessRow
from lyapcheck.report.page.drawing import figure
from lyapcheck.report.text import member_words, witness_place, witness_sides

FOLDED = ("C", "D")
_ARROW = re.compile(r"\s*\\;\s*(?=\\(?:Rightarrow|longrightarrow))")
"""Where a formula may go on in the next line."""
NEAR = 0.05
"""Sides that differ by less than this share of each other are told apart by their difference."""


def findings_section(report: Report) -> Markup:
    """Everything that is not confirmed, the heaviest first."""
    title, nothing = "Findings", "Everything that was decided is confirmed."
    if report.own:
        title, nothing = (
            "What to mend",
            "No condition is broken, and no Property of the arm is refuted.",
        )
    groups = [_group(report, weight) for weight in WEIGHTS if report.weighing(weight)]
    return element("section", element("h2", title), groups or element("p", nothing), id="findings")


def _group(report: Report, weight: str) -> Markup:
    result = report.weighing(weight)
    own = {"A": "Must be mended", "B": "Conditions not met"}
    title = f"{own[weight] if report.own else f'{weight} · {WEIGHTS[weight]}'} ({len(result)})"
    if weight in FOLDED:
        rows = [
            element("tr", element("th", f.subject, scope="row"), element("td", _short(f))) for f in result
        ]
        table = element("table", element("tbody", rows), class_="cards-on-phone")
        return fold(title, table)
    return element(
        "div", element("h3", title), [_card(report, one) for one in result], class_=f"weight {weight}"
    )


def _short(finding: Finding) -> list[Markup | str | None]:
    said = sentence(finding.title) if finding.claims else None
    ms = f" ({member_words(finding.ms)})" if finding.ms else ""
    links = [_claim_link(name) for name in finding.claims]
    return [said, ms, ". " if said else None, finding.text, " " if links else None, *links]


def _claim_link(name: str) -> Markup:
    return element("a", f"claim {name}", href=f"#{name}")


def _card(report: Report, finding: Finding) -> Markup:
    tone = "bad" if finding.weight == "A" else "warn"
    head = [
        element(
            "p",
            [[_claim_link(name), " "] for name in finding.claims],
            member_words(finding.ms) if finding.ms or finding.claims else None,
            class_="ids",
        ),
        element("h4", finding.title, id=f"finding-{finding.subject.replace(' ', '-')}"),
    ]
    if not finding.about:
        return element("article", head, element("p", finding.text), class_=f"card {tone}")
    parts = [[element("dt", term), element("dd", sentence(text))] for term, text in finding.about.items()]
    lines = [latex(line) for line in _ARROW.split(finding.printed)] if finding.printed else []
    printed = element("div", lines, class_="printed") if lines else None
    drawn = figure(report, finding.figure, _caption(report, finding)) if finding.figure else None
    numbers = [_witness(finding.witness) if finding.witness else element("p", finding.text), drawn]
    left = element("div", printed, element("dl", parts), class_="said")
    right = element("div", numbers, _again(finding), class_="shown")
    return element("article", head, element("div", left, right, class_="two"), class_=f"card {tone}")


def _caption(report: Report, finding: Finding) -> str:
    note = next((n for n in report.notes.findings if set(n.claims) & set(finding.claims)), None)
    left, right = (note.left, note.right) if note else ("left side", "right side")
    if not finding.figure.startswith("sides"):
        return f"{left} of each gain set, and {right}: the largest that the condition admits."
    return f"Solid: {left}. Dashed: {right}. Shaded: where the statement fails."


def _witness(witness: WitnessRow) -> Markup:
    where, sides = ", ".join(witness_place(witness)), witness_sides(witness)
    rest = "; all else 0" if "0" in witness.point.values() else ""
    low, high = float(witness.left[0]), float(witness.right[0])
    if low * high > 0 and witness.operator != "=":
        ratio = low / high
        sides += f" (ratio {ratio:.3g})" if abs(ratio - 1) > NEAR else f" ({abs(ratio - 1):.2%} apart)"
    title = "A small witness" if witness.small else "A witness"
    return element(
        "div",
        element("p", element("b", title), ": ", sentence(where), rest, "."),
        element("p", sides, class_="sides"),
        class_="witness",
    )


def _again(finding: Finding) -> Markup | None:
    """The command that decides it again, and its certificate."""
    if not finding.claims:
        return None
    ms = f" --m {','.join(map(str, finding.ms))}" if finding.ms else ""
    small = finding.witness is not None and finding.witness.small and finding.witness.n
    size = f" --n {finding.witness.n}" if small and finding.witness and finding.witness.n != 3 else ""
    command = f"lyapcheck check published.py --only {finding.claims[0]}{ms}{size}"
    path = finding.witness.certificate if finding.witness else None
    link = element("a", "its certificate", href=path) if path else None
    return element("p", element("code", command), [" ", link] if link else None, class_="again")
