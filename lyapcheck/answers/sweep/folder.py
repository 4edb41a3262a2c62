"""What a sweep leaves behind: rows as JSON lines and Parquet, certificates by content, a page with maps."""

from __future__ import annotations

import json
from collections.abc import Iterator, Mapping
from pathlib import Path
from typing import Any

from lyapcheck.answers.sweep.question import COLUMNS, Answered, line_of
from lyapcheck.errors import InputError, argument_error
from lyapcheck.files.reader import holds
from lyapcheck.process_tree import pending, try_writing

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

    def put(self, files: Mapping[str, str | bytes]) -> None:
        """Write files by their names in the folder."""
        try:
            for name, content in files.items():
                (self.path / name).parent.mkdir(exist_ok=True)
                _write(self.path / name, content if isinstance(content, bytes) else content.encode())
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
                while group := [
                    _cells(json.loads(line)) for _, line in zip(range(GROUP), rows, strict=False)
                ]:
                    writer.write_table(pa.Table.from_pylist(group, schema))
            path.replace(self.path / TABLE)


def _write(path: Path, content: bytes) -> None:
    """Write a file in one move: there is the whole of it or nothing."""
    part = path.with_name(f".{path.name}")
    with pending(part):
        part.write_bytes(content)
        part.replace(path)


def _cells(row: dict[str, Any]) -> dict[str, Any]:
    """A row with its data as JSON text."""
    return {**row, "answer": json.dumps(row["answer"], ensure_ascii=False, separators=(",", ":"))}


def full(path: Path, error: OSError) -> InputError:
    """The complaint about a folder that takes no more."""
    rule = f"cannot be written ({error.strerror or error})"
    return argument_error(
        "--out", path, rule, "free some space and go on with --resume, or name another folder"
    )
