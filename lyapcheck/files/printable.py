"""Text of users, fit to be shown on one line of a terminal."""

from __future__ import annotations

UNPRINTABLE = "must be one line of text that prints"
"""What a name or note breaks that holds a line end, a control character, or one that turns the writing."""
RETYPE = "type it anew, without what is shown as an escape"


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
