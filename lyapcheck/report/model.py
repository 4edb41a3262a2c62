"""What a report says, before it is laid out."""

from __future__ import annotations

import tomllib
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass, field, fields
from types import SimpleNamespace
from typing import TYPE_CHECKING, Any, TypeVar

from lyapcheck.answers.check import ClaimResult, refuted_by_source
from lyapcheck.control.conditions import ACCEPTED, REJECTED
from lyapcheck.extensions import shipped
from lyapcheck.verdicts import Verdict

if TYPE_CHECKING:
    from lyapcheck.answers.derive import Derivation
    from lyapcheck.answers.gate import GateAnswer
    from lyapcheck.answers.gate.judge import GateResult
    from lyapcheck.answers.table import Table
    from lyapcheck.claims.decision import Decision
    from lyapcheck.control.gains import GainFile
    from lyapcheck.promise import Promise
    from lyapcheck.robots import RobotModel

Made = TypeVar("Made")
WEIGHTS = {
    "A": "breaks the proof",
    "B": "wrong, but the proposition stands without it",
    "C": "misprints and arithmetic",
    "D": "the experiment",
    "E": "further questions of ours, no errors of the paper",
}


@dataclass(frozen=True)
class Paper:
    """The text that a proof script is about."""

    authors: str
    title: str
    source: str
    theorem: str
    controller: str

    @property
    def citation(self) -> str:
        """In one line."""
        return f"{self.authors}, {self.title}, {self.source}"


@dataclass(frozen=True)
class Box:
    """A step of the proof, or of the alternative: as good as the worst of its claims."""

    label: str
    title: str
    claims: tuple[str, ...]
    proof: str = "published"
    after: str = ""


@dataclass(frozen=True)
class Note:
    """What the text argues where claims fail, why that is wrong, and what mends it; formulas in LaTeX.

    ``mended`` are the claims that show that the repair does.
    """

    claims: tuple[str, ...]
    title: str
    printed: str = ""
    argument: str = ""
    fails: str = ""
    consequence: str = ""
    repair: str = ""
    mended: tuple[str, ...] = ()


@dataclass(frozen=True)
class Notes:
    """All that the file says.

    Args:
        paper: the text.
        chain: its proof from left to right.
        route: an alternative proof, without what is broken.
        findings: notes on claims that may fail; one whose claims hold is not shown.
        equations: LaTeX of the numbered formulas.
        titles: of claims, in a few letters, for the graph.
        known: what was known before the paper, and what is new: a sentence, then paragraphs.
        own: by proof the claims about an arm and gains, for reports on others than the paper's.
    """

    paper: Paper
    chain: tuple[Box, ...]
    route: tuple[Box, ...]
    findings: tuple[Note, ...]
    equations: Mapping[str, str]
    titles: Mapping[str, str]
    known: tuple[str, ...]
    own: Mapping[str, tuple[str, ...]]


def published_notes() -> Notes:
    """Those on the paper."""
    result = tomllib.loads((shipped("proofs") / "published.toml").read_text(encoding="utf-8"))

    def made(kind: type[Made], name: str) -> tuple[Made, ...]:
        lists = (
            {key: tuple(x) if isinstance(x, list) else x for key, x in one.items()} for one in result[name]
        )
        return tuple(kind(**one) for one in lists)

    return Notes(
        paper=Paper(**result["paper"]),
        chain=made(Box, "chain"),
        route=made(Box, "route"),
        findings=made(Note, "findings"),
        equations=result["equations"],
        titles=result["titles"],
        known=(result["known"]["short"], *result["known"]["text"]),
        own={proof: tuple(ids) for proof, ids in result["own"].items()},
    )


# --- Claims and findings.


