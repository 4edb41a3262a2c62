"""What a claim says, where it stands, what it rests on, and which procedure decides it."""

from __future__ import annotations

import inspect
import re
from collections.abc import Collection, Iterator
from dataclasses import asdict, dataclass
from pathlib import Path
from typing import Any
from unicodedata import normalize

from lyapcheck._types import Progress
from lyapcheck.answers.check import ORDER, ClaimResult, cut, one_line
from lyapcheck.answers.check.run import paper_case_data, run_proof
from lyapcheck.check.kinds.all_of import AllOf
from lyapcheck.check.kinds.flow import Flow
from lyapcheck.check.statement import Statement
from lyapcheck.check.verify import RULES
from lyapcheck.claims.handover import ScriptRequest
from lyapcheck.claims.script import SHIPPED, ask, check_ids, find_script
from lyapcheck.claims.search_result import procedure_of
from lyapcheck.claims.statements import Missing
from lyapcheck.extensions import shipped
from lyapcheck.output.answer import Answer
from lyapcheck.output.document import Block, Bullets, Document, Paragraph, Section, Table, command
from lyapcheck.output.text import HEADLINE, PROSE

FORMULA = re.compile(r"\(\w+\)")
ACCENTS = {"'": "\N{COMBINING ACUTE ACCENT}", "~": "\N{COMBINING TILDE}"}
SHOWN_MEMBER = 2
"""The m at which statements are written out: the first with a peak."""
MOST_LISTED = 14
"""Claims of the short list."""


@dataclass(frozen=True)
class Part:
    """One thing that a claim asks to be decided.

    Args:
        name: of the part; empty where the claim is one statement.
        kind: of the statement.
        says: the statement as it is decided.
    """

    name: str
    kind: str
    says: str

    @property
    def text(self) -> str:
        """The part in one line."""
        return f"{f'{self.name}: ' if self.name else ''}{self.says} [{self.kind}]"


