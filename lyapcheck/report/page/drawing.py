"""Figures inside the page, in the colours of the page."""

from __future__ import annotations

import re

from lyapcheck.output.elements import Markup, element
from lyapcheck.report.model import Report

FORMS = ("svg", "png", "csv")


def figure(report: Report, name: str, caption: str, class_: str = "") -> Markup | None:
    """A figure by its name with a caption and links to its forms; nothing where there is none."""
    text = report.figures.get(f"{name}.svg")
    return drawn(name, text, caption, class_) if isinstance(text, str) else None


def drawn(name: str, text: str, caption: str, class_: str = "") -> Markup:
    """A figure by its SVG, with a caption and links to its forms in ``figures``."""
    links = [element("a", form.upper(), href=f"figures/{name}.{form}") for form in FORMS]
    words = element(
        "figcaption", caption, " ", element("span", [[" ", link] for link in links], class_="forms")
    )
    return element("figure", inline(text, caption), words, class_=f"drawing {class_}".strip())


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
