"""The four ε₀ of one gain set, and those of several, as answers."""

from __future__ import annotations

from abc import abstractmethod
from collections.abc import Iterator
from dataclasses import dataclass
from fractions import Fraction
from functools import partial
from typing import TYPE_CHECKING, Any

from lyapcheck.answers import assumed_line, file_words
from lyapcheck.answers.epsilon.result import (
    CERTIFIED,
    FALSIFIED,
    FourEpsilons,
    eps0_of,
    remarks,
    witness_text,
)
from lyapcheck.files.decimals import decimal_text, decimal_texts
from lyapcheck.output.answer import Annotation, Answer, Level
from lyapcheck.output.digits import at_least, at_most, ends
from lyapcheck.output.document import Bullets, Document, Section, Table, command
from lyapcheck.output.fields import Field, data, records, table
from lyapcheck.promise import all_say

if TYPE_CHECKING:
    from lyapcheck.control.gains import GainFile
    from lyapcheck.search.falsify import RisingState
    from lyapcheck.search.weights import Weighted

KINDS = {
    "published": ("the end of (18)", "the end of (18), which claims dV/dt < 0 for all smaller ε₀."),
    "scalar": ("norms alone", "from norms alone."),
    CERTIFIED: ("", "dV/dt < 0 is proved at every state but the origin."),
    FALSIFIED: ("a state with dV/dt > 0", "a state with dV/dt > 0 is shown in interval arithmetic."),
}
"""Each of the four: where it is from, and what it means."""
FINDINGS = {
    "published-refuted": (
        "(18) is refuted: it allows all ε₀ below its end, and the witness refutes a smaller one"
    ),
    "published-certified": "(18) allows no ε₀ above the certified one",
    "no-interval": (
        "the ε₀ without a failing state are not an interval: some that fail lie below others that do not"
    ),
}
"""What the numbers may say about each other, by the id of the rule that an annotation names."""
RULES = {
    CERTIFIED: "V > 0 and dV/dt < 0 at all states but the origin, for some ε₀ > 0",
    FALSIFIED: "a state with dV/dt > 0",
    **FINDINGS,
}
CONTINUOUS = "The loop is (11): its torque follows the state without sampling or delay."
BUYS = (
    "What ε₀ buys: V with ε = ε₀/(1 + ‖e‖) falls also where the arm stands still. It does not measure "
    "damping: gains that overshoot and gains that do not may have the same ε₀."
)
RANGED = "published, over ranges: (18) with the worst end of each of its constants, about all arms in them."
OWN_FRICTION = "[bounds] viscous_min of the gain file does not count here: ε₀ is of the arm's own friction."
STAR = "Marked *: a number in floating point without a certificate. The checker proves less from norms."
MOST_REMARKS = 3
RATE_DIGITS = 20
PARTS = ("witness", "weighted")
"""What takes several columns where there is any."""


