"""The gain sets in short."""

from __future__ import annotations

from lyapcheck.output.elements import Markup, element
from lyapcheck.report.model import Report


def gains_section(report: Report) -> Markup:
    """Sliders and curves."""
    return element("section", element("h2", "Your gains"), id="gains")
