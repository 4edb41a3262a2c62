"""What changed between two reports: verdicts, gates, margins and ε₀, the worse first."""

from __future__ import annotations

import json
from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from lyapcheck.errors import InputError, Problem
from lyapcheck.files.reader import REPORT, read_text
from lyapcheck.output.answer import Annotation, Answer, Level
from lyapcheck.output.document import Block, Document, Paragraph, Section, Table
from lyapcheck.verdicts import Exit

SCHEMAS = ("lyapcheck/report/2",)
ORDER = ("error", "refuted", "rejected", "undecided", "absent", "accepted", "proved")
"""From bad to good; ``absent`` where one of the reports does not have it."""
NUMBERS = ("published", "scalar", "certified", "falsified")


@dataclass(frozen=True)
class ReportChange:
    """One thing that is not as it was.

    Args:
        what: ``claim``, ``gate``, ``margin`` or ``ε₀``.
        subject: what it is about.
        old, new: what was and what is.
        worse: whether a verdict is worse now; numbers alone never are.
    """

    what: str
    subject: str
    old: str
    new: str
    worse: bool


@dataclass(frozen=True)
class ReportComparison(Answer):
    """Two reports side by side.

    Args:
        changes: the worse first.
        old: how the older one is called.
    """

    schema = "lyapcheck/report-comparison/1"

    changes: tuple[ReportChange, ...]
    old: str

    @property
    def exit_code(self) -> Exit:
        """1 where a verdict got worse, else 0."""
        return Exit.REFUTED if any(change.worse for change in self.changes) else Exit.PROVED

    def document(self) -> Document:
        """What got worse, then everything else that changed."""
        worse = [change for change in self.changes if change.worse]
        rest = [change for change in self.changes if not change.worse]
        blocks: list[Block] = [Section(f"Worse ({len(worse)})", (_table(worse),))] if worse else []
        blocks += [Section(f"Changed ({len(rest)})", (_table(rest),))] if rest else []
        if not blocks:
            blocks.append(Paragraph("No verdict, margin or ε₀ has changed."))
        sign = "✗" if worse else "✓"
        title = f"{sign} {len(worse)} worse, {len(rest)} other changes since {self.old}"
        return Document(title, tuple(blocks))

    def data(self) -> dict[str, Any]:
        """``changes: [{what, subject, old, new, worse}]``."""
        return {"old": self.old, "changes": [vars(change) for change in self.changes]}

    def records(self) -> list[dict[str, Any]]:
        """A row a change."""
        return [vars(change) for change in self.changes]

    def annotations(self) -> list[Annotation]:
        """A case a change."""
        return [
            Annotation(
                Level.FAILED if change.worse else Level.REMARK,
                change.what,
                "no verdict gets worse",
                change.subject,
                "",
                f"was {change.old}, is {change.new}",
            )
            for change in self.changes
        ]


def compare(old: Mapping[str, Any], new: Mapping[str, Any], name: str) -> ReportComparison:
    """What changed from one report's data to another's.

    Args:
        old, new: as ``report.json`` holds them.
        name: how the older is called.
    """
    changes = [*_verdicts(old, new), *_gates(old, new), *_epsilons(old, new)]
    return ReportComparison(tuple(sorted(changes, key=lambda change: not change.worse)), name)


def read_report(path: Path) -> dict[str, Any]:
    """The data of a report on disk: its JSON file, or the folder it is in.

    Raises:
        InputError: it cannot be read, or is no report of a known schema.
    """
    file = path / "report.json" if path.is_dir() else path
    text = read_text(file, REPORT)
    try:
        result = json.loads(text)
        schema = result["schema"] if isinstance(result, dict) else None
    except (ValueError, KeyError, RecursionError) as error:
        rule = f"cannot be read as a report ({error})"
        repair = "name a report.json, or the folder that holds it"
        raise InputError(Problem(str(file), None, "--compare", "", rule, repair)) from error
    if schema not in SCHEMAS:
        rule = f"has the schema {schema!r}, known is {SCHEMAS[0]!r}"
        repair = "write the old report again with this version"
        raise InputError(Problem(str(file), None, "--compare", "", rule, repair))
    try:
        compare(result, result, str(file))
    except (LookupError, TypeError, AttributeError, ValueError) as error:
        rule = f"has other rows than a report ({type(error).__name__}: {error})"
        repair = "name a report.json as lyapcheck report writes it"
        raise InputError(Problem(str(file), None, "--compare", "", rule, repair)) from error
    return dict(result)


def _table(changes: list[ReportChange]) -> Table:
    rows = tuple((change.what, change.subject, change.old, change.new) for change in changes)
    return Table(("what", "of", "was", "is"), rows, align="llll", keys=2)


def _pairs(old: Mapping[Any, Any], new: Mapping[Any, Any]) -> Iterator[tuple[Any, Any, Any]]:
    for key in dict.fromkeys([*old, *new]):
        yield key, old.get(key), new.get(key)


def _verdicts(old: Mapping[str, Any], new: Mapping[str, Any]) -> Iterator[ReportChange]:
    # a report of an older version has no gain sets in its rows
    named = all("gains" in row for report in (old, new) for row in report["claims"])

    def rows(report: Mapping[str, Any]) -> dict[tuple[Any, ...], str]:
        every = (*report["claims"], *report["others"])
        return {
            (row["proof"], row["id"], row["gains"] if named else None, row["m"]): (
                f"{row['verdict']} [{row['grade']}]"
            )
            for row in every
        }

    for (proof, claim, gains, m), was, now in _pairs(rows(old), rows(new)):
        if was != now:
            member = f", {gains}" if gains else "" if m is None else f", m = {m}"
            yield _change("claim", f"{proof}: {claim}{member}", was, now)


def _gates(old: Mapping[str, Any], new: Mapping[str, Any]) -> Iterator[ReportChange]:
    def rows(report: Mapping[str, Any]) -> dict[str, Any]:
        return {row["name"]: row for row in report["gate"]}

    for name, was, now in _pairs(rows(old), rows(new)):
        verdicts = [one["verdict"] if one else None for one in (was, now)]
        if verdicts[0] != verdicts[1]:
            yield _change("gate", name, *verdicts)
        if was and now:
            margins = [{(c["id"], c["joint"]): c["margin"] for c in one["checks"]} for one in (was, now)]
            for (check, joint), before, after in _pairs(*margins):
                if before != after:
                    subject = f"{name}: ({check}) {joint or 'all'}"
                    yield ReportChange("margin", subject, before or "none", after or "none", False)


def _epsilons(old: Mapping[str, Any], new: Mapping[str, Any]) -> Iterator[ReportChange]:
    def rows(report: Mapping[str, Any]) -> dict[tuple[str, str], str]:
        return {(row["name"], kind): row[kind] or "none" for row in report["epsilon"] for kind in NUMBERS}

    for (name, kind), was, now in _pairs(rows(old), rows(new)):
        if was != now:
            lost = kind == "certified" and was not in (None, "none") and now in (None, "none")
            yield ReportChange("ε₀", f"{name}: {kind}", was or "absent", now or "absent", lost)


def _change(what: str, subject: str, was: str | None, now: str | None) -> ReportChange:
    before, after = was or "absent", now or "absent"
    ranks = [ORDER.index(word.split()[0]) if word.split()[0] in ORDER else 0 for word in (before, after)]
    return ReportChange(what, subject, before, after, ranks[1] < ranks[0])
