"""Are these certificates right: the outcome of the small checker, for the formats that it has not itself."""

from __future__ import annotations

import json
from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from typing import Any

from lyapcheck.check.granted import GENERAL
from lyapcheck.check.recheck import Checked, Outcome
from lyapcheck.kernel.coq import Kernel
from lyapcheck.output.annotations import Annotation, Level
from lyapcheck.output.answer import Answer
from lyapcheck.output.document import Block, Bullets, Document, Paragraph, Section, Table
from lyapcheck.rechecking.render import as_json

SIGNS = {"refused": "✗", "undecided": "?", "accepted": "✓"}
"""What must be seen first comes first."""
LEVELS = {"refused": Level.FAILED, "undecided": Level.UNDECIDED, "accepted": Level.PASSED}
RULES = {
    "certificate": "a certificate shows what it states, and so do those that it uses",
    "alarm": "no statement is both proved and refuted",
}
ALARM = "the checker is wrong; trust none of these verdicts, and report this"
WHOSE = "Statements are rendered from their data; what their authors call them stands in quotation marks."


@dataclass(frozen=True)
class Recheck(Answer):
    """What became of certificates.

    Args:
        outcome: of the checker.
        trusted: whether to list the rules and modules that the verdicts rest on.
        kernel: what Coq's kernel says of each certificate, if it was asked.
    """

    schema = "lyapcheck/recheck/3"

    outcome: Outcome
    trusted: bool = False
    kernel: tuple[Kernel, ...] = ()

    def document(self) -> Document:
        """Alarms, then every certificate, those that are not accepted first, then what all of it rests on."""
        parts = (
            self._alarms(),
            self._checked(),
            self._kernel(),
            self._theorems(),
            self._granted(),
            self._code(),
        )
        unlimited = [name for name in ("seconds", "memory") if name not in self.outcome.limited]
        notes = (WHOSE, *(f"The system keeps no limit on {name} here." for name in unlimited))
        return Document(self._title(), tuple(section for part in parts for section in part), notes)

    def data(self) -> dict[str, Any]:
        """What the checker writes as JSON."""
        result: dict[str, Any] = json.loads(as_json(self.outcome, self.trusted))
        return {key: value for key, value in result.items() if key != "schema"}

    def records(self) -> list[dict[str, Any]]:
        """A row a certificate."""
        return [
            {key: "; ".join(value) if isinstance(value, list) else value for key, value in row.items()}
            for row in self.data()["certificates"]
        ]

    def annotations(self) -> list[Annotation]:
        """A case an alarm and a case a certificate, which is known by its file."""
        alarms = [
            Annotation(Level.FAILED, "alarm", RULES["alarm"], "alarm", f"statement {alarm.digest[:12]}", text)
            for alarm, text in zip(self.outcome.alarms, self._alarm_texts(), strict=True)
        ]
        return [*alarms, *map(_annotation, self.outcome.checked)]

    def _title(self) -> str:
        result = {status: self._with(status) for status in SIGNS}
        worst = next((status for status in SIGNS if result[status]), "undecided")
        tally = ", ".join(f"{len(ones)} {status}" for status, ones in result.items() if ones)
        verdicts = [one.verdict for one in result["accepted"]]
        shown = ", ".join(f"{verdicts.count(v)} {v}" for v in ("proved", "refuted") if v in verdicts)
        counted = f"{tally or 'no certificates'}{f' ({shown})' if shown else ''}"
        return f"✗ ALARM: {ALARM}: {counted}" if self.outcome.alarms else f"{SIGNS[worst]} {counted}"

    def _alarm_texts(self) -> list[str]:
        return [
            f"one statement is both proved, in {', '.join(alarm.proved)}, and refuted, in "
            f"{', '.join(alarm.refuted)}: {ALARM}; statement {alarm.digest[:12]}: {alarm.statement}"
            for alarm in self.outcome.alarms
        ]

    def _alarms(self) -> Iterator[Section]:
        if self.outcome.alarms:
            yield Section("Alarms", (Bullets(tuple(self._alarm_texts())),))

    def _checked(self) -> Iterator[Section]:
        for status in SIGNS:
            if result := self._with(status):
                table = _accepted(result) if status == "accepted" else _not_accepted(result)
                yield Section(f"{status.capitalize()} ({len(result)})", (table,))

    def _with(self, status: str) -> list[Checked]:
        return [one for one in self.outcome.checked if one.status == status]

    def _kernel(self) -> Iterator[Section]:
        """What Coq's kernel accepted, and why not the others."""
        if self.kernel:
            rows = tuple(
                (SIGNS["accepted"] if one.accepted else "·", one.file, one.axioms or one.reason)
                for one in self.kernel
            )
            accepted = sum(one.accepted for one in self.kernel)
            heads = ("", "file", "golden list of its axioms, or why not")
            yield Section(
                f"Coq's kernel ({accepted} of {len(rows)})", (Table(heads, rows, align="lll", keys=2),)
            )

    def _theorems(self) -> Iterator[Section]:
        rows = [
            (name, self.outcome.references[name], ", ".join(files))
            for name, files in self.outcome.theorems.items()
        ]
        if rows:
            heads = ("theorem", "where it is proved", "certificates that rest on it")
            yield Section("Theorems applied", (Table(heads, tuple(rows), align="lll"),))

    def _granted(self) -> Iterator[Section]:
        """What every verdict takes for granted, and what only some do, files of which that is so together."""
        groups: dict[tuple[str, ...], list[str]] = {}
        for one in self.outcome.checked:
            if granted := self.outcome.granted.get(one.file):
                groups.setdefault(granted, []).append(one.file)
        blocks: list[Block] = [Paragraph("By every verdict:"), Bullets(GENERAL)]
        for granted, files in groups.items():
            blocks += [Paragraph(f"By {', '.join(files)}:"), Bullets(granted)]
        yield Section("Taken for granted", tuple(blocks))

    def _code(self) -> Iterator[Section]:
        """The rules and modules behind all that is proved, and behind all that is refuted."""
        for verdict, code in self.data().get("trusted", {}).items():
            rows = tuple((name, ", ".join(at)) for name, at in code["rules"].items())
            rules = Table(("rule", "lies in"), rows, align="ll")
            rests = Paragraph(f"With all that these import, {len(code['modules'])} modules:")
            blocks = (rules, rests, Bullets(tuple(code["modules"])))
            yield Section(f"Trusted for all that is {verdict}", blocks)


