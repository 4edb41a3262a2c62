"""Certificates from files and directories."""

from __future__ import annotations

from collections.abc import Iterable
from pathlib import Path

from lyapcheck.check.certificate import MAX_CHARACTERS, parse
from lyapcheck.check.recheck import Document
from lyapcheck.check.refusal import Refused


class Unreadable(Exception):
    """Files that cannot be read as JSON: pairs (name, what is wrong)."""

    def __init__(self, problems: list[tuple[str, str]]) -> None:
        self.problems = problems
        super().__init__("; ".join(f"{name}: {rule}" for name, rule in problems))


def gather(paths: Iterable[str | Path]) -> list[Document]:
    """The documents of files, and of all ``.json`` files of directories, which are complete collections.

    Files are known by their names without the folder.

    Raises:
        Unreadable: naming every file that cannot be read, or directory without certificates.
    """
    documents: list[Document] = []
    problems: list[tuple[str, str]] = []
    for path in map(Path, paths):
        for file in _files(path, problems):
            try:
                documents.append(_read(file, path.is_dir()))
            except (OSError, ValueError) as error:
                problems.append((str(file), _words(error)))
    if problems:
        raise Unreadable(problems)
    return documents


def _files(path: Path, problems: list[tuple[str, str]]) -> list[Path]:
    if not path.is_dir():
        return [path]
    found = sorted(path.glob("*.json"))
    if not found:
        problems.append((str(path), "the directory has no certificates (*.json)"))
    return found


def _read(file: Path, complete: bool) -> Document:
    if file.stat().st_size > 4 * MAX_CHARACTERS:
        raise ValueError(f"is above {4 * MAX_CHARACTERS} bytes")
    text = file.read_text(encoding="utf-8")
    try:
        return Document(file.name, parse(text), complete)
    except Refused as refusal:
        return Document(file.name, refusal, complete)


def _words(error: Exception) -> str:
    if isinstance(error, OSError):
        return f"cannot be read ({error.strerror})"
    return f"is not JSON in UTF-8 ({error})"
