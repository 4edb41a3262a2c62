"""What a sweep leaves: rows as JSON lines and Parquet, certificates by content; and how many came out how."""

from __future__ import annotations

import json
from collections import Counter
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from lyapcheck.answers.sweep.questions import COLUMNS, OBSERVED, SEEN, Answered, Row, line_of
from lyapcheck.errors import InputError, argument_error
from lyapcheck.files.reader import holds
from lyapcheck.output.answer import Answer
from lyapcheck.output.document import Bullets, Document, Section, Table, command
from lyapcheck.process_tree import pending, try_writing
from lyapcheck.verdicts import Exit

ROWS, PART, TABLE, CERTIFICATES = "rows.jsonl", ".rows.jsonl", "rows.parquet", "certificates"
GROUP = 1_000
"""Rows that are turned into Parquet at a time."""

RECENT = 1_000
"""Certificates that are not looked for again on the disk: many questions have some in common."""


class Folder:
    """A folder that takes the answers of a sweep in the order of its plan.

    Args:
        path: of the folder.
        resume: whether it may hold a sweep already, which is then gone over again.

    Raises:
        InputError: it cannot be written, or holds a sweep that is not to be resumed.
    """

    def __init__(self, path: Path, resume: bool) -> None:
        self.path = path
        self._recent: set[str] = set()
        held = [name for name in (ROWS, PART) if (path / name).exists()]
        if held and not resume:
            repair = "add --resume, or name another folder"
            raise argument_error("--out", path, f"holds a sweep already ({held[0]})", repair)
        try:
            (path / CERTIFICATES).mkdir(parents=True, exist_ok=True)
            try_writing(path)
        except OSError as error:
            raise full(path, error) from error

    def written(self, result: Iterator[Answered]) -> Iterator[Answered]:
        """The same answers, each with its certificates in the folder; the rows are whole when all are."""
        part = self.path / PART
        try:
            with open(part, "w", encoding="utf-8", newline="\n") as rows:
                for one in result:
                    self._put(one.certificates)
                    rows.write(line_of(one.row))
                    yield one
            part.replace(self.path / ROWS)
            self._tabulate()
        except OSError as error:
            raise full(self.path, error) from error

    def _put(self, certificates: Mapping[str, str]) -> None:
        """Every certificate under its digest; one that is there already stays if it is the same."""
        for digest, text in certificates.items():
            if digest in self._recent:
                continue
            if len(self._recent) == RECENT:
                self._recent.clear()
            self._recent.add(digest)
            path = self.path / CERTIFICATES / f"{digest}.json"
            content = text.encode()
            if not holds(path, content):
                _write(path, content)

    def _tabulate(self) -> None:
        """The rows as Parquet, where pyarrow is there."""
        try:
            import pyarrow as pa
            from pyarrow import parquet
        except ImportError:
            return
        text = pa.string()
        sorts = {"integer": pa.int64(), "number": pa.float64(), "text": text, "data": text}
        schema = pa.schema([(key, sorts.get(sort, pa.list_(text))) for key, sort in COLUMNS.items()])
        path = self.path / f".{TABLE}"
        with pending(path), open(self.path / ROWS, encoding="utf-8") as rows:
            with parquet.ParquetWriter(path, schema) as writer:
                while group := [json.loads(line) for _, line in zip(range(GROUP), rows, strict=False)]:
                    for row in group:  # its data are JSON text here
                        row["answer"] = json.dumps(row["answer"], ensure_ascii=False, separators=(",", ":"))
                    writer.write_table(pa.Table.from_pylist(group, schema))
            path.replace(self.path / TABLE)


def _write(path: Path, content: bytes) -> None:
    """Write a file in one move: there is the whole of it or nothing."""
    part = path.with_name(f".{path.name}")
    with pending(part):
        part.write_bytes(content)
        part.replace(path)


def full(path: Path, error: OSError) -> InputError:
    """The complaint about a folder that takes no more."""
    rule = f"cannot be written ({error.strerror or error})"
    return argument_error(
        "--out", path, rule, "free some space and go on with --resume, or name another folder"
    )


# --- The answer of the command: rows are in the folder, counts fit a page.


