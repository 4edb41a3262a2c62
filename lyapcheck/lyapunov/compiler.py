"""The C compiler of this computer, if there is one."""

from __future__ import annotations

import ctypes
import os
import platform
import shutil
import subprocess
from collections import deque
from collections.abc import Callable
from concurrent.futures import ThreadPoolExecutor
from functools import cache
from pathlib import Path

from lyapcheck import store
from lyapcheck.process_tree import temporary_folder

OFF = "LYAPCHECK_NO_COMPILER"
"""Set to 1, this environment variable keeps lyapcheck from compiling anything."""
X86 = platform.machine() in ("x86_64", "AMD64")
FLAGS = (
    "-std=gnu11",
    "-O3",
    "-march=native",
    *(("-mprefer-vector-width=512",) if X86 else ()),
    "-fno-math-errno",
    "-fno-trapping-math",
    "-fopenmp-simd",
    "-shared",
    "-fPIC",
)
"""No option here lets the compiler reorder sums or forget infinities and NaN.

-Ofast would: and linked with it, a library sets the whole process to round subnormal numbers to 0.
"""
FUNCTIONS = ("sin", "cos", "expm1", "log", "log1p", "atan")
VECTORS = X86 and platform.libc_ver() >= ("glibc", "2.35")
"""Whether the C library has each of `FUNCTIONS` for vectors; expm1 and log1p are the youngest."""


def prelude() -> str:
    """The functions that loops call, one declared after the other.

    Where the C library has none for vectors, they are called one lane at a time. The name in quotes keeps the
    compiler from joining sin and cos of one angle.
    """
    simd = ' __attribute__((const, simd("notinbranch")))' if VECTORS else ""
    named = (
        [f'double v_{name}(double) __asm__("{name}"){simd};' for name in FUNCTIONS]
        if VECTORS
        else [f"#define v_{name} {name}" for name in FUNCTIONS]
    )
    return "\n".join(
        [
            "#include <math.h>",
            *named,
            "/* of NaN in a, both are NaN */",
            "static inline double smaller(double a, double b) { return a > b ? b : a; }",
            "static inline double larger(double a, double b) { return a < b ? b : a; }",
        ]
    )


PATIENCE = 120
"""Seconds after which a compiler counts as broken."""


def compiler() -> str | None:
    """The path of ``$CC``, gcc, clang or cc, whichever comes first; none if there is none or it is off."""
    if os.environ.get(OFF, "") not in ("", "0"):
        return None
    candidates = (os.environ.get("CC", ""), "gcc", "clang", "cc")
    return next((result for name in candidates if name and (result := shutil.which(name))), None)


def compile_library(source: str, path: Path, command: str) -> bool:
    """Compile C source into a shared library at ``path``; whether that went well."""
    libraries = ["-lmvec", "-lm"] if VECTORS else ["-lm"]
    arguments = [command, *FLAGS, "-x", "c", "-", "-o", str(path), *libraries]
    try:
        done = subprocess.run(
            arguments, input=source.encode(), capture_output=True, timeout=PATIENCE, check=False
        )
    except (OSError, subprocess.TimeoutExpired):
        return False
    return done.returncode == 0 and path.is_file()


@cache
def machine(command: str) -> str:
    """What a compiled library depends on besides its source: compiler, options, processor."""
    try:
        done = subprocess.run(
            [command, "--version"], capture_output=True, text=True, timeout=PATIENCE, check=False
        )
        version = done.stdout.partition("\n")[0]
    except (OSError, subprocess.TimeoutExpired):
        version = ""
    return "\n".join([command, version, *FLAGS, platform.machine(), _processor()])


def _processor() -> str:
    """The features that ``-march=native`` may use."""
    try:
        lines = Path("/proc/cpuinfo").read_text(encoding="utf-8", errors="replace").splitlines()
    except OSError:
        return platform.processor()
    wanted = ("model name", "flags", "Features", "CPU part")
    return "\n".join(sorted({line for line in lines if line.startswith(wanted)}))


# --- From C source to functions that can be called: from the cache, freshly compiled, or not at all.
#
# A damaged library would crash the loader of the system, so that only whole ones are handed out; what is
# loaded is a private copy of the bytes that were checked.


ROOM = "kernels"


def library(key: str, command: str, source: Callable[[], str | None]) -> ctypes.CDLL | None:
    """The library kept under a key, or what the compiler makes of its source; none where that fails.

    Args:
        key: the digest of all that the library depends on, compiler and processor included.
        command: the compiler.
        source: writes the C text; asked only where nothing is kept.
    """
    try:
        with temporary_folder() as name:
            path = Path(name, "kernel.so")
            body = store.kept(ROOM, f"{key}.so")
            if body is not None:
                path.write_bytes(body)
            elif (text := source()) is not None and compile_library(text, path, command):
                store.keep(ROOM, f"{key}.so", path.read_bytes())
            return ctypes.CDLL(str(path))  # it stays in memory when its file is gone
    except OSError:
        return None


# --- Work split over the processors; compiled code runs without the interpreter's lock.


_A_FEW = 4
"""Shares for each processor: a processor that others use as well then holds nobody up for long."""


def processors() -> int:
    """How many this process may use."""
    return len(os.sched_getaffinity(0)) if hasattr(os, "sched_getaffinity") else os.cpu_count() or 1


def over_shares(work: Callable[[int, int], object], count: int, unit: int = 1) -> None:
    """Do ``work(start, stop)`` for consecutive shares of ``range(count)``, a few to a processor.

    Args:
        work: does its share.
        count: how much there is.
        unit: shares are whole multiples of it, except the last.
    """
    workers = processors()
    size = unit * max(1, -(-count // (_A_FEW * workers * unit))) if workers > 1 else max(count, 1)
    starts = range(0, count, size)
    with ThreadPoolExecutor(min(workers, max(1, len(starts)))) as pool:
        deque(pool.map(work, starts, (min(start + size, count) for start in starts)), maxlen=0)
