"""Compiled libraries kept in the user's cache: private, named by content, checked before use.

A damaged library would crash the loader of the system, so that only whole ones are handed out; what is loaded
is a private copy of the bytes that were checked.
"""

from __future__ import annotations

import contextlib
import tempfile
from collections.abc import Iterator
from pathlib import Path

from lyapcheck import store
from lyapcheck.temporary import pending

ROOM = "kernels"


def directory() -> Path:
    """Where they are kept."""
    return store.home() / ROOM


def kept(key: str) -> bytes | None:
    """The library kept under a key, if it is there, ours alone to write, and whole."""
    return store.kept(ROOM, f"{key}.so")


def keep(key: str, body: bytes) -> Path | None:
    """Put a fresh library under its key in one step; none if the cache cannot be written."""
    return store.keep(ROOM, f"{key}.so", body)


@contextlib.contextmanager
def workplace() -> Iterator[Path]:
    """A private directory that is gone afterwards."""
    with tempfile.TemporaryDirectory(prefix="lyapcheck-") as name, pending(name):
        yield Path(name)
