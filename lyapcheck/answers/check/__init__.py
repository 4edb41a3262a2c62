"""The answer of ``check``: all claims of a proof, what is not proved first."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, field
from functools import cached_property
from itertools import groupby
from typing import TYPE_CHECKING, Any

from lyapcheck.certificate import to_json
from lyapcheck.check.certificate import digest_of
from lyapcheck.check.judgement import shortened
from lyapcheck.check.kinds.stability import Stable
from lyapcheck.check.kinds.stable_arm import StableArm
from lyapcheck.check.statement import Statement
from lyapcheck.kernel import GRADE, accepted_before
from lyapcheck.output import fields
from lyapcheck.output.answer import Annotation, Answer, Level
from lyapcheck.output.document import Block, Bullets, Document, Section, Table, command
from lyapcheck.output.fields import Field
from lyapcheck.output.text import HEADLINE
from lyapcheck.promise import all_say, told
from lyapcheck.verdicts import STANDS, Exit, Grade, Verdict, exit_code

if TYPE_CHECKING:
    from lyapcheck.certificate import Certificate
    from lyapcheck.claims.decision import Decision
    from lyapcheck.claims.statements import Missing

SHORT, FAILED, ALL = "short", "failed", "all"
DEFAULT_MS = (1, 2, 3)
MOST_ROWS, MOST_WORDS = 14, 56
"""Claims of the short answer, and letters of what the author calls one."""
SHOWN_COORDINATES = 12
"""Of a witness; the rest of them are counted."""
SIDES = ("point", "left", "operator", "right")
"""What every witness says; whatever else is in one is said after it."""
RELATIONS = {"<=": "≤"}
REASONS = {Verdict.REFUTED: "where it fails", Verdict.PROVED: "remark"}
"""What the reason of a decision is called, where it is not the reason that nothing was decided."""
ORDER = (Verdict.ERROR, Verdict.REFUTED, Verdict.UNDECIDED, Verdict.PROVED)
"""What must be seen first."""
LEVELS = {
    Verdict.PROVED: Level.PASSED,
    Verdict.REFUTED: Level.FAILED,
    Verdict.ERROR: Level.FAILED,
    Verdict.UNDECIDED: Level.UNDECIDED,
}
GRADES = {
    GRADE: "kernel: a theorem of Coq's kernel as well; recheck --kernel asks it anew.",
    Grade.EXACT.label: "exact: rational numbers and symbolic normal forms.",
    Grade.ENCLOSURE.label: "enclosure: balls that enclose the exact numbers.",
    Grade.NUMERIC.label: "numeric: nothing that could decide the claim.",
}
WHOSE = "Statements and verdicts are the checker's; what the author calls them stands in quotation marks."


def refuted_by_source(rows: Sequence[ClaimResult]) -> dict[str, list[str]]:
    """The refuted claims by whose sentence they are; what is ``ours`` is no error of the text."""
    ids = {name: [r.id for r in rows if r.verdict is Verdict.REFUTED and r.stands == name] for name in STANDS}
    return {name: list(dict.fromkeys(found)) for name, found in ids.items()}


@dataclass(frozen=True)
class ClaimResult:
    """Result of one claim for one m. None is a claim that does not depend on m.

    ``stated`` is the decided statement and ``comment`` the author's description. ``decision`` depends on the
    claims that it uses. ``stands`` says whose sentence the claim is.
    """

    id: str
    m: int | None
    n: int | None
    comment: str
    place: str
    section: str
    kind: str
    uses: tuple[str, ...]
    broken: tuple[str, ...]
    decision: Decision
    stated: Statement | Missing
    seconds: float
    stands: str

    def __repr__(self) -> str:
        return f"<ClaimResult: {self.id}, {self.verdict.value}>"

    @cached_property
    def _text(self) -> str:
        if not isinstance(self.stated, Statement):
            return "no statement"
        text = self.stated.text()
        short = shortened(text, full=False)
        return short if short == text else f"{short} [statement {digest_of(to_json(self.stated))[:12]}]"

    @property
    def statement(self) -> str:
        """What was decided, rendered by the checker from its data; cut where it is long, with a digest."""
        return self.decision.says(self._text)

    @property
    def verdict(self) -> Verdict:
        """The verdict, with what the claim uses taken into account."""
        return self.decision.verdict

    @cached_property
    def grade(self) -> str:
        """The grade of the evidence: ``kernel`` if Coq's kernel has accepted what was decided."""
        stated, decision = self.stated, self.decision
        if isinstance(stated, Statement) and (proof := decision.certificate) is not None:
            known = accepted_before(stated, proof, decision.verdict.value)
            return GRADE if known else decision.grade.label
        return decision.grade.label

    @property
    def method(self) -> str:
        """How it was decided."""
        return self.decision.says(self.decision.method)

    @property
    def words(self) -> str:
        """What the author calls it, marked as such; empty where that is nothing."""
        return f"the author's words: “{one_line(self.comment)}”" if self.comment.strip() else ""

    @property
    def support(self) -> tuple[str, ...]:
        """What supports the verdict: the witness, the reason or a remark, the claims that broke it."""
        result, reason = [], one_line(self.decision.reason)
        if (witness := self.decision.witness) is not None:
            result.append(f"witness: {witness_text(witness)}")
        if reason:
            result.append(f"{REASONS.get(self.verdict, 'reason')}: {reason}")
        if self.broken and "rests on" not in reason:
            result.append(f"rests on {', '.join(self.broken)}, not proved")
        return tuple(result)

    def data(self, timings: bool = False) -> dict[str, Any]:
        """The row as plain data; ``seconds`` only when asked for."""
        row = fields.data(FIELDS, self)
        return {**row, "seconds": round(self.seconds, 3)} if timings else row

    def record(self, timings: bool = False) -> dict[str, Any]:
        """The row with a single value under each name, without what was found on the way."""
        row, witness = self.data(timings), self.decision.witness
        del row["evidence"]
        row |= {key: " ".join(row[key]) for key in ("uses", "broken")}
        return row | {"witness": None if witness is None else witness_text(witness)}


