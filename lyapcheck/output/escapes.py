"""Text of users inside the formats that commands write: what it says is shown, nothing of it is obeyed.

Everything here takes text that may hold anything; what does not print comes out as an escape.
"""

from __future__ import annotations

import re
from unicodedata import normalize

_HTML = {"&": "&amp;", "<": "&lt;", ">": "&gt;", '"': "&quot;", "'": "&#39;"}
_ENTITIES = {"&": "&amp;", "<": "&lt;", ">": "&gt;"}
_MARKDOWN = re.compile(r"[\\`*\[\]|~#!@&<>]|:(?=\S)|(?<![^\W_])_|_(?![^\W_])")
"""What Markdown would take for its own; an underscore within a word is none."""
_MARKER = re.compile(r"^(\s*\d*)([-+=.)])(?=\s|\2|$)")
"""What begins a list, a line across the page or the line under a heading: ``-``, ``+``, ``1.``, ``---``."""
_LATEX = {
    "\\": r"\textbackslash{}",
    "~": r"\textasciitilde{}",
    "^": r"\textasciicircum{}",
    **{c: f"\\{c}" for c in "&%$#_{}"},
}
_SIGNS = r"""
α alpha β beta γ gamma δ delta ε varepsilon η eta θ theta κ kappa λ lambda μ mu π pi ρ rho σ sigma
τ tau φ varphi χ chi ψ psi ω omega Γ Gamma Δ Delta Θ Theta Λ Lambda Σ Sigma Φ Phi Ψ Psi Ω Omega
∂ partial ∫ int √ surd ≤ le ≥ ge ≠ ne ≈ approx ≻ succ ⪰ succeq ∈ in ∀ forall → to ∞ infty ‖ Vert
· cdot × times ± pm ✓ surd ✗ times ½ frac12 ¼ frac14 − - < < > > | | ′ ^{\prime} ″ ^{\prime\prime}
° ^{\circ} ᵀ ^{T} ᵢ _{i} ₀ _0 ₁ _1 ₂ _2 ₃ _3 ₄ _4 ₅ _5 ₆ _6 ₇ _7 ₈ _8 ₉ _9 ⁰ ^0 ¹ ^1 ² ^2 ³ ^3 ⁴ ^4
⁵ ^5 ⁶ ^6 ⁷ ^7 ⁸ ^8 ⁹ ^9
""".split()  # noqa: SIM905 (a list of these would be a page)
"""Signs of formulas, each with what LaTeX calls it."""
_SIGN = dict(zip(_SIGNS[::2], _SIGNS[1::2], strict=True))
_ACCENTS = {"\u0307": "dot", "\u0308": "ddot", "\u0303": "tilde", "\u0302": "hat"}
_ACCENTED = re.compile(f"([A-Za-z])([{''.join(_ACCENTS)}])")
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
    shown = _MARKDOWN.sub(lambda result: _ENTITIES.get(result[0], f"\\{result[0]}"), printable(text))
    return _MARKER.sub(r"\1\\\2", shown)


def html_text(text: str) -> str:
    """The text as HTML, in an element or in a quoted attribute."""
    return "".join(_HTML.get(c, c) for c in printable(text))


def latex_text(text: str) -> str:
    """The text as LaTeX outside of formulas; signs of formulas as LaTeX writes them."""
    parts = _ACCENTED.split(normalize("NFD", printable(text)))
    result = []
    for plain, letter, accent in zip(parts[::3], [*parts[1::3], ""], [*parts[2::3], ""], strict=True):
        result.append("".join(_LATEX.get(c) or _sign(c) for c in normalize("NFC", plain)))
        if letter:
            result.append(rf"\ensuremath{{\{_ACCENTS[accent]}{{{letter}}}}}")
    return "".join(result)


def _sign(c: str) -> str:
    name = _SIGN.get(c)
    if name is None:
        return c
    return rf"\ensuremath{{\{name}}}" if name[0].isalpha() else rf"\ensuremath{{{name}}}"


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
