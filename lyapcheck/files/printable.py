"""Text of users, fit to be shown on one line of a terminal."""

from __future__ import annotations


def printable(text: str) -> str:
    """The text with every character that does not print written as an escape, like ``\\n`` or ``\\x1b``.

    So no name can break a line, move the cursor or turn the direction of writing.
    """
    if text.isprintable():
        return text
    return "".join(c if c.isprintable() else c.encode("unicode_escape").decode("ascii") for c in text)