MOST_ROWS, MOST_REASONS = 12, 40
Arm = tuple[str, tuple[str, ...]]
"""A robot, and what varies."""
ORDER = {"error": 0, "refuted": 1, "rejected": 1, SEEN: 1, "undecided": 2}
"""What is wrong is seen first."""
EXITS = (Exit.INTERNAL, Exit.REFUTED, Exit.UNDECIDED, Exit.PROVED)
SIGNS = {Exit.PROVED: "✓", Exit.REFUTED: "✗", Exit.UNDECIDED: "?", Exit.INTERNAL: "!"}
ONLY_SEEN = "observed: a simulation in floating point that broke no promise; it proves nothing."


class Tally:
    """Counts that grow with every row, of reasons those that can be shown."""

    def __init__(self) -> None:
        self.counts: Counter[tuple[Arm, str, str]] = Counter()
        self.reasons: Counter[str] = Counter()

    def add(self, row: Row) -> None:
        """Count a row."""
        self.counts[(row["robot"], tuple(row["variation"])), row["ask"], row["verdict"]] += 1
        if row["reason"] and (row["reason"] in self.reasons or len(self.reasons) < MOST_REASONS):
            self.reasons[row["reason"]] += 1


@dataclass(frozen=True)
class SweepAnswer(Answer):
    """What a sweep found, as far as it fits a page; the rows are in its folder.

    Args:
        path: of the plan.
        tally: counts.
        certificates: the folder that has some; empty where there are none.
    """

    schema = "lyapcheck/sweep/1"

    path: str
    tally: Tally
    certificates: str = ""

    @property
    def exit_code(self) -> Exit:
        """4 if a question failed, else 1 if something is refuted or rejected, else 3 if undecided, else 0."""
        if not self.tally.counts:
            return Exit.UNDECIDED
        return EXITS[min(ORDER.get(verdict, 3) for _, _, verdict in self.tally.counts)]

    def document(self) -> Document:
        """Counts, what failed first, and why nothing was decided."""
        results = sorted(self.data()["results"], key=lambda row: ORDER.get(row["verdict"], 3))
        rows = [
            (", ".join([row["robot"], *row["variation"]]), row["ask"], row["verdict"], str(row["count"]))
            for row in results
        ]
        more = [f"{len(rows) - MOST_ROWS} further rows: -v"] if len(rows) > MOST_ROWS else []
        reasons = self.tally.reasons.most_common()
        said = (*more, *(f"{count} times: {text}" if count > 1 else text for text, count in reasons))
        again = command("sweep", self.path, "--out", "sweep")
        return Document(
            self._title(),
            (*([_counts(rows[:MOST_ROWS])] if rows else []), *([Bullets(said[:3])] if said else [])),
            (ONLY_SEEN,) if any(row[2] == OBSERVED for row in rows) else (),
            (),
            (
                *([_counts(rows)] if more else []),
                *([Section("Further reasons", (Bullets(said[3:10]),))] if said[3:] else []),
            ),
            "each arm is assumed to be as its file says: lyapcheck robot ARM --assumptions",
            command("recheck", self.certificates) if self.certificates else again,
        )

    def data(self) -> dict[str, Any]:
        """``results: [{robot, variation, ask, verdict, count}]``."""
        rows = [
            {"robot": robot, "variation": list(variation), "ask": ask, "verdict": verdict, "count": count}
            for ((robot, variation), ask, verdict), count in self.tally.counts.items()
        ]
        return {"plan": self.path.rsplit("/", 1)[-1], "results": rows}

    def _title(self) -> str:
        verdicts: Counter[str] = Counter()
        for (_, _, verdict), count in self.tally.counts.items():
            verdicts[verdict] += count
        total, parts = verdicts.total(), ", ".join(f"{count} {word}" for word, count in verdicts.items())
        return f"{SIGNS[self.exit_code]} {total} question{'' if total == 1 else 's'}: {parts or 'none asked'}"


def _counts(rows: Sequence[tuple[str, ...]]) -> Table:
    return Table(("arm", "question", "verdict", "count"), tuple(rows), align="lllr", keys=3)