class _Said(Answer):
    """What is said of some gain sets, or of one."""

    schema = "lyapcheck/epsilon/1"

    file: GainFile | None = None
    robot: str = ""

    @property
    @abstractmethod
    def sets(self) -> tuple[EpsilonResult, ...]:
        """One a gain set."""

    def document(self) -> Document:
        """The four numbers, and in detail what stands behind them."""
        results = self.sets
        every = table(self._fields, [(result,) for result in results])
        if not results:
            return Document(self._title(), (every,))
        first, single = results[0], len(results) == 1 and self.sets[0].seconds is None
        said = [text for short, text in remarks(first) if short] if single else []
        legend = [STAR] if any(result.scalar_grade == "no certificate" for result in results) else []
        short = (*said[: MOST_REMARKS - len(legend)], *legend)
        lead = [CONTINUOUS]
        if single and first.ratio is not None and first.promise is not None:
            share = first.promise.says(f"certified / falsified = {at_least(first.ratio)}.")
            lead = [f"ε₀ = {cell(FALSIFIED, first)} is too large: {share}", CONTINUOUS]
        lead += [OWN_FRICTION] if self.file is not None and self.file.bounds.viscous_min is not None else []
        return Document(
            self._title(),
            (_one_by_one(first) if single else every, *([Bullets(short)] if short else [])),
            tuple(self._notes()),
            tuple(lead),
            (
                *([every] if single else []),
                *(Section(one.name, (Bullets(tuple(x for _, x in remarks(one))),)) for one in results),
            ),
            assumed_line(first.model, self.robot or first.model.name),
            command("gate", *file_words(self.file, self.robot), "--condition", "scalar") if self.file else "",
        )

    def data(self) -> dict[str, Any]:
        """``results: [{name, m, published, scalar, certified, falsified, ratio, witness, boxes, …}]``."""
        return {"results": [data(self._fields, result) for result in self.sets]}

    def records(self) -> list[dict[str, Any]]:
        """A row a gain set, with the witness and the reasons."""
        rows = [row for result in self.sets for row in records(self._fields, result)]
        return [
            {key: value for key, value in row.items() if value is not None or key not in PARTS}
            for row in rows
        ]

    def annotations(self) -> list[Annotation]:
        """A case a gain set: whether an ε₀ is certified; as remarks what is falsified and what follows."""
        made = []
        for one in self.sets:
            place = {} if self.file is None else self.file.spot(one.gains)
            about = partial(Annotation, group=one.name, case="ε₀", **place)
            known = one.promise is not None
            message = "" if known else f"no ε₀ is certified: {one.reasons.get(CERTIFIED, '')}"
            level = Level.PASSED if known else Level.UNDECIDED
            made.append(about(level=level, rule=CERTIFIED, rule_text=RULES[CERTIFIED], message=message))
            said = {} if one.witness is None else {FALSIFIED: f"falsified {witness_text(one.witness)}"}
            said |= {rule: text for rule, text in FINDINGS.items() if text in one.findings}
            made += [
                about(level=Level.REMARK, rule=rule, rule_text=RULES[rule], message=text)
                for rule, text in said.items()
            ]
        return made

    @property
    def _fields(self) -> tuple[Field, ...]:
        return FIELDS if all(result.seconds is None for result in self.sets) else TIMED

    def _title(self) -> str:
        """Whether every gain set has a certified ε₀."""
        count, robots = len(self.sets), ", ".join(dict.fromkeys(one.arm for one in self.sets))
        promises = [one.promise for one in self.sets if one.promise is not None]
        if count == 1:
            (one,) = self.sets
            if one.promise is None:
                return f"? no ε₀ is certified for {one.name} on {robots}"
            eps0 = at_least(one.certified or Fraction(0))
            return one.promise.says(f"✓ ε₀ = {eps0} is certified for {one.name} on {robots}")
        if not promises:
            return f"? no gain set of {count} has a certified ε₀ on {robots or 'no arm'}"
        some = f"✓ all {count}" if len(promises) == count else f"? {len(promises)} of {count}"
        return all_say(promises, f"{some} gain sets have a certified ε₀ on {robots}")

    def _notes(self) -> Iterator[str]:
        """What holds for all results: what the columns say, the arm, the seed, assumptions."""
        promises = [one.promise for one in self.sets if one.promise is not None]
        for kind, (_, meaning) in KINDS.items():
            if kind != CERTIFIED:
                yield f"{kind}: {meaning}"
            elif promises:
                yield all_say(promises, f"{kind}: {meaning}")
        yield from [RANGED] if any(one.ranges for one in self.sets) else []
        yield BUYS
        seeds = ", ".join(dict.fromkeys(str(one.seed) for one in self.sets))
        yield f"Arm: {', '.join(dict.fromkeys(one.arm for one in self.sets))}. Seed: {seeds}."
        yield from dict.fromkeys(f"{text}." for one in self.sets for text in one.model.assumptions)


