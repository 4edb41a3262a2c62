"""Files that commands write: whole or not at all."""

from __future__ import annotations

import os
import sys
from pathlib import Path
from typing import TYPE_CHECKING

from lyapcheck.errors import argument_error
from lyapcheck.temporary import pending, try_writing

if TYPE_CHECKING:
    from collections.abc import Mapping

    from lyapcheck.certificate import Certificate

OTHERS_NAMED = 8


def require_writable(option: str, path: Path) -> None:
    """Refuse a file that could not be written at the end, before the work is done.

    Raises:
        InputError: the directory does not exist, cannot be written or is full, or the path is a directory.
    """
    if path.is_dir():
        raise argument_error(option, path, "is a directory", "name a file")
    if _is_device(path):
        return
    parent = (path.resolve() if path.is_symlink() else path).parent
    if not parent.is_dir():
        raise argument_error(
            option, path, f"there is no directory {parent}", "create it or name another file"
        )
    _require_room(option, path, parent)


def open_folder(option: str, path: Path) -> Path:
    """A directory that can be written, made if need be.

    Raises:
        InputError: there is a file of that name, or the file system refuses or is full.
    """
    try:
        path.mkdir(parents=True, exist_ok=True)
    except OSError as error:
        raise argument_error(
            option, path, f"cannot be made ({error.strerror})", "name another directory"
        ) from error
    _require_room(option, path, path)
    return path


def write_certificates(folder: Path, *groups: Mapping[str, Certificate]) -> None:
    """Write certificates into a folder, each under its name, and note which others are there.

    Raises:
        InputError: one cannot be written.
    """
    made = {name: certificate for group in groups for name, certificate in group.items()}
    for name, certificate in made.items():
        write_whole(folder / name, certificate.text())
    others = sorted(path.name for path in folder.glob("*.json") if path.name not in made)
    if others:
        from lyapcheck.output.escapes import printable

        names = ", ".join(others[:OTHERS_NAMED])
        more = f" and {len(others) - OTHERS_NAMED} more" if len(others) > OTHERS_NAMED else ""
        what = f"{folder} has files that this run did not write, and recheck {folder} judges them, too"
        print(printable(f"note: {what}: {names}{more}"), file=sys.stderr)


def _require_room(option: str, path: Path, folder: Path) -> None:
    try:
        try_writing(folder)
    except OSError as error:
        rule = f"{folder} cannot be written to ({error.strerror})"
        raise argument_error(option, path, rule, "free some space, or name another place") from error


def write_whole(path: Path, content: str | bytes) -> None:
    """Write a file in one move: readers see the old file or the new one, never half of it.

    A link stays a link, to a new file; a device or a pipe is written to as it is.

    Raises:
        InputError: the file system refuses.
    """
    import tempfile

    temporary = None
    data = content.encode("utf-8") if isinstance(content, str) else content
    try:
        if _is_device(path):
            path.write_bytes(data)
            return
        target = path.resolve()
        handle, temporary = tempfile.mkstemp(dir=target.parent, prefix=f".{target.name}.")
        with pending(temporary):
            with os.fdopen(handle, "wb") as stream:
                stream.write(data)
            os.chmod(temporary, 0o666 & ~_umask())
            os.replace(temporary, target)
    except OSError as error:
        if temporary is not None and os.path.exists(temporary):
            os.unlink(temporary)
        raise argument_error(
            "file", path, f"cannot be written ({error.strerror})", "name another file"
        ) from error


def _is_device(path: Path) -> bool:
    """Whether a file in its place would take something else away: a device, a pipe, a socket."""
    return path.exists() and not path.is_file()


def _umask() -> int:
    mask = os.umask(0)
    os.umask(mask)
    return mask
