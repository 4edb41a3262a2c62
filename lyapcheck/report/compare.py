"""What changed between two reports: verdicts, gates, tiles, margins and ε₀, the worse first."""

from __future__ import annotations

import json
from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from lyapcheck.errors import InputError, Problem
from lyapcheck.files.reader import REPORT, read_text
from lyapcheck.output.answer import Answer
from lyapcheck.output.document import Document, Paragraph, Section, Table
from lyapcheck.report.model import KINDS
from lyapcheck.verdicts import Exit

SCHEMA = "lyapcheck/report/2"
ORDER = ("error", "refuted", "rejected", "undecided", "absent", "accepted", "proved")
"""From bad to good; ``absent`` where one of the reports does not have it."""
NONE, ABSENT = "none", "absent"


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
        groups = {
            title: [(one.what, one.subject, one.old, one.new) for one in self.changes if one.worse is worse]
            for title, worse in (("Worse", True), ("Changed", False))
        }
        blocks = tuple(
            Section(
                f"{title} ({len(rows)})", (Table(("what", "of", "was", "is"), tuple(rows), "", "llll", 2),)
            )
            for title, rows in groups.items()
            if rows
        )
        sign, count = "✗" if groups["Worse"] else "✓", {title: len(rows) for title, rows in groups.items()}
        verdicts = f"{count['Worse']} worse verdict{'' if count['Worse'] == 1 else 's'}"
        title = f"{sign} {verdicts}, {count['Changed']} other changes since {self.old}"
        return Document(title, blocks or (Paragraph("No verdict, tile, margin or ε₀ has changed."),))

    def data(self) -> dict[str, Any]:
        """``changes: [{what, subject, old, new, worse}]``."""
        return {"old": self.old, "changes": self.records()}

    def records(self) -> list[dict[str, Any]]:
        """A row a change."""
        return [vars(change) for change in self.changes]


def compare(old: Mapping[str, Any], new: Mapping[str, Any], name: str) -> ReportComparison:
    """What changed from one report's data to another's.

    Args:
        old, new: as ``report.json`` holds them.
        name: how the older is called.
    """
    # a report of an older version has no gain sets in its rows
    named = all("gains" in row for report in (old, new) for row in report["claims"])
    before, after = (dict(_facts(report, named)) for report in (old, new))
    changes = []
    for what, subject, group in dict.fromkeys([*before, *after]):
        was, now = (facts.get((what, subject, group), ABSENT) for facts in (before, after))
        # of a gain set that one of them has not, its verdict says enough
        if was != now and not (what in ("margin", "tile") and ABSENT in (was, now)):
            ranks = [ORDER.index(word.split()[0]) if word.split()[0] in ORDER else 0 for word in (was, now)]
            worse = what in ("claim", "gate") and ranks[1] < ranks[0]
            lost = group == "certified" and was not in (NONE, ABSENT) and now in (NONE, ABSENT)
            changes.append(ReportChange(what, subject, was, now, worse or lost))
    return ReportComparison(tuple(sorted(changes, key=lambda change: not change.worse)), name)


def _facts(report: Mapping[str, Any], named: bool) -> Iterator[tuple[tuple[str, str, str], str]]:
    """All that may change: what it is, what it is about and, of ε₀, which; then the fact in words."""
    for row in (*report["claims"], *report["others"]):
        gains = row["gains"] if named else None
        member = f", {gains}" if gains else "" if row["m"] is None else f", m = {row['m']}"
        yield ("claim", f"{row['proof']}: {row['id']}{member}", ""), f"{row['verdict']} [{row['grade']}]"
    for row in report["gate"]:
        yield ("gate", row["name"], ""), row["verdict"]
        for one in row["checks"]:
            subject = f"{row['name']}: ({one['id']}) {one['joint'] or 'all'}"
            yield ("margin", subject, ""), one["margin"] or NONE
    for one in report.get("tiles", ()):
        yield ("tile", f"{one['gains']}: {one['subject']}", ""), one["number"]
    for row in report["epsilon"]:
        for kind in KINDS:
            yield ("ε₀", f"{row['name']}: {kind}", kind), row[kind] or NONE


def read_report(path: Path) -> dict[str, Any]:
    """The data of a report on disk: its JSON file, or the folder it is in.

    Raises:
        InputError: it cannot be read, or is no report of a known schema.
    """
    file = path / "report.json" if path.is_dir() else path

    def refused(rule: str, repair: str) -> InputError:
        return InputError(Problem(str(file), None, "--compare", "", rule, repair))

    try:
        result = json.loads(read_text(file, REPORT))
        schema = result["schema"] if isinstance(result, dict) else None
    except (ValueError, KeyError, RecursionError) as error:
        repair = "name a report.json, or the folder that holds it"
        raise refused(f"cannot be read as a report ({error})", repair) from error
    if schema != SCHEMA:
        rule = f"has the schema {schema!r}, known is {SCHEMA!r}"
        raise refused(rule, "write the old report again with this version")
    try:
        compare(result, result, str(file))
    except (LookupError, TypeError, AttributeError, ValueError) as error:
        rule = f"has other rows than a report ({type(error).__name__}: {error})"
        raise refused(rule, "name a report.json as lyapcheck report writes it") from error
    return dict(result)
