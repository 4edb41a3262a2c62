"""From C source to functions that can be called: from the cache, freshly compiled, or not at all.

A damaged library would crash the loader of the system, so that only whole ones are handed out; what is loaded
is a private copy of the bytes that were checked.
"""

from __future__ import annotations

import contextlib
import ctypes
import tempfile
from collections.abc import Callable, Iterator
from pathlib import Path

from lyapcheck import store
from lyapcheck.compiled.compiler import compile_library
from lyapcheck.temporary import pending

ROOM = "kernels"


def library(key: str, command: str, source: Callable[[], str | None]) -> ctypes.CDLL | None:
    """The library kept under a key, or what the compiler makes of its source; none where that fails.

    Args:
        key: the digest of all that the library depends on, compiler and processor included.
        command: the compiler.
        source: writes the C text; asked only where nothing is kept.
    """
    try:
        with workplace() as place:
            path = place / "kernel.so"
            _fetch(key, command, source, path)
            return ctypes.CDLL(str(path))  # it stays in memory when its file is gone
    except OSError:
        return None


def _fetch(key: str, command: str, source: Callable[[], str | None], path: Path) -> None:
    """Put the library at ``path``, if it is kept or can be compiled."""
    body = store.kept(ROOM, f"{key}.so")
    if body is not None:
        path.write_bytes(body)
        return
    text = source()
    if text is not None and compile_library(text, path, command):
        store.keep(ROOM, f"{key}.so", path.read_bytes())


@contextlib.contextmanager
def workplace() -> Iterator[Path]:
    """A private directory that is gone afterwards."""
    with tempfile.TemporaryDirectory(prefix="lyapcheck-") as name, pending(name):
        yield Path(name)