@dataclass(frozen=True)
class Explanation(Answer):
    """A claim explained.

    Args:
        id: of the claim.
        says: the claim in words.
        script: the proof script that makes it.
        title: of the proof.
        place: where the text makes it, empty where that is not said.
        reference: the text, or its key in the bibliography.
        uses: the claims it rests on, and what they say.
        used_by: the claims that rest on it, and what they say.
        near: the other claims about the same formulas of the text, and what they say.
        case: the m, n and arm at which the parts are written out; empty where they depend on none of them.
        parts: what is decided.
        lacking: why nothing can be decided for the paper's arm, empty where it can.
        procedures: how it is decided, one paragraph a procedure.
        granted: the assumptions of a proof of it.
        decided: the claim for the paper's arm, a row for each m; empty where that was not asked.
        asked: the script that was asked for; empty for one that comes with lyapcheck.
    """

    schema = "lyapcheck/explain/1"

    id: str
    says: str
    script: str
    title: str
    place: str
    reference: str
    uses: tuple[tuple[str, str], ...]
    used_by: tuple[tuple[str, str], ...]
    near: tuple[tuple[str, str], ...]
    case: str
    parts: tuple[Part, ...]
    lacking: str
    procedures: tuple[str, ...]
    granted: tuple[str, ...] = ()
    decided: tuple[ClaimResult, ...] = ()
    asked: str = ""

    @property
    def found(self) -> tuple[str, ...]:
        """The verdict for each m, with its counterexample or reason."""
        rows = ((f"m = {row.m}: " if row.m is not None else "", row) for row in self.decided)
        return tuple("; ".join((f"{m}{row.decision.word} [{row.grade}]", *row.support)) for m, row in rows)

    def document(self) -> Document:
        """The verdict, what is decided and what it uses; in detail how, and the other claims about it."""
        source = f" of {_cited(self.reference)}" if self.reference else ""
        made = (
            f"{self.place}{source}; claimed in {self.script}" if self.place else f"claimed in {self.script}"
        )
        said = f"“{one_line(self.says)}” (the author's words)"
        title, lead = f"{self.id}: {said}", [made]
        if self.decided:
            worst = next(v for v in ORDER if any(row.verdict is v for row in self.decided))
            title, lead = f"{worst.sign} {self.id}: {self._verdicts()}", [said, made]
        stated = [self.lacking] if self.lacking else [part.text for part in self.parts]
        case = f", for {self.case}" if self.case else ""
        links = [
            f"{what} {cut(', '.join(name for name, _ in claims), PROSE - 12)}"
            for what, claims in (("uses", self.uses), ("used by", self.used_by))
            if claims
        ]
        remarks = (cut(f"decided{case}: {'; '.join(stated)}", 3 * PROSE), *links)
        how = tuple(block for text in self.procedures for block in _blocks(text))
        about = f"Also about {', '.join(FORMULA.findall(self.place))}"
        sections = (
            ("Verdicts", (Bullets(self.found),) if self.found else ()),
            (f"What is decided{case}", tuple(map(Paragraph, stated))),
            ("How it is decided", how or (Paragraph("Not for this arm and these gains."),)),
            ("Assumptions", (Bullets(self.granted),) if self.granted else ()),
            ("What it uses", (_claims(self.uses),)),
            ("What uses it", (_claims(self.used_by),)),
            (about, (_claims(self.near),) if self.near else ()),
        )
        return Document(
            title,
            (*self._table(), Bullets(remarks)),
            lead=tuple(cut(text, HEADLINE) for text in lead),
            details=tuple(Section(head, blocks) for head, blocks in sections if blocks),
            next=self._command(),
        )

    def _verdicts(self) -> str:
        """Each verdict with the m that have it."""
        rows: dict[str, list[str]] = {}
        for row in self.decided:
            rows.setdefault(row.decision.word, []).extend([] if row.m is None else [str(row.m)])
        members = {word: f" for m = {', '.join(ms)}" if ms else "" for word, ms in rows.items()}
        return "; ".join(word + ms for word, ms in members.items())

    def _table(self) -> Iterator[Table]:
        """The evidence of each verdict that has some."""
        rows = [
            ("" if row.m is None else str(row.m), row.grade, one_line("; ".join(row.support)))
            for row in self.decided
            if row.support
        ]
        if rows:
            yield Table(("m", "grade", "counterexample or reason"), tuple(rows), align="lll", keys=3)

    def data(self) -> dict[str, Any]:
        """The fields by their names, and the command that decides the claim."""
        plain = ("id", "says", "script", "title", "place", "reference", "case", "lacking")
        linked = {"uses": self.uses, "used_by": self.used_by, "near": self.near}
        return {
            **{name: getattr(self, name) for name in plain},
            **{key: [{"id": name, "says": says} for name, says in claims] for key, claims in linked.items()},
            **{name: list(getattr(self, name)) for name in ("procedures", "granted", "found")},
            "parts": [asdict(part) for part in self.parts],
            "shown_for_m": SHOWN_MEMBER,
            "run": self._command(),
        }

    def records(self) -> list[dict[str, Any]]:
        """A row a part, or one that says why there is none."""
        about = {"id": self.id, "script": self.script, "place": self.place, "case": self.case}
        rows = [asdict(part) for part in self.parts] or [{"name": "", "kind": "", "says": self.lacking}]
        return [{**about, "part": row["name"], "kind": row["kind"], "statement": row["says"]} for row in rows]

    def _command(self) -> str:
        return command("check", self.asked or self.script, "--only", self.id)


