"""From C source to functions that can be called: from the cache, freshly compiled, or not at all."""

from __future__ import annotations

import ctypes
import hashlib
from functools import lru_cache
from importlib.resources import files
from pathlib import Path

from lyapcheck.compiled import store
from lyapcheck.compiled.compiler import compile_library, compiler, machine


def library(source: str) -> ctypes.CDLL | None:
    """The library of a source that builds on ``elementary.c``; none where nothing can be compiled.

    Soundness: the name of a kept library is the SHA-256 of its source, the compiler, its options and the
    processor, so another source or another computer never meets it.
    """
    command = compiler()
    return (
        None
        if command is None
        else _loaded(resource("elementary.c") + source, command, str(store.directory()))
    )


def resource(name: str) -> str:
    """The text of a C file of this folder."""
    return files("lyapcheck.compiled").joinpath(name).read_text(encoding="utf-8")


@lru_cache(maxsize=64)
def _loaded(source: str, command: str, cache: str) -> ctypes.CDLL | None:
    """One library a source, compiler and cache; ``cache`` only tells caches apart."""
    key = hashlib.sha256(f"{machine(command)}\n{source}".encode()).hexdigest()
    try:
        with store.workplace() as place:
            _fetch(key, source, command, place / "kernel.so")
            return ctypes.CDLL(str(place / "kernel.so"))  # it stays in memory when its file is gone
    except OSError:
        return None


def _fetch(key: str, source: str, command: str, path: Path) -> None:
    """Put the library at ``path``, if it is kept or can be compiled."""
    body = store.kept(key)
    if body is not None:
        path.write_bytes(body)
    elif compile_library(source, path, command):
        store.keep(key, path.read_bytes())
