"""The report as HTML pages: no script, no network, equations as MathML."""

from __future__ import annotations

from importlib import resources
from typing import Any

from lyapcheck.output.escapes import html_text
from lyapcheck.report.model import Report
from lyapcheck.report.templating import environment


def render(report: Report) -> dict[str, str]:
    """``index.html``, one page for each m, and the style sheet."""
    env = environment(html_text)
    env.filters["mathml"] = mathml
    pages = {"style.css": _style(), "index.html": env.get_template("index.html.j2").render(report=report)}
    for m in report.ms:
        page = env.get_template("member.html.j2").render(report=report, view=report.of(m))
        pages[f"m{m}.html"] = page
    return pages


def mathml(latex: str) -> Any:
    """A LaTeX expression as MathML markup; one expression at a time, never an ``aligned`` block."""
    from latex2mathml.converter import convert
    from markupsafe import Markup

    return Markup(convert(latex, display="block"))


def _style() -> str:
    return (resources.files("lyapcheck.report") / "templates" / "style.css").read_text(encoding="utf-8")