@dataclass(frozen=True)
class EpsilonResult(FourEpsilons, _Said):
    """The four ε₀ of one gain set, as an answer."""

    @property
    def sets(self) -> tuple[EpsilonResult, ...]:
        return (self,)


@dataclass(frozen=True)
class EpsilonResults(_Said):
    """The four ε₀ of each of several gain sets.

    Args:
        results: one a gain set.
        file: where the gain sets stand.
        robot: the arm, its name or path as it was given.
    """

    results: tuple[EpsilonResult, ...]
    file: GainFile | None = None
    robot: str = ""

    @property
    def sets(self) -> tuple[EpsilonResult, ...]:
        return self.results


def cell(kind: str, result: EpsilonResult) -> str:
    """One of the four, to the safe side; a star where it has no certificate, a dash where there is none."""
    value = getattr(result, kind)
    if value is None:
        return "—"
    star = "*" if kind == "scalar" and result.scalar_proof is None else ""
    return f"{(at_most if kind == FALSIFIED else at_least)(value)}{star}"


def _six_places(ratio: Fraction) -> str:
    """Never rounded up."""
    whole, rest = divmod(int(ratio * 10**6), 10**6)
    return f"{whole}.{rest:06d}"


def _witness(witness: RisingState) -> dict[str, Any]:
    state = {name: decimal_texts(getattr(witness.state, name)) for name in ("q", "e", "w")}
    rate = ends(witness.rate, RATE_DIGITS)
    return {"eps0": decimal_text(witness.eps0), **state, "rate": rate, "kind": witness.kind}


def _weights(weighted: Weighted) -> dict[str, Any]:
    loop = weighted.proof.loop
    return {
        "eps0": decimal_text(loop.eps0),
        "lambda": decimal_texts(loop.Lambda),
        "eps0_lambda": decimal_texts(weighted.products),
        "boxes": weighted.proof.boxes,
        "states": weighted.states,
    }


FIELDS = (
    Field("name", "name", "gains", align="l"),
    Field("m", "m", "m", lambda m: "—" if m is None else str(m)),
    Field("robot", "model.name"),
    *(Field(kind, kind, to=decimal_text) for kind in KINDS),
    *(Field("", partial(cell, kind), f"{kind} ε₀", csv=None) for kind in KINDS),
    Field("scalar_grade", "scalar_grade"),
    Field("ratio", "ratio", to=_six_places),
    Field(
        "",
        "ratio",
        "certified / falsified",
        lambda ratio: "—" if ratio is None else at_least(ratio),
        csv=None,
    ),
    Field("certified_by", lambda result: result.certified_by or None),
    Field("witness", "witness", to=_witness),
    Field("boxes", "boxes"),
    Field("weighted", "weighted", to=_weights),
    Field("ranges", "ranges"),
    Field("unvaried", lambda result: eps0_of(result.unvaried), to=decimal_text),
    Field("outside", "outside", to=list, csv=None),
    Field(
        "corner",
        "corner",
        to=lambda corner: dict(zip(corner, decimal_texts(corner.values()), strict=True)),
        csv=None,
    ),
    Field("seed", "seed"),
    Field("findings", "findings", to=list, csv=None),
    Field("reasons", "reasons", to=dict),
    Field("assumptions", "model.assumptions", to=list, csv=None),
)
"""What is said of a gain set; exact numbers for programs, a missing one has its reason in ``reasons``."""
TIMED = (*FIELDS, Field("seconds", "seconds", "seconds", ".2f", to=lambda seconds: round(seconds, 3)))


def _one_by_one(result: EpsilonResult) -> Table:
    """The four ε₀ of one gain set, and where each is from."""
    rows = []
    for kind, (way, _) in KINDS.items():
        label, by = kind, way or f"by {result.certified_by}"
        if kind == CERTIFIED:
            label = "no certificate" if result.promise is None else result.promise.says(kind)
        rows.append((label, cell(kind, result), "" if getattr(result, kind) is None else by))
    return Table(("", "ε₀", "from"), tuple(rows), align="lrl", keys=2)
