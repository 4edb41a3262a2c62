"""Files that commands write: whole or not at all."""

from __future__ import annotations

import os
import tempfile
from pathlib import Path

from lyapcheck.errors import argument_error
from lyapcheck.temporary import pending


def require_writable(option: str, path: Path) -> None:
    """Refuse a file that could not be written at the end, before the work is done.

    Raises:
        InputError: the directory does not exist or cannot be written, or the path is a directory.
    """
    parent = path.parent
    if path.is_dir():
        raise argument_error(option, path, "is a directory", "name a file")
    if not parent.is_dir():
        raise argument_error(
            option, path, f"there is no directory {parent}", "create it or name another file"
        )
    if not os.access(parent, os.W_OK):
        raise argument_error(option, path, f"{parent} cannot be written to", "name a file elsewhere")


def open_folder(option: str, path: Path) -> Path:
    """A directory that can be written, made if need be.

    Raises:
        InputError: there is a file of that name, or the file system refuses.
    """
    try:
        path.mkdir(parents=True, exist_ok=True)
    except OSError as error:
        raise argument_error(
            option, path, f"cannot be made ({error.strerror})", "name another directory"
        ) from error
    if not os.access(path, os.W_OK):
        raise argument_error(option, path, "cannot be written to", "name another directory")
    return path


def write_whole(path: Path, content: str | bytes) -> None:
    """Write a file in one move: readers see the old file or the new one, never half of it.

    Raises:
        InputError: the file system refuses.
    """
    temporary = None
    try:
        handle, temporary = tempfile.mkstemp(dir=path.parent, prefix=f".{path.name}.")
        with pending(temporary):
            with os.fdopen(handle, "wb") as stream:
                stream.write(content.encode("utf-8") if isinstance(content, str) else content)
            os.chmod(temporary, 0o666 & ~_umask())
            os.replace(temporary, path)
    except OSError as error:
        if temporary is not None and os.path.exists(temporary):
            os.unlink(temporary)
        raise argument_error(
            "file", path, f"cannot be written ({error.strerror})", "name another file"
        ) from error


def _umask() -> int:
    mask = os.umask(0)
    os.umask(mask)
    return mask
