"""Are these certificates right: the outcome of the small checker, for the formats that it has not itself."""

from __future__ import annotations

import json
import shutil
from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Any

from lyapcheck.check.recheck import Checked, Outcome
from lyapcheck.errors import argument_error
from lyapcheck.output.answer import Annotation, Answer, Level
from lyapcheck.output.document import Bullets, Document, Paragraph, Section, Table, command
from lyapcheck.output.text import View
from lyapcheck.process_tree import temporary_folder
from lyapcheck.rechecking import GENERAL, Writer, as_json, granted_of, unlimited

if TYPE_CHECKING:
    from lyapcheck.kernel import Kernel

SIGNS = {"refused": "✗", "undecided": "?", "accepted": "✓"}
"""What must be seen first comes first."""
LEVELS = {"refused": Level.FAILED, "undecided": Level.UNDECIDED, "accepted": Level.PASSED}
RULES = {
    "certificate": "a certificate shows what it states, and so do those that it uses",
    "alarm": "no statement is both proved and refuted",
}
ALARM = "the checker is wrong; trust none of these verdicts, and report this"
WHOSE = "Statements are rendered from their data; what their authors call them stands in quotation marks."
MOST_ROWS, MOST_REASONS, CELL = 10, 3, 60
MEANING = (
    "kernel: Coq's kernel accepted a theorem whose statement is printed from the certificate's own data, and "
    "whose axioms are on the golden list named: real has those of classical real numbers, float also the "
    "specifications of 63-bit integers and binary64 numbers"
)


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
        """Every certificate, those that are not accepted first, then what all of it rests on."""
        rows = [one for status in SIGNS for one in self._with(status)]
        more = [f"{len(rows) - MOST_ROWS} more: -v lists them"] if len(rows) > MOST_ROWS else []
        reasons = [f"{one.file}: {one.reason}" for one in rows if not one.accepted]
        said = (*more, *self._alarm_texts(), *reasons[: MOST_REASONS - len(more)])
        special = granted_of(self.outcome)
        return Document(
            self._title(),
            (
                *([self._table(rows[:MOST_ROWS])] if rows else []),
                *([Bullets(said)] if said else []),
                *self._code(),
            ),
            (
                WHOSE,
                *([MEANING] if self.kernel else []),
                *(f"The system keeps no limit on {name} here." for name in unlimited(self.outcome)),
                *(f"Every verdict: {text}" for text in GENERAL),
                *(f"{files}: {text}" for granted, files in special.items() for text in granted),
            ),
            (f"Coq's kernel accepts {sum(one.accepted for one in self.kernel)}",) if self.kernel else (),
            (*self._checked(), *self._theorems()),
            f"{len(GENERAL)} assumptions of every verdict{', others of some' if special else ''}: --explain",
            self._next(rows),
        )

    def _next(self, rows: Sequence[Checked]) -> str:
        paths = [one.document.path for one in rows]
        if not paths:
            return command("recheck", "--help")
        same = len(paths) > 1 and len({path.parent for path in paths}) == 1
        return command(
            "recheck", paths[0].parent if same else paths[0], "-v" if self.trusted else "--trusted"
        )

    def _table(self, rows: Sequence[Checked]) -> Table:
        """The verdict on each, and what it states or why it is not accepted; first reasons are remarks."""
        kernel = {one.file: one.axioms or one.reason for one in self.kernel}
        coq = ["axioms in Coq, or why not"] if kernel else []
        heads = ("", "file", "verdict", "grade", *coq, "statement")
        cells = []
        for number, one in enumerate(rows):
            said = one.finding.statement if one.accepted else one.reason
            said = said if len(said) <= CELL else f"{said[: CELL - 1]}…"  # the details have all
            if not one.accepted and number < MOST_REASONS - 1:
                said = "see below"
            verdict = (one.verdict, one.grade) if one.accepted else (one.status, "")
            axioms = [kernel.get(one.file, "")] if kernel else []
            cells.append((SIGNS[one.status], one.file, *verdict, *axioms, said))
        return Table(heads, tuple(cells), align="l" * len(heads), keys=4)

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

    def _checked(self) -> Iterator[Section]:
        """What each states, whole, with the words of its author."""
        for status, sign in SIGNS.items():
            for one in self._with(status):
                said = [one.finding.statement] if one.accepted else [one.reason]
                if one.status == "undecided" and one.finding.statement:
                    said.append(_open_statement(one))
                if one.status != "refused" and one.finding.statement:
                    result = one.finding
                    member = f" (m = {result.m})" if result.m is not None else ""
                    words = f"the author's words: {result.label}{member}: “{result.says}”"
                    said.append(f"statement {result.statement_digest[:12]}; {words}")
                yield Section(f"{sign} {one.file}: {one.verdict or status}", (Bullets(tuple(said)),))

    def _with(self, status: str) -> list[Checked]:
        return [one for one in self.outcome.checked if one.status == status]

    def _theorems(self) -> Iterator[Section]:
        rows = [
            (name, self.outcome.references[name], ", ".join(files))
            for name, files in self.outcome.theorems.items()
        ]
        if rows:
            heads = ("theorem", "where it is proved", "certificates that rest on it")
            yield Section("Theorems applied", (Table(heads, tuple(rows), align="lll"),))

    def _code(self) -> Iterator[Section]:
        """The rules and modules behind all that is proved, and behind all that is refuted."""
        for verdict, code in self.data().get("trusted", {}).items():
            rows = tuple((name, ", ".join(at)) for name, at in code["rules"].items())
            rules = Table(("rule", "lies in"), rows, align="ll")
            rests = Paragraph(f"With all that these import, {len(code['modules'])} modules:")
            blocks = (rules, rests, Bullets(tuple(code["modules"])))
            yield Section(f"Trusted for all that is {verdict}", blocks)