def one_line(text: str) -> str:
    """The text with all white space as single spaces."""
    return " ".join(text.split())


def witness_text(witness: Mapping[str, Any]) -> str:
    """A point at which a relation fails, and both of its sides there; or what else shows that it fails."""
    extra = [f"{name}: {_span(value)}" for name, value in witness.items() if name not in SIDES]
    if "point" not in witness:
        return "; ".join(extra)
    point = [f"{name} = {value}" for name, value in witness["point"].items()]
    shown, more = point[:SHOWN_COORDINATES], len(point) - SHOWN_COORDINATES
    place = f"at {', '.join([*shown, *([f'and {more} more'] if more > 0 else [])])}, " if shown else ""
    relation = RELATIONS.get(witness["operator"], witness["operator"])
    sides = f"left {_span(witness['left'])} is not {relation} right {_span(witness['right'])}"
    return "; ".join([place + sides, *extra])


def _span(value: Any) -> str:
    """A number, or the two between which it lies."""
    if not isinstance(value, list):
        return str(value)
    low, high = value
    return str(low) if low == high else f"[{low}, {high}]"


FIELDS = (
    *(Field(key, key) for key in ("id", "m", "n", "statement", "comment")),
    *(Field(key, key) for key in ("place", "section", "stands", "kind")),
    Field("verdict", "decision.word"),
    Field("grade", "grade"),
    *(Field(key, key, to=list) for key in ("uses", "broken")),
    *(Field(key, f"decision.{key}") for key in ("witness", "reason")),
    Field("method", "method"),
    Field("evidence", lambda row: told(row.decision.promise, row.decision.evidence)),
)
"""What is said of a claim."""


