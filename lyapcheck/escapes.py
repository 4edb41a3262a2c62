"""Text of users inside the formats that commands write: what it says is shown, nothing of it is obeyed.

Everything here takes text that may hold anything; what does not print comes out as an escape.
"""

from __future__ import annotations

import re

from lyapcheck.files.printable import printable

_HTML = {"&": "&amp;", "<": "&lt;", ">": "&gt;", '"': "&quot;", "'": "&#39;"}
_ENTITIES = {"&": "&amp;", "<": "&lt;", ">": "&gt;"}
_MARKDOWN = re.compile(r"[\\`*\[\]|~#!@&<>]|:(?=\S)|(?<![^\W_])_|_(?![^\W_])")
"""What Markdown would take for its own; an underscore within a word is none."""
_LATEX = {
    "\\": r"\textbackslash{}",
    "~": r"\textasciitilde{}",
    "^": r"\textasciicircum{}",
    **{c: f"\\{c}" for c in "&%$#_{}"},
}
_FORMULA = ("=", "+", "-", "@")
"""What spreadsheets take for the beginning of a formula."""


def markdown_text(text: str) -> str:
    """The text as Markdown that shows it, on one line and in one cell."""
    return _MARKDOWN.sub(lambda found: _ENTITIES.get(found[0], f"\\{found[0]}"), printable(text))


def html_text(text: str) -> str:
    """The text as HTML, in an element or in a quoted attribute."""
    return "".join(_HTML.get(c, c) for c in printable(text))


def latex_text(text: str) -> str:
    """The text as LaTeX outside of formulas."""
    return "".join(_LATEX.get(c, c) for c in printable(text))


def csv_text(text: str) -> str:
    """The text as a cell that no spreadsheet computes: one that looks like a formula gets an apostrophe."""
    shown = printable(text)
    return f"'{shown}" if shown.startswith(_FORMULA) else shown


def github_text(text: str) -> str:
    """The text as the message of a GitHub workflow command, in which line ends are allowed."""
    coded = text.replace("%", "%25").replace("\r", "%0D").replace("\n", "%0A")
    return printable(coded)


def github_property(text: str) -> str:
    """The text as the file or the title of a GitHub workflow command."""
    return github_text(text).replace(":", "%3A").replace(",", "%2C")


def plot_text(text: str, most: int = 60) -> str:
    """The text as matplotlib shows it: no formula between dollar signs, and cut where it would not fit."""
    shown = printable(text)
    return (shown if len(shown) <= most else f"{shown[: most - 1]}…").replace("$", r"\$")
