"""The formats by name."""

from __future__ import annotations

from enum import StrEnum


class Format(StrEnum):
    """What every answer can be written in."""

    TEXT = "text"
    MARKDOWN = "markdown"
    HTML = "html"
    LATEX = "latex"
    CSV = "csv"
    JSON = "json"


class JudgedFormat(StrEnum):
    """The same, and what systems read that run checks."""

    TEXT = "text"
    MARKDOWN = "markdown"
    HTML = "html"
    LATEX = "latex"
    CSV = "csv"
    JSON = "json"
    SARIF = "sarif"
    JUNIT = "junit"
    GITHUB = "github"
