"""Text of users inside the formats that commands write: what it says is shown, nothing of it is obeyed.

Everything here takes text that may hold anything; what does not print comes out as an escape.
"""

from __future__ import annotations

import re

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


def printable(text: str) -> str:
    """The text with every character that does not print written as an escape, like ``\\n`` or ``\\x1b``.

    So no name can break a line, move the cursor or turn the direction of writing.
    """
    if text.isprintable():
        return text
    return "".join(c if c.isprintable() else c.encode("unicode_escape").decode("ascii") for c in text)


def document_text(text: str) -> str:
    """A whole text or JSON document; what does not print, line ends aside, as JSON escapes it."""
    if text.replace("\n", "").isprintable():
        return text
    return "".join(c if c == "\n" or c.isprintable() else _unit_escapes(c) for c in text)


def _unit_escapes(c: str) -> str:
    """The UTF-16 code units of a character as ``\\uXXXX``."""
    units = c.encode("utf-16-be", "surrogatepass").hex()
    return "".join(f"\\u{units[i : i + 4]}" for i in range(0, len(units), 4))


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
