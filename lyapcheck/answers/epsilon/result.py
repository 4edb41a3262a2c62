"""The four ε₀ of one gain set, and those of several, as answers."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from functools import partial
from typing import TYPE_CHECKING, Any

from lyapcheck.answers.assumed import arm_words
from lyapcheck.answers.epsilon.four import FINDINGS, FourEpsilons, eps0_of
from lyapcheck.answers.epsilon.words import (
    INFINITE_RATE,
    KINDS,
    exact,
    first_remarks,
    notes,
    number_cell,
    numbers_table,
    ratio_text,
    remarks,
    said_of,
    title,
    witness_text,
)
from lyapcheck.output.answer import Annotation, Answer, Level
from lyapcheck.output.digits import decimals
from lyapcheck.output.document import Bullets, Document, Section, Table, command

if TYPE_CHECKING:
    from lyapcheck.control.gains import GainFile
    from lyapcheck.search.falsify import RisingState
    from lyapcheck.search.weights import Weighted

_DIGITS = 20
CERTIFIED, FALSIFIED = "certified", "falsified"
RULES = {
    CERTIFIED: "V > 0 and dV/dt < 0 at all states but the origin, for some ε₀ > 0",
    FALSIFIED: "a state with dV/dt > 0",
    **FINDINGS,
}
HEADS = ("gains", "m", *(f"{kind} ε₀" for kind in KINDS), "certified / falsified")
NOT_IN_RECORDS = ("corner", "outside", "findings", "assumptions")
PARTS = ("witness", "weighted")
"""What takes several columns where there is any."""


def result_data(result: FourEpsilons) -> dict[str, Any]:
    """Numbers as exact decimal strings; a missing one is ``None`` and has its reason under ``reasons``."""
    return {
        "name": result.name,
        "m": result.m,
        "robot": result.robot,
        **{kind: exact(getattr(result, kind)) for kind in KINDS},
        "scalar_grade": result.scalar_grade,
        "ratio": ratio_text(result.ratio),
        "certified_by": result.certified_by or None,
        "witness": None if result.witness is None else _witness(result.witness),
        "boxes": result.boxes,
        "weighted": None if result.weighted is None else _weighted(result.weighted),
        "ranges": result.ranges,
        "unvaried": exact(eps0_of(result.unvaried)),
        "outside": list(result.outside),
        "corner": {name: exact(value) for name, value in result.corner.items()},
        "seed": result.seed,
        "findings": list(result.findings),
        "reasons": dict(result.reasons),
        "assumptions": list(result.assumptions),
    }


def _weighted(weighted: Weighted) -> dict[str, Any]:
    loop = weighted.proof.loop
    return {
        "eps0": exact(loop.eps0),
        "lambda": [exact(scale) for scale in loop.Lambda],
        "eps0_lambda": [exact(value) for value in weighted.products],
        "boxes": weighted.proof.boxes,
        "states": weighted.states,
    }


def _witness(witness: RisingState) -> dict[str, Any]:
    state = {name: [exact(x) for x in getattr(witness.state, name)] for name in ("q", "e", "w")}
    rate = dict(zip(("lower", "upper"), decimals(witness.rate, _DIGITS), strict=True))
    return {"eps0": exact(witness.eps0), **state, "rate": rate, "kind": witness.kind}


def annotations_of(result: FourEpsilons, file: GainFile | None) -> list[Annotation]:
    """Whether an ε₀ is certified; then, as remarks, what is falsified and what follows from the numbers."""
    about = partial(Annotation, group=result.name, **({} if file is None else file.spot(result.gains)))
    level = Level.UNDECIDED if result.promise is None else Level.PASSED
    message = f"no ε₀ is certified: {result.reasons.get(CERTIFIED, '')}" if result.promise is None else ""
    outcome = [about(level=level, rule=CERTIFIED, rule_text=RULES[CERTIFIED], case="ε₀", message=message)]
    said = {} if result.witness is None else {FALSIFIED: f"falsified {witness_text(result.witness)}"}
    said |= {rule: text for rule, text in FINDINGS.items() if text in result.findings}
    outcome += [
        about(level=Level.REMARK, rule=rule, rule_text=RULES[rule], case="ε₀", message=text)
        for rule, text in said.items()
    ]
    return outcome


@dataclass(frozen=True)
class EpsilonResult(FourEpsilons, Answer):
    """The four ε₀ of one gain set as an answer. `FourEpsilons` has the fields."""

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
        """The four numbers, and in detail what stands behind them."""
        rows = tuple(self._row(result, time) for result, time in self._timed())
        heads = HEADS if self.seconds is None else (*HEADS, "seconds")
        behind = [Section(result.name, (Bullets(tuple(remarks(result))),)) for result in self.results]
        every = Table(heads, rows)
        single = len(self.results) == 1 and self.seconds is None
        short = [numbers_table(self.results[0])] if single else [every]
        promises = [one.promise for one in self.results if one.promise is not None]
        lead = [INFINITE_RATE] + ([said_of(self.results[0])] if len(self.results) == 1 else [])
        arm = (self.file.robot if self.file else None) or (self.results[0].robot if self.results else "")
        count = sum(len(one.assumptions) for one in self.results[:1])
        listed = command("robot", *arm_words(arm), "--assumptions") if arm else ""
        then = command("gate", self.file.path, "--condition", "scalar") if self.file else ""
        return Document(
            title(self.results),
            (*short, *([Bullets(lines)] if (lines := first_remarks(self.results)) else [])),
            tuple(notes(self.results)),
            tuple(filter(None, lead)) if promises else (INFINITE_RATE,),
            (*([every] if single else []), *behind),
            f"{count} assumptions about the arm: {listed}" if count else "",
            then,
        )

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
