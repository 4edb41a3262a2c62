"""The four ε₀ of one gain set, and those of several, as answers."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

from lyapcheck.answers.epsilon.annotations import annotations_of
from lyapcheck.answers.epsilon.data import result_data
from lyapcheck.answers.epsilon.four import FourEpsilons
from lyapcheck.answers.epsilon.words import (
    KINDS,
    notes,
    number_cell,
    ratio_text,
    remarks,
    title,
)
from lyapcheck.output.answer import Answer
from lyapcheck.output.document import Bullets, Document, Section, Table

if TYPE_CHECKING:
    from lyapcheck.control.gains import GainFile
    from lyapcheck.output.annotations import Annotation

HEADS = ("gains", "m", *(f"{kind} ε₀" for kind in KINDS), "certified / falsified")
NOT_IN_RECORDS = ("corner", "outside", "findings", "assumptions")
PARTS = ("witness", "weighted")
"""What takes several columns where there is any."""


@dataclass(frozen=True)
class EpsilonResult(FourEpsilons, Answer):
    """The four ε₀ of one gain set as an answer; see `FourEpsilons` for what it has."""

    schema = "lyapcheck/epsilon/1"

    def document(self) -> Document:
        """The numbers, and what stands behind each."""
        return EpsilonResults((self,)).document()

    def data(self) -> dict[str, Any]:
        """As of several gain sets."""
        return EpsilonResults((self,)).data()

    def records(self) -> list[dict[str, Any]]:
        """One row."""
        return EpsilonResults((self,)).records()

    def annotations(self) -> list[Annotation]:
        """Whether an ε₀ is certified, without the place of the gain set."""
        return EpsilonResults((self,)).annotations()


@dataclass(frozen=True)
class EpsilonResults(Answer):
    """The four ε₀ of each of several gain sets.

    Args:
        results: one a gain set.
        file: where the gain sets stand.
        seconds: how long each took, where that was asked for.
    """

    schema = EpsilonResult.schema

    results: tuple[EpsilonResult, ...]
    file: GainFile | None = None
    seconds: Sequence[float] | None = None

    def document(self) -> Document:
        """A row a gain set, and what stands behind its numbers."""
        rows = tuple(self._row(result, time) for result, time in self._timed())
        heads = HEADS if self.seconds is None else (*HEADS, "seconds")
        behind = [Section(result.name, (Bullets(tuple(remarks(result))),)) for result in self.results]
        return Document(title(self.results), (Table(heads, rows), *behind), tuple(notes(self.results)))

    def data(self) -> dict[str, Any]:
        """``results: [{name, m, published, scalar, certified, falsified, ratio, witness, boxes, …}]``."""
        rows = [
            result_data(result) | ({} if time is None else {"seconds": round(time, 3)})
            for result, time in self._timed()
        ]
        return {"results": rows}

    def records(self) -> list[dict[str, Any]]:
        """A row a gain set, with the witness and the reasons."""
        return [
            {
                key: value
                for key, value in row.items()
                if key not in NOT_IN_RECORDS and not (value is None and key in PARTS)
            }
            for row in self.data()["results"]
        ]

    def annotations(self) -> list[Annotation]:
        """A case a gain set: whether an ε₀ is certified; what is falsified is a remark."""
        return [one for result in self.results for one in annotations_of(result, self.file)]

    def _row(self, result: EpsilonResult, seconds: float | None) -> tuple[str, ...]:
        name = result.name, "—" if result.m is None else str(result.m)
        numbers = (number_cell(result, kind) for kind in KINDS)
        time = () if seconds is None else (f"{seconds:.2f}",)
        return (*name, *numbers, ratio_text(result.ratio) or "—", *time)

    def _timed(self) -> Iterator[tuple[EpsilonResult, float | None]]:
        times = [None] * len(self.results) if self.seconds is None else self.seconds
        return zip(self.results, times, strict=True)
