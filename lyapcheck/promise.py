"""The one way to a word of proof: a question, and a judged statement that the checker lets answer it."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from dataclasses import dataclass
from typing import Any, Protocol

from lyapcheck.check.covers import require_covered
from lyapcheck.check.refusal import Refused, require
from lyapcheck.check.statement import Statement


class Judged(Protocol):
    """A statement with the verdict of the checker: ``proved``, ``refuted`` or ``undecided``."""

    @property
    def statement(self) -> Statement:
        """What was judged."""

    @property
    def shown(self) -> str:
        """The verdict."""


@dataclass(frozen=True)
class Promise:
    """A sentence may promise what is asked, since it is shown.

    Args:
        asked: the question as data: the arm with every range, the gains, the number that is printed.
        shown: the statement that answers it, with the verdict of the checker.

    Raises:
        Refused: the statement is not proved, or it does not answer the question.

    Soundness: ``shown`` is the outcome of ``lyapcheck.check.verify``; ``lyapcheck.check.covers`` compares.
    """

    asked: Statement
    shown: Judged

    def __post_init__(self) -> None:
        require(self.shown.shown == "proved", "verdict", self.shown.shown, "must be proved")
        require_covered(self.shown.statement, self.asked)

    def says(self, words: str) -> str:
        """Words of proof about what was asked; the only place that may write them.

        Tests replace it, so that they find every other way to such a word.
        """
        return words


def promised(asked: Statement, shown: Judged) -> tuple[Promise | None, str]:
    """A promise, or why there is none: the statement is open, or about something else."""
    try:
        return Promise(asked, shown), ""
    except Refused as refused:
        return None, f"what is proved does not answer the question ({refused})"


def told(promise: Promise | None, data: Any) -> Any:
    """Plain data, with the promise's word for each text in it; as they are where there is no promise."""
    if promise is None:
        return data
    if isinstance(data, str):
        return promise.says(data)
    if isinstance(data, Mapping):
        return {name: told(promise, part) for name, part in data.items()}
    return [told(promise, part) for part in data] if isinstance(data, (list, tuple)) else data


def all_say(promises: Iterable[Promise | None], words: str) -> str:
    """Words of proof that rest on several promises at once.

    Raises:
        Refused: one is missing, or there is none.
    """
    every = list(promises)
    require(len(every) > 0, "promises", 0, "must be one or more")
    for one in every:
        require(one is not None, "promise", "", "is missing")
        assert one is not None
        words = one.says(words)
    return words
