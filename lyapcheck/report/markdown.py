"""The report as Markdown, for a repository or a pull request."""

from __future__ import annotations

import re

from lyapcheck.output.escapes import markdown_text
from lyapcheck.report.model import Report
from lyapcheck.report.templating import environment


def render(report: Report) -> dict[str, str]:
    """``report.md`` and one file for each m."""
    env = environment(markdown_text)
    pages = {"report.md": env.get_template("index.md.j2").render(report=report)}
    for m in report.ms:
        pages[f"m{m}.md"] = env.get_template("member.md.j2").render(report=report, view=report.of(m))
    return {name: _tidy(page) for name, page in pages.items()}


def _tidy(page: str) -> str:
    """No more than one empty line in a row."""
    return re.sub(r"\n{3,}", "\n\n", page).strip() + "\n"
