"""The page as a whole: head, navigation, sections, script."""

from __future__ import annotations

import re
from collections.abc import Sequence
from importlib import resources

from lyapcheck.output.html import fold, page
from lyapcheck.output.mathml import Markup, element, latex, sentence
from lyapcheck.report.model import SIGNS, WEIGHTS, Finding, Report, WitnessRow, anchor
from lyapcheck.report.page.claims import claims_section
from lyapcheck.report.page.gains import derive_section, evidence_section, figure, gains_section
from lyapcheck.report.page.own import first_screen
from lyapcheck.report.text import SYMBOLS, member_words, witness_place, witness_sides
from lyapcheck.report.verdict import VerdictBox, badges, chain, route, sentences

SECTIONS = {
    "verdict": "Verdict",
    "findings": "Findings",
    "claims": "Claims",
    "derive": "Derivation",
    "gains": "Gains",
    "evidence": "Evidence",
}


def render(report: Report) -> str:
    """The whole page: no file, no network and no script is needed to read it."""
    paper = report.notes.paper
    title = f"Gains on {report.robot.name}" if report.own else paper.title
    sections = (
        verdict_section(report),
        findings_section(report),
        claims_section(report),
        derive_section(report),
        gains_section(report),
        evidence_section(report),
    )
    body = (
        element("a", "Skip to the findings", href="#findings", class_="skip"),
        element("header", _navigation(), class_="bar"),
        element("main", sections),
        element("script", raw("page.js")),
    )
    return page(f"Proof check: {title}", body, (raw("style.css"), _members(report)))


def raw(name: str) -> Markup:
    """A style sheet or script of this folder, as it is."""
    return Markup((resources.files("lyapcheck.report.page") / name).read_text(encoding="utf-8"))


def redirect(m: int) -> str:
    """What stands where the page of one member was: a link to the claims of the whole page."""
    target = f"index.html#m{m}"
    elsewhere = element("meta", http_equiv="refresh", content=f"0; url={target}")
    return page(f"m = {m}", element("a", f"m = {m}", href=target), meta=elsewhere)


def _navigation() -> Markup:
    links = (element("a", words, href=f"#{name}") for name, words in SECTIONS.items())
    return element("nav", links, aria_label="Sections")


def _members(report: Report) -> Markup:
    """The switch of m without any script: a member that is chosen hides what is about others."""
    rules = (f'body:has(#m{m}:checked) [data-m]:not([data-m="{m}"]){{display:none}}' for m in report.ms)
    return Markup("\n".join(rules))


# --- The first screen: citation, three sentences, four badges, and the proof as one picture.


LEGEND = (
    "Green: shown. Red: refuted, and the proof rests on it. Amber: wrong, but can be mended. "
    "Grey: not shown this way."
)


def verdict_section(report: Report) -> Markup:
    """What a reader must know, on one screen."""
    if report.own:
        return element("section", _title(report), first_screen(report), id="verdict")
    return element(
        "section",
        _title(report),
        element("ul", [_badge(b.subject, b.word, b.tone) for b in badges(report)], class_="badges"),
        element("div", [element("p", sentence(text)) for text in sentences(report)], class_="lead"),
        _picture(report),
        id="verdict",
    )


def _title(report: Report) -> list[Markup]:
    paper = report.notes.paper
    if report.own:
        about = element("p", f"{report.robot.title}, m = {', '.join(map(str, report.ms))}.", class_="cite")
        link = element("p", "Controller and conditions: ", paper.citation, ".", class_="cite")
        files = ", ".join(dict.fromkeys(result.file.path for result in report.gate))
        return [element("h1", f"Gains of {files} on {report.robot.name}"), about, link]
    cite = element("p", paper.authors, ", ", paper.source, class_="cite")
    formula = element("div", [latex(part) for part in paper.controller.split(r"\qquad")], class_="controller")
    return [element("p", "Proof check of", class_="eyebrow"), element("h1", paper.title), cite, formula]


def _badge(subject: str, word: str, tone: str) -> Markup:
    return element(
        "li", element("b", subject), element("span", f"{SIGNS[tone]} {word}"), class_=f"badge {tone}"
    )


def _picture(report: Report) -> Markup:
    steps, around = chain(report), route(report)
    labels = [step.box.label for step in steps]
    start = labels.index(around[0].box.after) if around and around[0].box.after in labels else 0
    printed = element("ol", _boxes(steps, 1), class_="chain", aria_label="The printed proof")
    rows = [element("p", "The printed proof", class_="row-title"), printed]
    if around:
        rows += [
            element("p", "The way round", class_="row-title"),
            element("ol", _boxes(around, start + 2), class_="chain around", aria_label="The way round"),
        ]
    caption = element("figcaption", LEGEND)
    return element("figure", rows, caption, class_="picture", style=f"--steps:{len(steps)}")


