"""The one reader of files that users name: regular files alone, and no more bytes than their kind has.

A link to a regular file is fine. A folder, a device, a pipe or a link to one is refused before it is opened,
and once more by the descriptor: what takes its place in between must not keep anybody waiting.
"""

from __future__ import annotations

import io
import os
import stat
from dataclasses import dataclass

from lyapcheck.errors import InputError, file_error

TYPE_CHECKING = False  # so that nothing is imported that is not used
if TYPE_CHECKING:
    from pathlib import Path


@dataclass(frozen=True)
class Bound:
    """The most bytes that a file of one kind may have, and what to do about a larger one."""

    most: int
    repair: str


TOML = Bound(20_000_000, "split it into several files")
"""A file of ten thousand gain sets has about two million."""
ARM = Bound(1_000_000, "give an arm of one page")
"""An arm of nine joints with a page of notes has about twenty thousand."""
URDF = Bound(5_000_000, "give a file of one robot")
"""A humanoid with all its meshes named has about half a million."""
SCRIPT = Bound(2_000_000, "keep what is computed in modules that it imports")
"""The longest proof that comes with lyapcheck has fifty thousand."""
REPORT = Bound(50_000_000, "name a report.json, or the folder that holds it")
"""That of the paper's arm has a bit more than a million."""

_SORTS = {
    stat.S_IFDIR: ("is a folder", "name a file in it"),
    stat.S_IFIFO: ("is a pipe", "write what it gives to a file, and name that"),
    stat.S_IFSOCK: ("is a socket", "write what it gives to a file, and name that"),
}
_DEVICE = ("is a device", "name a regular file")
_FLAGS = os.O_RDONLY | getattr(os, "O_NONBLOCK", 0) | getattr(os, "O_BINARY", 0) | getattr(os, "O_CLOEXEC", 0)


def read_bytes(path: str | Path, bound: Bound, shown: str | None = None) -> bytes:
    """The content of a file that a user names.

    Args:
        path: of the file.
        bound: of its kind.
        shown: its name in messages, as the user wrote it.

    Raises:
        InputError: missing, unreadable, not a regular file, or larger than its kind may be.
    """
    name = sayable(str(path) if shown is None else shown)
    try:
        _require_regular(os.stat(path).st_mode, name)
        with os.fdopen(os.open(path, _FLAGS), "rb") as stream:
            status = os.fstat(stream.fileno())
            _require_regular(status.st_mode, name)
            # what has no end in spite of its size is not read to it
            content = b"" if status.st_size > bound.most else stream.read(bound.most + 1)
    except (OSError, ValueError) as error:
        reason = error.strerror if isinstance(error, OSError) and error.strerror else str(error)
        raise file_error(name, f"cannot be read ({reason})", "check the path") from None
    if status.st_size > bound.most or len(content) > bound.most:
        raise file_error(name, f"is larger than {bound.most} bytes", bound.repair)
    return content


def read_text(path: str | Path, bound: Bound, shown: str | None = None, newline: str | None = None) -> str:
    """The text of a file that a user names, without the mark of its byte order.

    Args:
        path: of the file.
        bound: of its kind.
        shown: its name in messages, as the user wrote it.
        newline: as for ``open``; by default every end of a line becomes ``\\n``.

    Raises:
        InputError: as for `read_bytes`, and where it is not UTF-8.
    """
    content = read_bytes(path, bound, shown)
    try:
        text = io.TextIOWrapper(io.BytesIO(content), encoding="utf-8-sig", newline=newline).read()
    except UnicodeDecodeError:
        text = "\0"
    if "\0" in text:  # as in UTF-16 without the mark of its byte order
        name = sayable(str(path) if shown is None else shown)
        raise file_error(name, "is not UTF-8 text", "save it as UTF-8")
    return text


def holds(path: Path, content: bytes) -> bool:
    """Whether there is a regular file with that content and nothing else."""
    try:
        return read_bytes(path, Bound(len(content), "")) == content
    except InputError:
        return False


def sayable(name: str) -> str:
    """A file name that can be written out, whatever bytes it has on disk."""
    return name.encode("utf-8", "backslashreplace").decode("utf-8")


def _require_regular(mode: int, name: str) -> None:
    if not stat.S_ISREG(mode):
        raise file_error(name, *_SORTS.get(stat.S_IFMT(mode), _DEVICE))