def _open_statement(one: Checked) -> str:
    return f"the statement, if the rest is shown {one.finding.verdict}: {one.finding.statement}"


def _annotation(one: Checked) -> Annotation:
    stated = f"; {_open_statement(one)}" if one.finding.statement else ""
    said = {"accepted": "", "refused": one.reason, "undecided": f"{one.reason}{stated}"}
    path = str(one.document.path)
    return Annotation(
        LEVELS[one.status], "certificate", RULES["certificate"], one.file, "", said[one.status], path
    )


def writer(
    name: str, seconds: int, folder: Path | None, progress: Callable[[str], None], view: View | None
) -> Writer:
    """What writes the outcome of the small checker in a format, once Coq's kernel has judged it as well.

    Args:
        name: of the format.
        seconds: the most that one theorem may take.
        folder: where the files for Coq are copied to in the end; ``None``: nowhere. Nothing is read there: a
            compiled file may be of other definitions than its source.
        progress: receives a note on what is going on.
        view: how a text is shown.

    Raises:
        InputError: there is no Coq, or the folder cannot take the files.
    """
    from lyapcheck.kernel import graded, judged, require_coq

    require_coq()

    def written(outcome: Outcome, trusted: bool) -> str:
        with temporary_folder() as place:
            result = judged(outcome, Path(place), seconds, progress)
            if folder is not None:
                _copied(place, folder)
        both = graded(outcome, result)
        if name == "json":
            return kernel_json(as_json(both, trusted), result)
        return Recheck(both, trusted, tuple(result)).written(name, view)

    return written


def _copied(place: str, folder: Path) -> None:
    """Copy the files for Coq.

    Raises:
        InputError: something else has one of their names.
    """
    try:
        shutil.copytree(place, folder, dirs_exist_ok=True)
    except OSError:
        rule = "has something else under a name of Coq's files"
        raise argument_error("--kernel-files", folder, rule, "name an empty directory") from None


def kernel_json(written: str, result: list[Kernel]) -> str:
    """The JSON of the small checker with ``kernel`` in the row of each certificate."""
    data = json.loads(written)
    for row, one in zip(data["certificates"], result, strict=True):
        row["kernel"] = {
            "accepted": one.accepted,
            "reason": one.reason,
            "theorem": one.theorem or None,
            "axioms": one.axioms or None,
        }
    return json.dumps(data, indent=2, ensure_ascii=False) + "\n"
