"""The page as a whole: head, navigation, sections, script."""

from __future__ import annotations

from importlib import resources

from lyapcheck.output.html import page
from lyapcheck.output.mathml import Markup, element
from lyapcheck.report.model import Report
from lyapcheck.report.page.claims import claims_section
from lyapcheck.report.page.front import findings_section, verdict_section
from lyapcheck.report.page.gains import derive_section, evidence_section, gains_section

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