def _boxes(steps: Sequence[VerdictBox], first: int) -> list[Markup]:
    result = []
    for k, step in enumerate(steps):
        inner = (
            element("b", step.box.label),
            element("span", step.box.title),
            element("small", f"{SIGNS[step.tone]} {step.word}"),
        )
        link = element("a", inner, href=f"#{anchor(step.box.proof, step.box.claims[-1])}")
        column = str(first + k)
        if first > 1 and k >= len(steps) - 2:  # the way round ends where the printed proof does
            column = "-2" if k == len(steps) - 1 else f"{column} / -2"
        result.append(element("li", link, class_=step.tone, style=f"grid-column:{column}"))
    return result


# --- Findings by weight: what breaks the proof and what is wrong as cards, misprints and experiment folded.


FOLDED = ("C", "D")
_ARROW = re.compile(r"\s*\\;\s*(?=\\(?:Rightarrow|longrightarrow))")
"""Where a formula may go on in the next line."""
DAMPING = "λmax(K_v) of each gain set, and λmin(B)/(√n γ): the largest that the condition admits."
NEAR = 0.05
"""Sides that differ by less than this share of each other are told apart by their difference."""


def findings_section(report: Report) -> Markup:
    """Everything that is not confirmed, the heaviest first."""
    title, nothing = "Findings", "Everything that was decided is confirmed."
    if report.own:
        title, nothing = ("What to mend", "No condition is broken, and no Property of the arm is refuted.")
    groups = [_group(report, weight) for weight in WEIGHTS if report.weighing(weight)]
    found = groups or element("p", nothing)
    return element("section", element("h2", title), found, _by_size(report), id="findings")


def _by_size(report: Report) -> Markup | None:
    """The claims whose verdict changes with the number of joints."""
    if not report.by_size:
        return None
    ns = list(report.by_size[0].verdicts)
    heads = [element("th", words, scope="col") for words in ("claim", "statement", *(f"n = {n}" for n in ns))]
    rows = []
    for row in report.by_size:
        member = [] if row.m is None else [f", m = {row.m}"]
        cells = [
            element("td", f"{SYMBOLS[row.verdicts[n]]} {row.verdicts[n]}", data_label=f"n = {n}") for n in ns
        ]
        name = element("th", element("a", row.id, href=f"#{row.id}"), member, scope="row")
        rows.append(element("tr", name, element("td", sentence(row.comment)), cells))
    words = f"Verdicts that change with the number of joints n, asked for n = {ns[0]} to {ns[-1]}"
    table = element("table", element("thead", element("tr", heads)), element("tbody", rows))
    return fold(
        f"{words} ({len(rows)})",
        element("div", table, class_="scroll", tabindex="0", role="region", aria_label=words),
    )


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
    tone = {"A": "bad", "E": "open"}.get(finding.weight, "warn")
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
    drawn = figure(report, finding.figure, DAMPING) if finding.figure else None
    numbers = [_witness(finding.witness) if finding.witness else element("p", finding.text), drawn]
    left = element("div", printed, element("dl", parts), class_="said")
    right = element("div", numbers, _again(finding), class_="shown")
    return element("article", head, element("div", left, right, class_="two"), class_=f"card {tone}")


def _witness(witness: WitnessRow) -> Markup:
    where, sides = ", ".join(witness_place(witness)), witness_sides(witness)
    rest = "; all else 0" if "0" in witness.point.values() else ""
    low, high = float(witness.left[0]), float(witness.right[0])
    if low * high > 0 and witness.operator != "=":
        ratio = low / high
        sides += f" (ratio {ratio:.3g})" if abs(ratio - 1) > NEAR else f" ({abs(ratio - 1):.2%} apart)"
    return element(
        "div",
        element("p", element("b", "A witness"), ": ", sentence(where), rest, "."),
        element("p", sides, class_="sides"),
        class_="witness",
    )


def _again(finding: Finding) -> Markup | None:
    """The command that decides it again, and its certificate."""
    if not finding.claims:
        return None
    ms = f" --m {','.join(map(str, finding.ms))}" if finding.ms else ""
    command = f"lyapcheck check published.py --only {finding.claims[0]}{ms}"
    path = finding.witness.certificate if finding.witness else None
    link = element("a", "its certificate", href=path) if path else None
    return element("p", element("code", command), [" ", link] if link else None, class_="again")