@dataclass(frozen=True)
class ProofResult(Answer):
    """All rows of a proof, in the order of the text.

    Args:
        name: of the proof.
        title: of the proof.
        ms: the members of the family that were asked for.
        n: the number of joints.
        robot: the arm, if there is one.
        claims: the rows that were asked for.
        assumptions: about the arm, if a claim uses it.
        certificates: the accepted certificates by file name, also of the used claims.
        script: the path of the script, as it was given.
        about_gains: the ids of the claims that are about the gain set of their m.
        timings: True prints the seconds of each claim.
        extent: ``short``, ``failed`` for all that is not proved with its evidence, or ``all``.
        folder: where the certificates were written; empty if that was not asked.
        elsewhere: another script and its claim that proves a theorem which this proof leaves open.
        assumed: how many numbers of the arm are assumed, as every answer says it.
    """

    schema = "lyapcheck/check/2"

    name: str
    title: str
    ms: tuple[int, ...]
    n: int
    robot: str | None
    claims: tuple[ClaimResult, ...]
    assumptions: tuple[str, ...] = ()
    certificates: Mapping[str, Certificate] = field(default_factory=dict)
    script: str = ""
    about_gains: frozenset[str] = frozenset()
    timings: bool = False
    extent: str = SHORT
    folder: str = ""
    elsewhere: Mapping[tuple[str, int | None], tuple[str, ClaimResult]] = field(default_factory=dict)
    assumed: str = ""

    @property
    def theorems(self) -> list[ClaimResult]:
        """The rows that say that a system is stable."""
        return [row for row in self.claims if isinstance(row.stated, (Stable, StableArm))]

    @property
    def exit_code(self) -> Exit:
        """0 all proved, 1 something refuted, 3 something undecided, 4 an internal error."""
        return exit_code(row.verdict for row in self.claims)

    def counts(self) -> dict[str, int]:
        """How many rows have each verdict."""
        return {v.value: sum(row.verdict is v for row in self.claims) for v in Verdict}

    def document(self) -> Document:
        """The tally and what is not proved, a line each; then every claim, what is not proved first."""
        arm = f", robot {self.robot}" if self.robot else ""
        known = {row.grade for row in self.claims}
        notes = (WHOSE, *(text for grade, text in GRADES.items() if grade in known))
        about = self._theorem() or self.title
        lead = (
            *([cut(about, HEADLINE)] if about else []),
            f"for m = {', '.join(map(str, self.ms))} and n = {self.n}{arm}",
        )
        every = tuple(self._sections(ORDER))
        open_ = [verdict for verdict in ORDER if verdict is not Verdict.PROVED]
        script, failed = self.script or self.name, any(map(self._with, open_))
        then = command(
            "check",
            script,
            *(["--m", ",".join(map(str, self.ms))] if self.ms != DEFAULT_MS else []),
            *(["--n", self.n] if self.robot is None else []),
            *(["--failed"] if failed else ["--certificates", "certificates"]),
        )
        if self.folder and not failed:
            then = command("recheck", self.folder)
        elif self.extent != SHORT and failed:
            first = next(row for verdict in open_ for row in self._with(verdict))
            then = command("explain", first.id, "--proof", script)
        blocks: tuple[Block, ...] = (*self._index(), *self._of_nothing())
        if self.extent == ALL:
            blocks = (*self._of_nothing(), *every)
        elif self.extent == FAILED:
            blocks = tuple(self._sections(open_))
        details = every if self.extent == SHORT else ()
        return Document(self._title(), blocks, notes, lead, details, self.assumed, then)

    def data(self) -> dict[str, Any]:
        """``claims: [{id, m, statement, verdict, …}]``, and what they were asked for."""
        theorems = []
        for row in self.theorems:
            script, other = self.elsewhere.get((row.id, row.m), ("", None))
            otherwise = other and {"script": script, "id": other.id, "verdict": other.decision.word}
            own = {"id": row.id, "m": row.m, "verdict": row.decision.word}
            theorems.append({**own, "otherwise": otherwise})
        return {
            "proof": self.name,
            "title": self.title,
            "m": list(self.ms),
            "n": self.n,
            "robot": self.robot,
            "assumptions": list(self.assumptions),
            "counts": self.counts(),
            "refuted": refuted_by_source(self.claims),
            "theorems": theorems,
            "claims": [row.data(self.timings) for row in self.claims],
        }

    def records(self) -> list[dict[str, Any]]:
        """A row a claim and m; the witness in words, what was found on the way left to the JSON."""
        return [row.record(self.timings) for row in self.claims]

    def annotations(self) -> list[Annotation]:
        """A case a claim and m, and a remark where one is proved of nothing; claims have no line."""
        remarks = [self._annotation(row, Level.REMARK) for row in self._remarked()]
        return [*(self._annotation(row, LEVELS[row.verdict]) for row in self.claims), *remarks]

    def _annotation(self, row: ClaimResult, level: Level) -> Annotation:
        said = filter(None, (row.statement, *row.support, row.words))
        message = "" if level is Level.PASSED else f"{row.id} {row.decision.word}: {'; '.join(said)}"
        case = "" if row.m is None else f"m = {row.m}"
        return Annotation(level, row.id, row.words, self.title or self.name, case, message, self.script)

    def _title(self) -> str:
        """The sign of the worst verdict, and how many claims have which."""
        result = {verdict: self.counts()[verdict] for verdict in ORDER}
        worst = next((verdict for verdict in ORDER if result[verdict]), Verdict.UNDECIDED)
        tally = ", ".join(f"{count} {self._word(verdict)}" for verdict, count in result.items() if count)
        return f"{worst.sign} {tally or 'no claims'}: {self.name}"

    def _theorem(self) -> str:
        """Whether each theorem holds where a claim is refuted; empty where none is, and without theorems."""
        if not self._with(Verdict.REFUTED) and all(row.verdict is Verdict.PROVED for row in self.theorems):
            return ""
        parts, open_, proved = [], [], []
        for group in _by_claim(self.theorems):
            name, others = group[0].id, [self.elsewhere.get((row.id, row.m)) for row in group]
            known = [other for other in others if other is not None]
            if all(row.verdict is Verdict.PROVED for row in group):
                proved += group
            elif len(known) == len(group):
                (script, other), promises = known[0], [one.decision.promise for _, one in known]
                words = f"theorem {name} still holds, proved by {other.id} of {script}"
                parts.append(all_say(promises, words))
            else:
                open_.append(name)
        parts += [f"theorems open here: {', '.join(open_)}"] if open_ else []
        if proved:
            names = ", ".join(dict.fromkeys(row.id for row in proved))
            parts.append(all_say((row.decision.promise for row in proved), f"proved: {names}"))
        return "; ".join(parts)

    def _word(self, verdict: Verdict) -> str:
        """A verdict that some claims have."""
        if verdict is not Verdict.PROVED:
            return verdict.value
        return all_say((row.decision.promise for row in self._with(verdict)), verdict.value)

    def _index(self) -> Iterator[Block]:
        """What is not proved, a line each with what the author calls it; of many the first."""
        rows = [
            (verdict.sign, _ids(group), verdict.value, cut(one_line(group[0].comment)))
            for verdict in ORDER
            if verdict is not Verdict.PROVED
            for group in _by_claim(self._with(verdict))
        ]
        if rows:
            heads = ("", "claim", "verdict", "the author's words")
            yield Table(heads, tuple(rows[:MOST_ROWS]), align="llll", keys=2, drop=(2,))
        if len(rows) > MOST_ROWS:
            yield Bullets((f"{len(rows) - MOST_ROWS} more are not proved; --failed lists all",))

    def _of_nothing(self) -> Iterator[Bullets]:
        """Before all else: which of the proved claims may say nothing."""
        if rows := self._remarked():
            word = all_say((row.decision.promise for row in rows), "Proved")
            yield Bullets((f"{word}, but perhaps of nothing; -v shows the remark at each: {_ids(rows)}",))

    def _remarked(self) -> list[ClaimResult]:
        return [row for row in self.claims if row.verdict is Verdict.PROVED and row.decision.reason]

    def _sections(self, verdicts: Sequence[Verdict]) -> Iterator[Section]:
        """A section a verdict, in it one for each part of the text; the claims of each as a table."""
        for verdict in verdicts:
            rows = self._with(verdict)
            parts: list[Block] = []
            for name in dict.fromkeys(row.section for row in rows):
                table = _table([row for row in rows if row.section == name], self.timings)
                parts.append(Section(name, (table,)) if name else table)
            if parts:
                yield Section(f"{self._word(verdict).capitalize()} ({len(rows)})", tuple(parts))

    def _with(self, verdict: Verdict) -> list[ClaimResult]:
        return [row for row in self.claims if row.verdict is verdict]


