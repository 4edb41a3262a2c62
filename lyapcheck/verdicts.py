"""Verdicts, the grade of the evidence behind them, and the exit codes they lead to."""

from __future__ import annotations

from collections.abc import Iterable
from enum import IntEnum, StrEnum


class Verdict(StrEnum):
    """Result of one claim."""

    PROVED = "proved"
    REFUTED = "refuted"
    UNDECIDED = "undecided"
    ERROR = "error"

    @property
    def sign(self) -> str:
        """The verdict in one character."""
        return {"proved": "✓", "refuted": "✗", "undecided": "?", "error": "!"}[self.value]


class Grade(IntEnum):
    """Quality of the evidence. A chain has its smallest grade."""

    NUMERIC = 1
    """Sampled or floating-point only; never enough for ``proved`` or ``refuted``."""
    ENCLOSURE = 2
    """Ball or outward-rounded interval arithmetic."""
    EXACT = 3
    """Rational arithmetic or a symbolic normal form."""

    @property
    def label(self) -> str:
        """The grade as it is written in outputs."""
        return self.name.lower()


class Exit(IntEnum):
    """The exit codes of every command."""

    PROVED = 0
    REFUTED = 1
    USAGE = 2
    UNDECIDED = 3
    INTERNAL = 4


def exit_code(verdicts: Iterable[Verdict]) -> Exit:
    """The exit code for a set of verdicts: an error outranks a refutation, that an undecided claim.

    No verdict at all is ``UNDECIDED``: nothing was proved.
    """
    result = set(verdicts)
    if Verdict.ERROR in result:
        return Exit.INTERNAL
    if Verdict.REFUTED in result:
        return Exit.REFUTED
    if Verdict.UNDECIDED in result or not result:
        return Exit.UNDECIDED
    return Exit.PROVED


STANDS = ("quoted", "implied", "ours")
"""Whose sentence a claim is: the text's own, one that the text needs or relies on, or one of the script's."""
