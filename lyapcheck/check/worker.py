"""The process that judges: requests on its standard input, a line of JSON for each on its standard output.

A request is a line of JSON, {"full", "size"}, then a certificate of so many bytes.
Whatever a certificate does to this process, the one that asks goes on: see ``guard``.
"""

from __future__ import annotations

import json
import os
import signal
import sys
from contextlib import suppress
from dataclasses import asdict
from importlib import import_module
from importlib.util import find_spec
from math import ceil
from pathlib import Path
from typing import IO, Any

from lyapcheck.check.judgement import Limits

resource: Any = import_module("resource") if find_spec("resource") else None
"""The limits of a POSIX system; elsewhere there are none."""
DOUBTS = "lyapcheck.rechecking.drawn_entries"
"""What doubts the checker, beside it: see ``verify.DOUBTS``."""
RECURSION = 6_000
"""Levels of calls: an expression may be 300 deep, and a level of it takes several calls."""
SHARE = 8
"""A process that has come to this share of its memory is replaced, so that each certificate has its own."""


def serve(limits: Limits) -> None:
    """Answer until there are no more requests."""
    signal.signal(signal.SIGINT, signal.SIG_IGN)  # Ctrl-C is for the parent, which ends this process
    answers, requests = os.fdopen(os.dup(1), "wb"), sys.stdin.buffer
    os.dup2(2, 1)  # nothing that a library prints is an answer
    sys.setrecursionlimit(RECURSION)
    limited = _limit(limits)
    # now: they must find room within the limits
    certificate, verify = (import_module(f"lyapcheck.check.{name}") for name in ("certificate", "verify"))
    if find_spec(DOUBTS):
        import_module(DOUBTS).install()
    _send(answers, {"limited": limited})
    with verify.each_once():
        while line := requests.readline():
            request = json.loads(line)
            if resource is not None:  # on what this certificate may take, above what was used before
                used = resource.getrusage(resource.RUSAGE_SELF)
                _lower(resource.RLIMIT_CPU, ceil(used.ru_utime + used.ru_stime) + limits.seconds)
            finding = asdict(certificate.judged(requests.read(request["size"]), request["full"]))
            last = _most_memory() * SHARE > limits.memory * 2**20
            _send(answers, {"finding": finding, "last": last})
            if last:
                return


def _send(answers: IO[bytes], answer: dict[str, Any]) -> None:
    answers.write(json.dumps(answer).encode("ascii") + b"\n")
    answers.flush()


def _limit(limits: Limits) -> list[str]:
    """Set what holds for the whole process, and say which limits the system keeps."""
    if resource is None:
        return []
    with suppress(ValueError, OSError):
        _lower(resource.RLIMIT_CORE, 0)
    try:
        _lower(resource.RLIMIT_AS, limits.memory * 2**20)
    except (ValueError, OSError):
        return ["seconds"]
    return ["seconds", "memory"]


def _lower(limit: int, wanted: int) -> None:
    hard = resource.getrlimit(limit)[1]
    resource.setrlimit(limit, (wanted if hard == resource.RLIM_INFINITY else min(wanted, hard), hard))


def _most_memory() -> int:
    """The most bytes that this process has had in memory; 0 where the system does not say."""
    with suppress(OSError, ValueError):
        # Not ru_maxrss: there Linux counts what the parent had when it started this process.
        for line in Path("/proc/self/status").read_text("ascii", "replace").splitlines():
            if line.startswith("VmHWM:"):
                return int(line.split()[1]) * 1024
    if resource is None:
        return 0
    most: int = resource.getrusage(resource.RUSAGE_SELF).ru_maxrss
    return most * (1 if sys.platform == "darwin" else 1024)