def _by_claim(rows: Sequence[ClaimResult]) -> list[list[ClaimResult]]:
    """The rows of each claim, of all its m."""
    result: dict[str, list[ClaimResult]] = {}
    for row in rows:
        result.setdefault(row.id, []).append(row)
    return list(result.values())


def cut(text: str, most: int = MOST_WORDS) -> str:
    """As much of a text as a line has room for."""
    return text if len(text) <= most else f"{text[: most - 1].rstrip()}…"


def _ids(rows: Sequence[ClaimResult]) -> str:
    """The claims by their ids, each with all its m."""
    result: dict[str, list[str]] = {}
    for row in rows:
        result.setdefault(row.id, []).extend([] if row.m is None else [str(row.m)])
    return ", ".join(f"{name} (m = {', '.join(ms)})" if ms else name for name, ms in result.items())


def _table(rows: Sequence[ClaimResult], timings: bool) -> Table:
    """Claims of one verdict: each with its statement, and below what supports the verdict.

    What holds for all m of a claim, such as the author's words, is said once, below the last.
    """
    heads = {"": "l", "claim": "l", "m": "r", "grade": "l", "seconds": "r", "statement": "l"}
    if not timings:
        del heads["seconds"]
    if all(row.m is None for row in rows):
        del heads["m"]
    cells = [
        tuple(line.get(head, "") for head in heads)
        for _, group in groupby(rows, key=lambda row: (row.id, row.comment))
        for line in _lines(list(group))
    ]
    return Table(tuple(heads), tuple(cells), align="".join(heads.values()), keys=len(heads) - 1)


def _lines(rows: Sequence[ClaimResult]) -> Iterator[dict[str, str]]:
    """The cells of one claim by their heads, line by line."""
    support = [row.support for row in rows]
    methods = [f"method: {row.method}" for row in rows]
    same = len(set(methods)) == 1
    common = [text for text in support[0] if all(text in result for result in support)]
    for row, result, method in zip(rows, support, methods, strict=True):
        yield {
            "": row.verdict.sign,
            "claim": row.id,
            "m": "" if row.m is None else str(row.m),
            "grade": row.grade,
            "seconds": f"{row.seconds:.2f}",
            "statement": row.statement,
        }
        own = [*(text for text in result if text not in common), *([] if same else [method])]
        yield from ({"statement": text} for text in own)
    last = [*common, rows[0].words, *(methods[:1] if same else [])]
    yield from ({"statement": text} for text in last if text)
