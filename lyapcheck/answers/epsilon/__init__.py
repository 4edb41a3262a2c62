"""The four ε₀ of one gain set, and those of several, as answers."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, field
from fractions import Fraction
from functools import partial
from typing import TYPE_CHECKING, Any

from lyapcheck.answers import assumed_line
from lyapcheck.check.kinds.decreasing import Decreasing, StateWitness
from lyapcheck.check.kinds.link_bounds import ChainDecreasing
from lyapcheck.files.decimals import decimal_text, decimal_texts
from lyapcheck.output.answer import Annotation, Answer, Level
from lyapcheck.output.digits import at_least, at_most, ends
from lyapcheck.output.document import Bullets, Document, Section, Table, command
from lyapcheck.output.fields import Field, data, table
from lyapcheck.promise import all_say

if TYPE_CHECKING:
    from lyapcheck.control.gains import GainFile, GainSet
    from lyapcheck.promise import Promise
    from lyapcheck.robots import RobotModel
    from lyapcheck.search.controlled_arm import ChainProof, DecreaseProof
    from lyapcheck.search.falsify import RisingState
    from lyapcheck.search.weights import Weighted

CERTIFIED, FALSIFIED = "certified", "falsified"
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
STAR = "Marked *: a number in floating point without a certificate. The checker proves less from norms."
MOST_REMARKS = 3
FASTEST = 100
"""rad/s, beyond which no arm turns."""
DIGITS = 7
"""Of ε₀ for people: the search proposes no more."""
RATE_DIGITS = 20
PARTS = ("witness", "weighted")
"""What takes several columns where there is any."""


@dataclass(frozen=True)
class EpsilonResult(Answer):
    """The four ε₀ of one gain set. A missing one is ``None``, with its reason in ``reasons``.

    Args:
        gains: the gain set.
        model: the arm.
        published: the end of (18), rounded down.
        scalar: ε₀ of the scalar form, from norms.
        promise: that V falls with the largest ε₀ of which the checker accepted a proof.
        falsified: ε₀ of the witness.
        witness: the state that refutes ``falsified``.
        boxes: how many boxes branch and bound looked at.
        certified_by: which search proposed the proof behind ``certified``.
        proof: behind ``certified``, accepted by the checker.
        scalar_proof: behind ``scalar``, accepted by the checker; ``None`` if it accepted none.
        against: the statement that ``witness`` refutes, and the state with the arm it is a state of.
        weighted: a proof with weights Λ in y = w − εΛh, if the search found one.
        weighted_promise: that V falls with these weights.
        ranges: whether the answer holds for all ranges of the arm, or for its nominal numbers.
        corner: the uncertain numbers of the arm that ``witness`` is about, by name.
        reasons: why a number is missing, and what to try.
        findings: what the numbers say about each other, one sentence each.
        seed: of the sampled states.
        unvaried: the promise at the numbers of the file, if the ranges contain them.
        outside: the numbers whose value in the file lies outside the ranges.
    """

    schema = "lyapcheck/epsilon/1"

    gains: GainSet
    model: RobotModel
    published: Fraction | None
    scalar: Fraction | None
    promise: Promise | None
    falsified: Fraction | None
    witness: RisingState | None
    boxes: int
    certified_by: str
    proof: DecreaseProof | ChainProof | None = None
    scalar_proof: DecreaseProof | ChainProof | None = None
    against: tuple[Decreasing, StateWitness] | None = None
    weighted: Weighted | None = None
    weighted_promise: Promise | None = None
    ranges: bool = False
    corner: Mapping[str, Fraction] = field(default_factory=dict)
    reasons: Mapping[str, str] = field(default_factory=dict)
    findings: tuple[str, ...] = ()
    seed: int = 0
    unvaried: Promise | None = None
    outside: tuple[str, ...] = ()

    @property
    def certified(self) -> Fraction | None:
        """The ε₀ that is promised."""
        return eps0_of(self.promise)

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
    def arm(self) -> str:
        """The arm, and for which of its values the numbers are where it has ranges."""
        name, numbers = self.model.name, (*self.model.parameters.values(), *self.model.viscous)
        if self.ranges:
            return f"{name}, for all values in its ranges"
        return f"{name}, at its nominal numbers" if any(one.ranged for one in numbers) else name

    @property
    def ratio(self) -> Fraction | None:
        """certified / falsified: 1 would leave nothing open."""
        if self.certified is None or not self.falsified:
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


def eps0_of(promise: Promise | None) -> Fraction | None:
    """The ε₀ that a promise is about."""
    if promise is None:
        return None
    assert isinstance(promise.asked, Decreasing | ChainDecreasing)
    return promise.asked.eps0


def exact(value: Fraction | None) -> str | None:
    """An exact number as a decimal string."""
    return None if value is None else decimal_text(value)


def cell(kind: str, result: EpsilonResult) -> str:
    """One of the four, to the safe side; a star where it has no certificate, a dash where there is none."""
    value = getattr(result, kind)
    if value is None:
        return "—"
    star = "*" if kind == "scalar" and result.scalar_proof is None else ""
    return f"{(at_most if kind == FALSIFIED else at_least)(value, DIGITS)}{star}"


def _ratio(result: EpsilonResult) -> str:
    return "—" if result.ratio is None else at_least(result.ratio)


def _six_places(ratio: Fraction) -> str:
    """Never rounded up."""
    whole, rest = divmod(int(ratio * 10**6), 10**6)
    return f"{whole}.{rest:06d}"


def _witness(witness: RisingState) -> dict[str, Any]:
    state = {name: decimal_texts(getattr(witness.state, name)) for name in ("q", "e", "w")}
    rate = ends(witness.rate, RATE_DIGITS)
    return {"eps0": exact(witness.eps0), **state, "rate": rate, "kind": witness.kind}


def _weights(weighted: Weighted) -> dict[str, Any]:
    loop = weighted.proof.loop
    return {
        "eps0": exact(loop.eps0),
        "lambda": decimal_texts(loop.Lambda),
        "eps0_lambda": decimal_texts(weighted.products),
        "boxes": weighted.proof.boxes,
        "states": weighted.states,
    }


FIELDS = (
    Field("name", "name", "gains", align="l"),
    Field("m", "m", "m", lambda m: "—" if m is None else str(m)),
    Field("robot", "model.name"),
    *(Field(kind, kind, to=exact) for kind in KINDS),
    *(Field("", partial(cell, kind), f"{kind} ε₀", csv=None) for kind in KINDS),
    Field("scalar_grade", "scalar_grade"),
    Field("ratio", "ratio", to=_six_places),
    Field("", _ratio, "certified / falsified", csv=None),
    Field("certified_by", lambda result: result.certified_by or None),
    Field("witness", "witness", to=_witness),
    Field("boxes", "boxes"),
    Field("weighted", "weighted", to=_weights),
    Field("ranges", "ranges"),
    Field("unvaried", lambda result: exact(eps0_of(result.unvaried))),
    Field("outside", "outside", to=list, csv=None),
    Field("corner", "corner", to=lambda corner: {name: exact(x) for name, x in corner.items()}, csv=None),
    Field("seed", "seed"),
    Field("findings", "findings", to=list, csv=None),
    Field("reasons", "reasons", to=dict),
    Field("assumptions", "model.assumptions", to=list, csv=None),
)
"""What is said of a gain set; exact numbers for programs, a missing one has its reason in ``reasons``."""


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
        results, every = self.results, self._every()
        if not results:
            return Document(self._title(), (every,))
        first, single = results[0], len(results) == 1 and self.seconds is None
        said = [text for short, text in remarks(first) if short] if single else []
        legend = [STAR] if any(result.scalar_grade == "no certificate" for result in results) else []
        short = (*said[: MOST_REMARKS - len(legend)], *legend)
        lead = [CONTINUOUS]
        if single and first.ratio is not None and first.promise is not None:
            share = first.promise.says(f"certified / falsified = {at_least(first.ratio)}.")
            lead = [f"ε₀ = {cell(FALSIFIED, first)} is too large: {share}", CONTINUOUS]
        return Document(
            self._title(),
            (_one_by_one(first) if single else every, *([Bullets(short)] if short else [])),
            tuple(self._notes()),
            tuple(lead),
            (
                *([every] if single else []),
                *(Section(one.name, (Bullets(tuple(x for _, x in remarks(one))),)) for one in results),
            ),
            assumed_line(first.model, (self.file.robot if self.file else "") or first.model.name),
            command("gate", self.file.path, "--condition", "scalar") if self.file else "",
        )

    def data(self) -> dict[str, Any]:
        """``results: [{name, m, published, scalar, certified, falsified, ratio, witness, boxes, …}]``."""
        rows = [data(FIELDS, result) for result in self.results]
        for row, time in zip(rows, self.seconds or (), strict=False):
            row["seconds"] = round(time, 3)
        return {"results": rows}

    def records(self) -> list[dict[str, Any]]:
        """A row a gain set, with the witness and the reasons."""
        left_out = {field.key for field in FIELDS if field.csv is None}
        return [
            {
                key: value
                for key, value in row.items()
                if key not in left_out and not (value is None and key in PARTS)
            }
            for row in self.data()["results"]
        ]

    def annotations(self) -> list[Annotation]:
        """A case a gain set: whether an ε₀ is certified; as remarks what is falsified and what follows."""
        made = []
        for one in self.results:
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

    def _every(self) -> Table:
        """A row a gain set."""
        rows = table(FIELDS, [(result,) for result in self.results])
        if self.seconds is None:
            return rows
        cells = tuple((*row, f"{time:.2f}") for row, time in zip(rows.rows, self.seconds, strict=True))
        return Table((*rows.heads, "seconds"), cells, align=f"{rows.align}r")

    def _title(self) -> str:
        """Whether every gain set has a certified ε₀."""
        count, robots = len(self.results), ", ".join(dict.fromkeys(one.arm for one in self.results))
        promises = [one.promise for one in self.results if one.promise is not None]
        if count == 1:
            (one,) = self.results
            if one.promise is None:
                return f"? no ε₀ is certified for {one.name} on {robots}"
            return one.promise.says(f"✓ ε₀ = {exact(one.certified)} is certified for {one.name} on {robots}")
        if not promises:
            return f"? no gain set of {count} has a certified ε₀ on {robots or 'no arm'}"
        some = f"✓ all {count}" if len(promises) == count else f"? {len(promises)} of {count}"
        return all_say(promises, f"{some} gain sets have a certified ε₀ on {robots}")

    def _notes(self) -> Iterator[str]:
        """What holds for all results: what the columns say, the arm, the seed, assumptions."""
        promises = [one.promise for one in self.results if one.promise is not None]
        for kind, (_, meaning) in KINDS.items():
            if kind != CERTIFIED:
                yield f"{kind}: {meaning}"
            elif promises:
                yield all_say(promises, f"{kind}: {meaning}")
        yield from [RANGED] if any(one.ranges for one in self.results) else []
        yield BUYS
        seeds = ", ".join(dict.fromkeys(str(one.seed) for one in self.results))
        yield f"Arm: {', '.join(dict.fromkeys(one.arm for one in self.results))}. Seed: {seeds}."
        yield from dict.fromkeys(f"{text}." for one in self.results for text in one.model.assumptions)


def _one_by_one(result: EpsilonResult) -> Table:
    """The four ε₀ of one gain set, and where each is from."""
    rows = []
    for kind, (way, _) in KINDS.items():
        label, by = kind, way or f"by {result.certified_by}"
        if kind == CERTIFIED:
            label = "no certificate" if result.promise is None else result.promise.says(kind)
        rows.append((label, cell(kind, result), "" if getattr(result, kind) is None else by))
    return Table(("", "ε₀", "from"), tuple(rows), align="lrl", keys=2)


def remarks(result: EpsilonResult) -> Iterator[tuple[bool, str]]:
    """Everything else in a sentence each, with whether the short answer has it.

    How the certified number was proved, findings, reasons for missing numbers, weights and the witness.
    """
    promise, witness, weighted = result.promise, result.witness, result.weighted
    if promise is not None or result.boxes:
        way = [] if promise is None else [promise.says(f"certified by {result.certified_by}")]
        if result.proof is not None and result.proof.boxes:
            way.append(f"{_boxes(result.proof.boxes)} judged by the checker")
        way += [f"{_boxes(result.boxes)} looked at by the search"] if result.boxes else []
        yield False, f"{', '.join(way)}."
    if promise is not None and result.unvaried is not None:
        certified, nominal = result.certified or Fraction(0), eps0_of(result.unvaried) or Fraction(1)
        cost = "nothing" if certified >= nominal else f"{at_most(100 * (1 - certified / nominal), 2)} %"
        said = result.unvaried.says(f"at nominal numbers ε₀ = {exact(nominal)} is certified.")
        yield True, f"the ranges cost {cost}: {said}"
    if result.outside:
        yield (
            True,
            f"the file's own value lies outside the range of {', '.join(result.outside)}: nothing here is "
            "about the arm as its file describes it.",
        )
    yield from ((True, f"{finding}.") for finding in result.findings)
    for kind, reason in result.reasons.items():
        what = "no" if getattr(result, kind) is None else "no larger"
        yield kind in (CERTIFIED, "published"), f"{what} {kind} ε₀: {reason}."
    if weighted is not None and result.weighted_promise is not None:
        seen = f"{weighted.states} worst states in the program"
        said = f"with weights, y = w − εΛh, Λ = I is the best that was shown ({seen})."
        if weighted.proof.loop.coupling:
            values = ", ".join(map(decimal_text, weighted.products))
            seen = f"{_boxes(weighted.proof.boxes)}, {seen}"
            said = f"with weights, y = w − εΛh, dV/dt < 0 is proved for ε₀Λ = diag({values}) ({seen})."
        yield True, result.weighted_promise.says(said)
    if witness is not None:
        yield False, f"falsified {witness_text(witness)}."
        speed = max(map(abs, witness.state.w))
        if speed > FASTEST:
            yield (
                False,
                f"No arm reaches the {at_least(speed, 2)} rad/s of that state. "
                "A larger ε₀ may hold in real motions.",
            )
        if result.corner:
            values = ", ".join(f"{name} = {decimal_text(value)}" for name, value in result.corner.items())
            yield False, f"that state is one of the arm with {values}."


def _boxes(count: int) -> str:
    return "1 box" if count == 1 else f"{count} boxes"


def witness_text(witness: RisingState) -> str:
    """The failing state in one line."""
    units = {"q": "rad", "e": "rad", "w": "rad/s"}
    places = ", ".join(
        f"{name} = ({', '.join(map(decimal_text, getattr(witness.state, name)))}) {unit}"
        for name, unit in units.items()
    )
    return f"at {places} with ε₀ = {decimal_text(witness.eps0)}: dV/dt > {at_least(witness.rate)} W"