@dataclass(frozen=True)
class ClaimRow(ClaimResult):
    """As `ClaimResult` has it.

    Args:
        proof, title: of the script.
        certificate, digest: its path in the report, and its digest; none where nothing was decided.
        gains: the gain set that it is about, where it is about one.
    """

    proof: str
    title: str
    certificate: str | None
    digest: str | None
    gains: str | None = None

    @classmethod
    def of(cls, claim: ClaimResult, *own: str | None) -> ClaimRow:
        """A claim of a proof, with what a row has beside it."""
        return cls(*(getattr(claim, each.name) for each in fields(claim)), *own)

    @property
    def details(self) -> list[str]:
        """The author's words, then what supports the verdict."""
        return [*filter(None, [self.words]), *map(self.decision.says, self.support)]

    def data(self, timings: bool = False) -> dict[str, Any]:
        """All of it as plain data."""
        return super().data(timings) | {
            "proof": self.proof,
            "title": self.title,
            "details": self.details,
            "gains": self.gains,
            "certificate": self.certificate,
            "digest": self.digest,
            "rules": list(self.decision.rules),
            "granted": list(self.decision.granted),
        }

    @property
    def about(self) -> str:
        """``tau_m1, m = 1, n = 3``; the gain set, the member and the number of joints, where there is one."""
        letters = (f"{name} = {value}" for name, value in (("m", self.m), ("n", self.n)) if value is not None)
        return ", ".join([*filter(None, [self.gains]), *letters])

    @property
    def heading(self) -> str:
        """The part of the text, or of which other proof, it is listed under."""
        section = self.section or "Claims"
        return section if self.proof == "published" else f"{self.proof}.py: {section}"

    @property
    def decided(self) -> bool:
        """Whether a certificate stands behind the verdict."""
        return self.verdict in (Verdict.PROVED, Verdict.REFUTED)


@dataclass(frozen=True)
class Finding:
    """One place where the paper is not confirmed, or one thing that is wrong with gains.

    Args:
        weight: a key of ``WEIGHTS``.
        subject: claim or gain set, in a word.
        claims: the refuted claims that it is about, if any.
        ms: the members of the family it concerns; empty where it concerns all.
        title: what is wrong, in one sentence.
        text: numbers, in one or two sentences.
        note: what the text argues, why it is wrong, what follows, what helps.
        witness: the claim whose relation fails at a point.
    """

    weight: str
    subject: str
    claims: tuple[str, ...]
    ms: tuple[int, ...]
    title: str
    text: str
    note: Note = Note((), "")
    witness: ClaimRow | None = None

    @property
    def about(self) -> dict[str, str]:
        """What is said beside the witness, by what it is."""
        note = self.note
        shown = f"(Claim {', '.join(note.mended)}.)" if note.mended else ""
        said = {
            "The paper argues": note.argument,
            "What fails": note.fails,
            "Consequence": note.consequence,
            "Repair": " ".join(filter(None, [note.repair, shown])),
        }
        return {term: text for term, text in said.items() if text}

    def data(self) -> dict[str, Any]:
        """All of it as plain data."""
        own = {name: getattr(self, name) for name in ("weight", "subject", "claims", "ms", "title", "text")}
        told = ("printed", "argument", "fails", "consequence", "repair", "mended")
        own |= {name: getattr(self.note, name) for name in told} | {"witness": None}
        if (row := self.witness) is not None:
            witness = row.decision.witness or {}
            point = {name: witness[name] for name in ("point", "left", "operator", "right")}
            # the keys of when witnesses were searched for as small as they are
            own["witness"] = {"m": row.m, "n": row.n, **point, "certificate": row.certificate}
            own["witness"] |= {"small": False, "figure": ""}
        return own | {"figure": ""}


@dataclass(frozen=True)
class BySize:
    """The decisions on a claim for each number of joints, where they are not all the same."""

    id: str
    m: int | None
    comment: str
    decisions: Mapping[int, Decision]

    def data(self) -> dict[str, Any]:
        """All of it as plain data, the verdicts in words."""
        verdicts = {n: one.word for n, one in self.decisions.items()}
        return {"id": self.id, "m": self.m, "comment": self.comment, "verdicts": verdicts}


