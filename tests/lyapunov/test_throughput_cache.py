"""Kept libraries: private, whole, found again, and never needed."""

import os
import stat
import subprocess
import sys
from pathlib import Path

import pytest

from lyapcheck import store
from lyapcheck.lyapunov import compiler as compiler_module
from lyapcheck.lyapunov.compiler import compile_library, compiler
from lyapcheck.lyapunov.loop import compiled

COMPILES = compiler() is not None
SOURCE = "int seven(void) { return 7; }\n"


def library(source=SOURCE):
    return compiled((source,), lambda: source)


@pytest.fixture
def cache(tmp_path, monkeypatch):
    """An empty cache, and nothing remembered from the user's own."""
    monkeypatch.setenv("XDG_CACHE_HOME", str(tmp_path / "cache"))
    return tmp_path / "cache" / "lyapcheck" / "kernels"


@pytest.fixture
def compilations(monkeypatch):
    """The sources compiled so far."""
    seen = []

    def counted(source, path, command):
        seen.append(source)
        return compile_library(source, path, command)

    monkeypatch.setattr(compiler_module, "compile_library", counted)
    return seen


def works():
    result = library(SOURCE)
    return (result is not None and result.seven() == 7) if COMPILES else result is None


LIBRARY = b"not code at all"


def test_compiled_once_and_found_again(cache, compilations):
    assert works()
    assert works()
    assert len(compilations) == COMPILES
    assert len(list(cache.glob("*"))) == COMPILES


def test_what_is_kept_is_private(cache):
    path = store.keep("kernels", "key.so", LIBRARY)
    assert path == cache / "key.so"
    assert stat.S_IMODE(cache.stat().st_mode) == 0o700
    assert stat.S_IMODE(path.stat().st_mode) == 0o600
    assert store.kept("kernels", "key.so") == LIBRARY
    assert store.kept("kernels", "another.so") is None


@pytest.mark.parametrize("damage", [b"", b"x", LIBRARY, None])
def test_a_damaged_library_is_not_loaded(cache, damage):
    path = store.keep("kernels", "key.so", LIBRARY)
    content = path.read_bytes()
    path.write_bytes(bytes([content[0] ^ 1]) + content[1:] if damage is None else damage)
    assert store.kept("kernels", "key.so") is None


def test_a_damaged_library_is_compiled_anew(cache, compilations):
    assert works()
    for path in cache.glob("*.so"):
        path.write_bytes(path.read_bytes()[:3000])
    assert works()
    assert works()
    assert len(compilations) == 2 * COMPILES


@pytest.mark.parametrize("mode", [0o770, 0o707])
def test_a_directory_that_others_can_write_is_not_trusted(cache, mode, compilations):
    store.keep("kernels", "key.so", LIBRARY)
    cache.chmod(mode)
    assert store.kept("kernels", "key.so") is None
    assert store.keep("kernels", "key.so", LIBRARY) is None
    assert works()
    assert [path.name for path in cache.glob("*")] == ["key.so"]


def test_a_file_that_others_can_write_is_not_trusted(cache):
    store.keep("kernels", "key.so", LIBRARY).chmod(0o622)
    assert store.kept("kernels", "key.so") is None


def test_a_link_is_not_followed(cache):
    path = store.keep("kernels", "key.so", LIBRARY)
    (cache / "other.so").symlink_to(path)
    assert store.kept("kernels", "other.so") is None
    assert store.kept("kernels", "key.so") == LIBRARY


def test_a_cache_that_cannot_be_made_is_done_without(cache, compilations):
    cache.parent.parent.write_text("a file where the directory would be")
    assert works()
    assert len(compilations) == COMPILES


@pytest.mark.parametrize("home", ["", "relative/path"])
def test_an_unusable_cache_variable_is_ignored(home, monkeypatch):
    monkeypatch.setenv("XDG_CACHE_HOME", home)
    assert store.home() == Path.home() / ".cache" / "lyapcheck"


def test_a_broken_compiler_is_no_compiler(cache, tmp_path, monkeypatch):
    broken = tmp_path / "cc"
    broken.write_text("#!/bin/sh\nexit 1\n")
    broken.chmod(0o700)
    monkeypatch.setenv("CC", str(broken))
    compiler_module.machine.cache_clear()
    assert compiler() == str(broken)
    assert library(SOURCE) is None
    compiler_module.machine.cache_clear()


@pytest.mark.slow
def test_many_processes_at_once_leave_one_whole_library(cache):
    code = (
        "from lyapcheck.lyapunov.loop import compiled\n"
        f"print(compiled(('one',), lambda: {SOURCE!r}) is not None)"
    )
    command, environment = [sys.executable, "-c", code], dict(os.environ)
    running = [
        subprocess.Popen(command, env=environment, stdout=subprocess.PIPE, text=True) for _ in range(3)
    ]
    assert {process.communicate()[0].strip() for process in running} == {str(COMPILES)}
    kept = list(cache.glob("*"))
    assert len(kept) == COMPILES
    assert all(store.kept("kernels", path.name) for path in kept)