def _accepted(result: Sequence[Checked]) -> Table:
    heads = ("", "file", "verdict", "grade", "statement")
    rows = []
    for one in result:
        rows.append((SIGNS[one.status], one.file, one.verdict, one.grade, one.finding.statement))
        rows.append(("", "", "", "", _words(one)))
    return Table(heads, tuple(rows), align="lllll", keys=4)


def _not_accepted(result: Sequence[Checked]) -> Table:
    """Why not; and of those that may still be, what they state."""
    rows = []
    for one in result:
        rows.append((SIGNS[one.status], one.file, one.reason))
        if one.status == "undecided" and one.finding.statement:
            rows += [("", "", text) for text in (_open_statement(one), _words(one))]
    return Table(("", "file", "reason"), tuple(rows), align="lll", keys=2)


def _words(one: Checked) -> str:
    """The mark of the statement, and what its author calls it."""
    result = one.finding
    member = f" (m = {result.m})" if result.m is not None else ""
    mark = result.statement_digest[:12]
    return f"statement {mark}; the author's words: {result.label}{member}: “{result.says}”"


def _open_statement(one: Checked) -> str:
    return f"the statement, if the rest is shown {one.finding.verdict}: {one.finding.statement}"


def _annotation(one: Checked) -> Annotation:
    stated = f"; {_open_statement(one)}" if one.finding.statement else ""
    said = {"accepted": "", "refused": one.reason, "undecided": f"{one.reason}{stated}"}
    path = str(one.document.path)
    return Annotation(
        LEVELS[one.status], "certificate", RULES["certificate"], one.file, "", said[one.status], path
    )