SIGNS = {"good": "✓", "bad": "✗", "warn": "!", "open": "?"}
"""Of the tones of tiles and badges."""


@dataclass(frozen=True)
class Motion:
    """The arm drawn at some times, from start to goal.

    Args:
        frames: places of base, joints and end, in the plane, m; of a dial the two ends of its hand.
        seconds: from the first of them to the last.
        joint: whose angle a dial shows, where the links of the arm are not known.
    """

    frames: tuple[tuple[tuple[float, float], ...], ...]
    seconds: float
    joint: str = ""


@dataclass(frozen=True)
class Tile:
    """One answer about one gain set.

    Args:
        subject: what was asked, in a word or two.
        number: the answer.
        text: who says so, in one sentence.
        tone: ``good``, ``warn``, ``bad``, or ``open`` where nothing is judged.
        todo: what to do about it, and the command for it; empty where nothing is to be done.
        before: the answer of an older report, where it was another one.
        posture: the arm where something fails, drawn as in ``drawn_motions``.
    """

    subject: str
    number: str
    text: str
    tone: str
    todo: tuple[str, str] = ("", "")
    before: str = ""
    posture: tuple[Motion, ...] = ()


@dataclass(frozen=True)
class Report:
    """Everything that was found out about one arm and its gain sets, with finished figures.

    Args:
        notes: what the paper prints and argues.
        own: whether it is about another arm or other gains than the paper's.
        robot: the arm.
        ms: the members of the family that were asked for.
        table: the constants of these members.
        derived: what SymPy derives of them and of V, and what the checker says of it.
        gate: what the gate says of each gain set.
        epsilon: the four ε₀ of each gain set.
        claims: decided claims of the paper, one row a claim and m.
        others: those of the proofs of what the paper concludes.
        by_size: the claims of the paper whose verdict changes with n.
        runs: simulated runs, one a gain set, the PD baseline last.
        findings: the heaviest first.
        figures: SVG by file name.
        certificates: by their paths, those that the checker has accepted.
        versions: of the packages that the computations loaded.
        seed: the seed of every random search.
        tiles: what an engineer asks about gains on an arm of one's own, by gain set.
        motions: the arm along the simulated run of a gain set, or a dial for each of its joints.
    """

    notes: Notes
    own: bool
    robot: RobotModel
    ms: tuple[int, ...]
    table: Table
    derived: Derivation
    gate: GateAnswer
    epsilon: tuple[EpsilonRow, ...]
    claims: tuple[ClaimRow, ...]
    others: tuple[ClaimRow, ...]
    by_size: tuple[BySize, ...]
    runs: tuple[RunRow, ...]
    findings: tuple[Finding, ...]
    figures: Mapping[str, str] = field(repr=False)
    certificates: Mapping[str, str] = field(default_factory=dict, repr=False)
    versions: Mapping[str, str] = field(default_factory=dict)
    seed: int = 0
    tiles: Mapping[str, tuple[Tile, ...]] = field(default_factory=dict)
    motions: Mapping[str, tuple[Motion, ...]] = field(default_factory=dict, repr=False)

    @property
    def every_claim(self) -> tuple[ClaimRow, ...]:
        """Those of the paper, then those of the other proofs."""
        return (*self.claims, *self.others)

    def counts(self) -> dict[str, int]:
        """How many claims of the paper have each verdict."""
        order = ("proved", "refuted", "undecided", "error")
        return {verdict: sum(row.verdict == verdict for row in self.claims) for verdict in order}

    def errors(self) -> dict[str, list[str]]:
        """The refuted claims by whose sentence they are; what is ours is no error of the paper."""
        return refuted_by_source(self.claims)

    def weighing(self, weight: str) -> tuple[Finding, ...]:
        """The findings of one weight."""
        return tuple(finding for finding in self.findings if finding.weight == weight)

    def verdicts(self, ids: Sequence[str], proof: str) -> list[str]:
        """Of all rows of some claims."""
        rows = (row for row in self.every_claim if row.proof == proof and row.id in ids)
        return [row.verdict for row in rows]


