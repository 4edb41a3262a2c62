"""The four ε₀ of one gain set on one arm, with what stands behind each; and those of several gain sets."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, field
from fractions import Fraction
from typing import TYPE_CHECKING, Any

from lyapcheck.answers.epsilon.annotations import annotations_of
from lyapcheck.answers.epsilon.data import result_data
from lyapcheck.answers.epsilon.words import (
    KINDS,
    NEARBY_HEADS,
    nearby_row,
    notes,
    number_cell,
    ratio_text,
    remarks,
    title,
)
from lyapcheck.output.answer import Answer
from lyapcheck.output.document import Bullets, Document, Section, Table

if TYPE_CHECKING:
    from lyapcheck.answers.epsilon.nearby import NearbyResult
    from lyapcheck.check.loop.closed_loop import ClosedLoop
    from lyapcheck.control.gains import GainFile, GainSet
    from lyapcheck.output.annotations import Annotation
    from lyapcheck.search.falsify import RisingState
    from lyapcheck.search.proof import DecreaseProof
    from lyapcheck.search.weights import Weighted

HEADS = ("gains", "m", *(f"{kind} ε₀" for kind in KINDS), "certified / falsified")
NOT_IN_RECORDS = ("corner", "findings", "assumptions")
PARTS = ("witness", "weighted", "nearby")
"""What takes several columns where there is any."""


@dataclass(frozen=True)
class Refutation:
    """The closure that a witness refutes, and the values of what is uncertain at the arm it is a state of."""

    loop: ClosedLoop
    viscous: tuple[Fraction, ...]
    parameters: tuple[Fraction, ...]


@dataclass(frozen=True)
class EpsilonResult(Answer):
    """The four ε₀; ``None`` where there is none, with the reason under the same name in ``reasons``.

    Args:
        gains: the gain set.
        robot: name of the arm.
        published: the end of (18), rounded down.
        scalar: ε₀ of the scalar form, from norms.
        certified: the largest ε₀ of which the checker accepted a proof.
        falsified: ε₀ of the witness.
        witness: the state that refutes ``falsified``.
        boxes: how many boxes branch and bound looked at.
        certified_by: which search proposed the proof behind ``certified``.
        proof: behind ``certified``, accepted by the checker.
        scalar_proof: behind ``scalar``, accepted by the checker; ``None`` where norms alone prove less.
        against: what ``witness`` refutes, and the arm it is a state of.
        weighted: a proof with weights Λ in y = w − εΛh, where one was asked for and found.
        ranges: whether this is about all values of what is uncertain about the arm, or the nominal ones.
        corner: the uncertain numbers of the arm that ``witness`` is about, by name.
        reasons: why a number is missing, and what to try.
        findings: what the numbers say about each other, one sentence each.
        assumptions: what is taken for granted about the arm.
        seed: of the sampled states.
        nearby: the ε₀ of states within limits of speed and of error, where they were asked for.
        unvaried: what is certified at nominal numbers, where that was asked for beside ranges.
    """

    schema = "lyapcheck/epsilon/1"

    gains: GainSet
    robot: str
    published: Fraction | None
    scalar: Fraction | None
    certified: Fraction | None
    falsified: Fraction | None
    witness: RisingState | None
    boxes: int
    certified_by: str
    proof: DecreaseProof | None = None
    scalar_proof: DecreaseProof | None = None
    against: Refutation | None = None
    weighted: Weighted | None = None
    ranges: bool = False
    corner: Mapping[str, Fraction] = field(default_factory=dict)
    reasons: Mapping[str, str] = field(default_factory=dict)
    findings: tuple[str, ...] = ()
    assumptions: tuple[str, ...] = ()
    seed: int = 0
    nearby: NearbyResult | None = None
    unvaried: Fraction | None = None

    @property
    def name(self) -> str:
        """Of the gain set."""
        return self.gains.name

    @property
    def m(self) -> int | None:
        """Member of the family, if it has members."""
        return self.gains.m

    @property
    def scalar_grade(self) -> str | None:
        """``enclosure`` where ``scalar`` has a certificate, else ``no certificate``; ``None`` without it."""
        if self.scalar is None:
            return None
        return "no certificate" if self.scalar_proof is None else "enclosure"

    @property
    def ratio(self) -> Fraction | None:
        """certified / falsified: 1 would leave nothing open."""
        if self.certified is None or self.falsified is None:
            return None
        return self.certified / self.falsified

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
        near = [nearby_row(result) for result in self.results if result.nearby is not None]
        tables = (Table(heads, rows), *([Table(NEARBY_HEADS, tuple(near))] if near else []))
        return Document(title(self.results), (*tables, *behind), tuple(notes(self.results)))

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