@dataclass(frozen=True)
class ClaimList(Answer):
    """All claims that can be explained.

    Args:
        proofs: for each script its title, and the ids of its claims with the author's words.
        asked: the script that was asked for; empty for those that come with lyapcheck.
    """

    schema = "lyapcheck/explain-list/1"

    proofs: tuple[tuple[str, str, tuple[tuple[str, str], ...]], ...]
    asked: str = ""

    def document(self) -> Document:
        """How many claims each script makes; of one script its claims."""
        count = sum(len(claims) for *_, claims in self.proofs)
        if len(self.proofs) == 1:
            ((name, about, claims),) = self.proofs
            more = (Bullets((f"{count - MOST_LISTED} more: -v lists them",)),) if count > MOST_LISTED else ()
            blocks: tuple[Block, ...] = (_claims(claims[:MOST_LISTED]), *more)
            title, lead = f"{count} claims of {name} can be explained", [about]
        else:
            rows = tuple((script, str(len(claims)), about) for script, about, claims in self.proofs)
            blocks = (Table(("script", "claims", "title"), rows, align="lrl", keys=3),)
            title, lead = f"{count} claims of {len(self.proofs)} scripts can be explained", []
        listed = (Section(f"{script}: {about}", (_claims(claims),)) for script, about, claims in self.proofs)
        first = next((claims[0][0] for *_, claims in self.proofs if claims), "16.6")
        where = ["--proof", self.asked] if self.asked else []
        return Document(
            title, blocks, lead=tuple(lead), details=tuple(listed), next=command("explain", first, *where)
        )

    def data(self) -> dict[str, Any]:
        """``results: [{script, id, says}]``."""
        rows = [
            {"script": script, "id": known, "says": says}
            for script, _, claims in self.proofs
            for known, says in claims
        ]
        return {"results": rows}


def list_claims(script: str | None = None) -> ClaimList:
    """The ids of all claims of a script, by default of those that come with lyapcheck.

    Raises:
        InputError: no such script, or one that cannot be used.
    """
    proofs = []
    for name in SHIPPED if script is None else (script,):
        path = find_script(name)
        handover = ask(ScriptRequest(str(path), path.name))
        proofs.append((path.name, handover.title, tuple((claim.id, claim.says) for claim in handover.claims)))
    return ClaimList(tuple(proofs), script or "")


def explain(
    claim_id: str, script: str | None = None, decide: bool = False, on_progress: Progress | None = None
) -> Explanation:
    """One claim explained.

    Args:
        claim_id: for example ``7a``. ``(7a)`` and ``7A`` mean the same if no other claim has that id.
        script: the proof script with the claim. Default: the first script of lyapcheck that has it.
        decide: True also decides the claim, for m = 1, 2, 3 and the paper's arm.
        on_progress: called with the fraction of that done and the id at work.

    Raises:
        InputError: no such claim, no such script, or one that cannot be used.

    Example:
        >>> found = explain("16.6")
        >>> found.place, [used for used, _ in found.uses]
        ('(16), term 6', ['15'])
        >>> print(explain("T1.torque.m2.elbow").parts[0].says)
        150 = 15
    """
    script_path, meant = _making(claim_id, script)
    case = paper_case_data(SHOWN_MEMBER)
    handover = ask(ScriptRequest(str(script_path), script_path.name, (case,), only=(meant,)))
    claims = {claim.id: claim for claim in handover.claims}
    claim = claims[meant]
    answer, (m, n, robot, _) = claim.answers[0], case
    values = {"m": f"m = {m}", "n": f"n = {n}", "robot": robot.name}
    stated = handover.stated(answer)
    statement = None if isinstance(stated, Missing) else stated
    formulas = set(FORMULA.findall(claim.place))
    return Explanation(
        id=claim.id,
        says=claim.says,
        script=script_path.name,
        title=handover.title,
        place=claim.place,
        reference=handover.reference,
        uses=tuple((used, claims[used].says) for used in claim.uses),
        used_by=tuple((other.id, other.says) for other in handover.claims if claim.id in other.uses),
        near=tuple(
            (other.id, other.says)
            for other in handover.claims
            if other != claim and formulas & {*FORMULA.findall(other.place)}
        ),
        case=", ".join(value for name, value in values.items() if name in answer.read),
        parts=() if statement is None else tuple(_parts("", statement)),
        lacking=stated.reason if isinstance(stated, Missing) else "",
        procedures=() if statement is None else tuple(dict.fromkeys(_procedures(statement))),
        granted=() if statement is None else statement.granted,
        decided=run_proof(script_path, only=(meant,), on_progress=on_progress).claims if decide else (),
        asked=script or "",
    )


