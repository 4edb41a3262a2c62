"""Files and folders that must not outlive the command that makes them, however it ends."""

from __future__ import annotations

import os
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path

ROOM = 65_536
"""Bytes that a folder must take."""

_pending: set[str] = set()


@contextmanager
def pending(path: str | Path) -> Iterator[None]:
    """While this lasts, `clear` removes the file or folder; who made it removes or moves it otherwise."""
    _pending.add(str(path))
    try:
        yield
    finally:
        _pending.discard(str(path))


@contextmanager
def temporary_folder() -> Iterator[str]:
    """A new folder that is removed at the end, also where the command is ended by a signal."""
    from tempfile import TemporaryDirectory  # with shutil and random: commands that need none start sooner

    with TemporaryDirectory(prefix="lyapcheck-") as folder, pending(folder):
        yield folder


def work_in(place: str) -> None:
    """Put the temporary files of this process where who started it can remove them."""
    import tempfile

    tempfile.tempdir = place


def try_writing(folder: str | Path) -> None:
    """Write some bytes into a folder and take them back, to know before long work that its result will fit.

    Raises:
        OSError: the folder cannot be written to, or its disk is full.
    """
    from tempfile import TemporaryFile

    with TemporaryFile(dir=folder) as stream:
        stream.write(bytes(ROOM))


def clear() -> None:
    """Remove what is pending: for a process that ends here and now."""
    for path in tuple(_pending):
        if os.path.isdir(path):
            import shutil  # whoever made a folder has loaded it

            shutil.rmtree(path, ignore_errors=True)
        elif os.path.exists(path):
            os.unlink(path)
