"""From C source to functions that can be called: from the cache, freshly compiled, or not at all."""

from __future__ import annotations

import ctypes
from collections.abc import Callable
from pathlib import Path

from lyapcheck.compiled import store
from lyapcheck.compiled.compiler import compile_library


def library(key: str, command: str, source: Callable[[], str | None]) -> ctypes.CDLL | None:
    """The library kept under a key, or what the compiler makes of its source; none where that fails.

    Args:
        key: the digest of all that the library depends on, compiler and processor included.
        command: the compiler.
        source: writes the C text; asked only where nothing is kept.

    Soundness: what is loaded is a private copy of bytes that were checked to be whole.
    """
    try:
        with store.workplace() as place:
            path = place / "kernel.so"
            _fetch(key, command, source, path)
            return ctypes.CDLL(str(path))  # it stays in memory when its file is gone
    except OSError:
        return None


def _fetch(key: str, command: str, source: Callable[[], str | None], path: Path) -> None:
    """Put the library at ``path``, if it is kept or can be compiled."""
    body = store.kept(key)
    if body is not None:
        path.write_bytes(body)
        return
    text = source()
    if text is not None and compile_library(text, path, command):
        store.keep(key, path.read_bytes())
