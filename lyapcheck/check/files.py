"""Certificates from files and directories: regular files alone, and no more bytes than a certificate has."""

from __future__ import annotations

import os
import stat
from collections import Counter
from collections.abc import Iterable
from dataclasses import dataclass
from pathlib import Path

from lyapcheck.check.judgement import MAX_BYTES
from lyapcheck.check.refusal import plain

SORTS = {
    stat.S_IFDIR: "a directory",
    stat.S_IFIFO: "a pipe",
    stat.S_IFCHR: "a device",
    stat.S_IFBLK: "a device",
    stat.S_IFSOCK: "a socket",
}


class Unreadable(Exception):
    """Arguments that cannot be used: pairs (name, what is wrong)."""

    def __init__(self, problems: list[tuple[str, str]]) -> None:
        self.problems = [(plain(name), plain(rule)) for name, rule in problems]
        super().__init__("; ".join(f"{name}: {rule}" for name, rule in self.problems))


@dataclass(frozen=True)
class Document:
    """A file that may be a certificate: the name it goes by, and whether the user named it by itself."""

    file: str
    path: Path
    named: bool = True


def gather(paths: Iterable[str | Path]) -> list[Document]:
    """The files among the paths, and all ``.json`` entries of the directories among them.

    Files go by their names without the folder, unless two have the same.

    Raises:
        Unreadable: naming every path that is neither a readable regular file nor a directory of certificates.
    """
    result: list[Document] = []
    problems: list[tuple[str, str]] = []
    for path in map(Path, paths):
        try:
            result += _documents(path)
        except (OSError, ValueError) as error:
            problems.append((str(path), words(error)))
    if problems:
        raise Unreadable(problems)
    times = Counter(one.path.name for one in result)
    shown = (one.path.name if times[one.path.name] == 1 else str(one.path) for one in result)
    return [Document(plain(name), one.path, one.named) for name, one in zip(shown, result, strict=True)]


def _documents(path: Path) -> list[Document]:
    if not stat.S_ISDIR(os.stat(path).st_mode):
        content(path)
        return [Document(path.name, path)]
    names = sorted(name for name in os.listdir(path) if name.endswith(".json"))
    if not names:
        raise ValueError("the directory has no certificates (*.json)")
    return [Document(name, path / name, named=False) for name in names]


def content(path: Path) -> bytes:
    """The bytes of a regular file.

    Raises:
        OSError: it cannot be read.
        ValueError: it is not a regular file, too large, or changes while it is read.
    """
    _require_regular(os.stat(path).st_mode)
    # whatever has taken its place since then must not keep us waiting
    descriptor = os.open(path, os.O_RDONLY | getattr(os, "O_NONBLOCK", 0) | getattr(os, "O_BINARY", 0))
    with os.fdopen(descriptor, "rb") as file:
        before = os.fstat(descriptor)
        _require_regular(before.st_mode)
        if before.st_size > MAX_BYTES:
            raise ValueError(f"has {before.st_size} bytes, above {MAX_BYTES}, which no certificate has")
        result = file.read(MAX_BYTES + 1)
    if len(result) != before.st_size:
        raise ValueError("changes while it is read; copy it first")
    return result


def _require_regular(mode: int) -> None:
    if not stat.S_ISREG(mode):
        raise ValueError(f"is {SORTS.get(stat.S_IFMT(mode), 'something else')}, not a regular file")


def words(error: Exception) -> str:
    """What is wrong with a file, as a user reads it."""
    return f"cannot be read ({error.strerror})" if isinstance(error, OSError) else str(error)
