"""Compiled libraries kept in the user's cache: private, named by content, checked before use.

A kept file is the library followed by its SHA-256, so that a damaged one is found before it is loaded: the
loader of the system would crash on it. What is loaded is a private copy of the bytes that were checked.
"""

from __future__ import annotations

import contextlib
import hashlib
import os
import stat
import tempfile
from collections.abc import Iterator
from pathlib import Path

from lyapcheck.temporary import pending

_DIGEST = hashlib.sha256().digest_size


def directory() -> Path:
    """$XDG_CACHE_HOME/lyapcheck/kernels, or the same in ~/.cache."""
    given = os.environ.get("XDG_CACHE_HOME", "")
    base = Path(given) if given and Path(given).is_absolute() else Path("~/.cache").expanduser()
    return base / "lyapcheck" / "kernels"


def kept(key: str) -> bytes | None:
    """The library kept under a key, if it is there, ours alone to write, and whole."""
    path = directory() / f"{key}.so"
    try:
        if not _private(path.parent) or not _private(path):
            return None
        content = path.read_bytes()
    except OSError:
        return None
    body, digest = content[:-_DIGEST], content[-_DIGEST:]
    return body if body and hashlib.sha256(body).digest() == digest else None


def keep(key: str, body: bytes) -> Path | None:
    """Put a fresh library under its key in one step; none if the cache cannot be written."""
    try:
        home = directory()
        home.mkdir(mode=0o700, parents=True, exist_ok=True)
        if not _private(home):
            return None
        return _write(home, body + hashlib.sha256(body).digest()).replace(home / f"{key}.so")
    except (OSError, RuntimeError):
        return None


def _write(home: Path, content: bytes) -> Path:
    """A new file that only this user can read, gone again if it cannot be written to its end."""
    handle, name = tempfile.mkstemp(dir=home, prefix=".new-")
    try:
        with pending(name), os.fdopen(handle, "wb") as file:
            file.write(content)
    except OSError:
        Path(name).unlink(missing_ok=True)
        raise
    return Path(name)


@contextlib.contextmanager
def workplace() -> Iterator[Path]:
    """A private directory that is gone afterwards."""
    with tempfile.TemporaryDirectory(prefix="lyapcheck-") as name, pending(name):
        yield Path(name)


def _private(path: Path) -> bool:
    """Whether only this user can change it: code is loaded from here."""
    status = path.stat()
    mine = not hasattr(os, "getuid") or status.st_uid == os.getuid()
    return mine and not status.st_mode & (stat.S_IWGRP | stat.S_IWOTH)