def _making(claim_id: str, script: str | None) -> tuple[Path, str]:
    """The script that makes a claim, and the id that was meant."""
    paths = [find_script(name) for name in (SHIPPED if script is None else (script,))]
    known: list[str] = []
    for path in paths:
        ids = [claim.id for claim in ask(ScriptRequest(str(path), path.name)).claims]
        meant = _meant(claim_id, ids)
        if meant is not None:
            return path, meant
        known += ids
    check_ids(known, (claim_id,), ", ".join(path.name for path in paths))
    raise AssertionError("unreachable: an id that no proof has was accepted")


def _meant(claim_id: str, ids: Collection[str]) -> str | None:
    """The id that was meant: as written, or without brackets, or in other letters where only one fits."""
    bare = claim_id.strip().removeprefix("(").removesuffix(")")
    for wanted in (claim_id, bare):
        if wanted in ids:
            return wanted
    near = [known for known in ids if known.casefold() == bare.casefold()]
    return near[0] if len(near) == 1 else None


def _cited(reference: str) -> str:
    """Authors and year, where the bibliography has a work under that key; else the reference as it is."""
    works = (shipped("proofs") / "references.bib").read_text(encoding="utf-8")
    entry = re.search(rf"^@\w+\{{{re.escape(reference)},(.*?)^\}}", works, re.DOTALL | re.MULTILINE)
    fields = {} if entry is None else dict(re.findall(r"(\w+) *= \{(.*)\}", entry[1]))
    if "author" not in fields:
        return reference
    text = fields["author"].replace(r"{\o}", "ø")
    authors = re.sub(r"\{\\(['~])(\w)\}", lambda it: normalize("NFC", it[2] + ACCENTS[it[1]]), text)
    names = [author.partition(",")[0] for author in authors.split(" and ")]
    return f"{' and '.join(names) if len(names) < 3 else f'{names[0]} et al.'} ({fields['year']})"


def _claims(claims: tuple[tuple[str, str], ...]) -> Block:
    if not claims:
        return Paragraph("No other claim.")
    rows = tuple((known, one_line(says)) for known, says in claims)
    return Table(("claim", "the author's words"), rows, align="ll")


def _blocks(text: str) -> Iterator[Block]:
    """Paragraphs and lists of a documentation."""
    for block in text.split("\n\n"):
        if block.startswith("- "):
            yield Bullets(tuple(map(one_line, block[2:].split("\n- "))))
        else:
            yield Paragraph(one_line(block))


def _parts(name: str, statement: Statement) -> list[Part]:
    if isinstance(statement, AllOf):
        return [
            result
            for inner, part in statement.parts
            for result in _parts(f"{name}, {inner}" if name else inner, part)
        ]
    return [Part(name, type(statement).__name__, statement.text())]


def _procedures(statement: Statement) -> list[str]:
    """How each part is decided: what its kind is, and how a proof of it is searched."""
    if isinstance(statement, AllOf):
        return [text for _, part in statement.parts for text in _procedures(part)]
    kind = type(statement)
    procedure = procedure_of(kind)
    searched = "" if procedure is procedure_of(Statement) else inspect.getdoc(procedure) or ""
    by = (judge for (known, _), judge in RULES.items() if known is kind)
    modules = dict.fromkeys(map(inspect.getmodule, (kind, *by)))
    described = ((inspect.getdoc(module) or "").split("References:")[0].strip() for module in modules)
    own = "\n\n".join(filter(None, (*described, searched))).replace("``", "")
    parts = statement.obligations() if isinstance(statement, Flow) else ()
    kinds = {type(part): part for _, part in parts}
    return [own, *(text for part in kinds.values() for text in _procedures(part))]
