"""The Jinja environment of the documents."""

from __future__ import annotations

from importlib import resources
from itertools import groupby
from typing import Any

from lyapcheck.report import text
from lyapcheck.report.drawings import file_stem


def environment(escape: bool) -> Any:
    """An environment with the templates, strict about names, and the words of ``lyapcheck.report.text``."""
    from jinja2 import Environment, FileSystemLoader, StrictUndefined

    folder = str(resources.files("lyapcheck.report") / "templates")
    env = Environment(
        loader=FileSystemLoader(folder),
        autoescape=escape,
        undefined=StrictUndefined,
        trim_blocks=True,
        lstrip_blocks=True,
        keep_trailing_newline=True,
    )
    env.globals.update(SYMBOLS=text.SYMBOLS, plural=text.plural, tally=text.tally)
    env.filters.update(number=text.number, fixed=text.fixed, bracket=text.bracket, joined=text.joined)
    env.filters.update(
        listed=text.listed, together=text.together, sections=sections, cell=cell, stem=file_stem
    )
    return env


def sections(claims: Any) -> list[tuple[str, list[Any]]]:
    """Claims grouped by the paper's sections, in the order of the text."""
    return [(name, list(rows)) for name, rows in groupby(claims, key=lambda row: row["section"] or "Claims")]


def cell(value: Any) -> str:
    """A text that may stand in a Markdown table."""
    return str(value).replace("|", "\\|").replace("\n", " ")