def anchor(proof: str, claim: str) -> str:
    """The id of a claim's row on the page: that of the paper's claims is their own."""
    return claim if proof == "published" else f"{proof}:{claim}"


def behind(claim: str, rows: Iterable[ClaimRow]) -> set[str]:
    """The claim, and all that it uses, directly or not."""
    uses = {row.id: row.uses for row in rows}
    result, waiting = {claim}, [claim]
    while waiting:
        fresh = set(uses.get(waiting.pop(), ())) - result
        result |= fresh
        waiting += fresh
    return result


def applies(result: GateResult) -> bool:
    """Whether the conditions of the gate are about gains at all: without γ they have no limit."""
    return any(check.limit is not None for check in result.checks)


def keeps_limits(result: GateResult) -> bool:
    """Whether no motor saturates at any state: (11), of which stability is proved, knows no limit."""
    bounds_hold = result.verdict_of(("gravity",)) != REJECTED
    return bounds_hold and ACCEPTED in (result.verdict_of(("10p",)), result.verdict_of(("10i",)))


# --- What a report is about.


@dataclass(frozen=True)
class Subject:
    """An arm, members of the family, and gains.

    Args:
        robot: name or file of the arm, as ``lyapcheck.robots.load`` takes it.
        ms: the members of the family.
        gain_files: the gains; sets of other members are left out, those without a member (PD) stay.
        own: whether arm or gains are others than the paper's: it is then about these alone.
    """

    robot: str
    ms: tuple[int, ...]
    gain_files: tuple[GainFile, ...]
    own: bool = False

    @property
    def sets(self) -> list[tuple[GainFile, str]]:
        """The gain sets that belong in the report, each with its file."""
        return [
            (file, item.name)
            for file in self.gain_files
            for item in file.gains
            if item.m is None or item.m in self.ms
        ]


# --- What a report shows of a gain set: its four ε₀ and its run, to digits that machines agree on.


BOTH_ENDS = ("certified", "falsified")
"""The ε₀ that rest on certificates."""
KINDS = ("published", "scalar", *BOTH_ENDS)
LINKED = (*BOTH_ENDS, "weighted")


@dataclass(frozen=True)
class EpsilonRow:
    """The four ε₀ of a gain set as decimals, rounded to the safe side; ``None`` where there is none.

    Args:
        certified_by: which search proposed the proof.
        assumptions: what is taken for granted about the arm.
        seed: of the sampled states.
        ratio: certified/falsified.
        boxes: the budget of branch and bound.
        reasons: why an ε₀ is missing, by its name.
        certificates: their paths in the report, by the names of ``LINKED``.
        weighted: ε₀Λ with the largest product that is accepted, joint by joint; empty where none was sought.
        promise: that V falls at every state of the arm at its nominal numbers, with the certified ε₀.
    """

    name: str
    m: int | None
    robot: str = ""
    certified_by: str | None = None
    assumptions: tuple[str, ...] = ()
    seed: int = 0
    published: str | None = None
    scalar: str | None = None
    certified: str | None = None
    falsified: str | None = None
    ratio: str | None = None
    boxes: int = 0
    reasons: Mapping[str, str] = field(default_factory=dict)
    certificates: Mapping[str, str] = field(default_factory=dict)
    weighted: tuple[str, ...] = ()
    promise: Promise | None = None


RunRow = SimpleNamespace
"""A simulated run as `lyapcheck simulate` writes it, to six digits. Beyond that two numbers of the bench:
``top_speed``, the largest |q̇_i| in rad/s, and ``rest``, how far off, °, dry friction may hold a joint; none
where it may hold it anywhere."""
