"""The first screen: citation, three sentences, four badges, and the proof as one picture."""

from __future__ import annotations

from collections.abc import Sequence

from lyapcheck.output.elements import Markup, element
from lyapcheck.output.mathml import latex, sentence
from lyapcheck.report.model import Report, anchor
from lyapcheck.report.verdict import VerdictBox, badges, chain, route, sentences

LEGEND = (
    "Green: shown. Red: refuted, and the proof rests on it. Amber: wrong, but can be mended. "
    "Grey: not shown this way."
)
SIGNS = {"good": "✓", "bad": "✗", "warn": "!", "open": "?"}


def verdict_section(report: Report) -> Markup:
    """What a reader must know, on one screen."""
    return element(
        "section",
        _title(report),
        element("ul", [_badge(b.subject, b.word, b.tone) for b in badges(report)], class_="badges"),
        element("div", [element("p", sentence(text)) for text in sentences(report)], class_="lead"),
        None if report.own else _picture(report),
        id="verdict",
    )


def _title(report: Report) -> list[Markup]:
    paper = report.notes.paper
    if report.own:
        about = element("p", f"{report.robot.title}, m = {', '.join(map(str, report.ms))}.", class_="cite")
        link = element("p", "Controller and conditions: ", paper.citation, ".", class_="cite")
        return [element("h1", f"Gains on {report.robot.name}"), about, link]
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
