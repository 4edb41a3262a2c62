"""A process of its own for judging, with limits on its time and memory; the parent outlives it."""

from __future__ import annotations

import json
import os
import signal
import subprocess
import sys
import threading
from collections.abc import Iterator
from contextlib import ExitStack, contextmanager, suppress
from dataclasses import asdict, replace
from importlib import import_module
from importlib.util import find_spec
from math import ceil
from pathlib import Path
from typing import IO, Any

from lyapcheck.check.judgement import Judgement, Limits

ROOT = str(Path(__file__).parents[2])
CODE = """
import json, sys
path, seconds, memory = json.loads(sys.argv[1])
sys.path[:] = path
from lyapcheck.check.guard import serve
from lyapcheck.check.judgement import Limits
serve(Limits(seconds, memory))
"""
START = 600
"""Seconds in which a process must have started, however few a certificate may take."""
PATIENCE = 20
"""Where the system counts computing time: so many times as long by the clock, for what waits for ever."""


class CannotStart(Exception):
    """The process that judges does not start."""


class Guard:
    """Judges certificates in a process that is replaced when one of them ends it.

    Use it in a ``with`` statement: at the end, or at Ctrl-C or SIGTERM, no process is left behind.
    """

    def __init__(self, limits: Limits) -> None:
        self.limits = limits
        self.limited: tuple[str, ...] = ("seconds", "memory")
        self._process: subprocess.Popen[bytes] | None = None
        self._exit = ExitStack()

    def __enter__(self) -> Guard:
        self._exit.callback(self._stop)
        self._exit.enter_context(_terminable())
        return self

    def __exit__(self, *_: object) -> None:
        self._exit.close()

    def judge(self, content: bytes, full: bool) -> Judgement:
        answer = self._ask(content, full)
        if "ended" in answer:
            return replace(Judgement().refused(answer["ended"]), spent=True)
        result = answer["finding"]
        pairs = {name: tuple(map(tuple, result[name])) for name in ("shows", "rules", "theorems")}
        return Judgement(**{**result, **pairs, "granted": tuple(result["granted"])})

    def _ask(self, content: bytes, full: bool) -> dict[str, Any]:
        process = self._process or self._start()
        header = json.dumps({"full": full, "size": len(content)}).encode("ascii")
        patience = START + PATIENCE * self.limits.seconds
        seconds = patience if "seconds" in self.limited else self.limits.seconds
        answer, late = _exchange(process, [header + b"\n", content], seconds)
        if answer is None:
            self._stop()
            return {"ended": self._ended(process.returncode, late)}
        if late or answer.pop("last"):
            self._stop()
        return answer

    def _start(self) -> subprocess.Popen[bytes]:
        path = [ROOT, *(entry for entry in sys.path if entry not in ("", "."))]
        controlled = json.dumps([path, self.limits.seconds, self.limits.memory])
        command = [sys.executable, "-I", "-c", CODE, controlled]
        self._process = process = subprocess.Popen(
            command, stdin=subprocess.PIPE, stdout=subprocess.PIPE, stderr=subprocess.DEVNULL
        )
        hello, _ = _exchange(process, [], START)
        if hello is None:
            self._stop()
            raise CannotStart(f"the process that judges does not start within {self.limits.memory} MiB")
        self.limited = tuple(hello["limited"])
        return process

    def _stop(self) -> None:
        process, self._process = self._process, None
        if process is not None:
            process.kill()
            process.wait()
            for stream in (process.stdin, process.stdout):
                with suppress(OSError):
                    stream.close()  # type: ignore[union-attr]

    def _ended(self, code: int, late: bool) -> str:
        seconds, memory = self.limits.seconds, self.limits.memory
        if late or (code < 0 and -code == getattr(signal, "SIGXCPU", 0)):
            return f"takes more than {seconds} s of computing time; --seconds allows more"
        how = signal.Signals(-code).name if code < 0 else f"exit code {code}"
        return f"ends the process that judges it ({how}): {memory} MiB may be too few; --memory allows more"


def _exchange(
    process: subprocess.Popen[bytes], parts: list[bytes], seconds: int
) -> tuple[dict[str, Any] | None, bool]:
    """The answer to a request (``None``: the process ended without one), and whether its time was up."""
    late = threading.Event()

    def end() -> None:
        late.set()
        process.kill()

    assert process.stdin is not None
    assert process.stdout is not None
    timer = threading.Timer(seconds, end)
    timer.daemon = True
    timer.start()
    try:
        process.stdin.writelines(parts)
        process.stdin.flush()
        line = process.stdout.readline()
    except OSError:
        line = b""
    finally:
        timer.cancel()
        timer.join()
    if line.endswith(b"\n"):
        return json.loads(line), late.is_set()
    process.wait()
    return None, late.is_set()


@contextmanager
def _terminable() -> Iterator[None]:
    """SIGTERM and SIGHUP end the program as Ctrl-C does, through what is to be cleaned up."""
    result = []
    if threading.current_thread() is threading.main_thread():
        for name in ("SIGTERM", "SIGHUP"):
            number = getattr(signal, name, None)
            if number is not None and signal.getsignal(number) is signal.SIG_DFL:
                signal.signal(number, _leave)
                result.append(number)
    try:
        yield
    finally:
        for number in result:
            signal.signal(number, signal.SIG_DFL)


def _leave(number: int, _: object) -> None:
    raise SystemExit(128 + number)


# --- The process that judges: requests on its standard input, a line of JSON for each on its standard output.
#
# A request is a line of JSON, {"full", "size"}, then a certificate of so many bytes.


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
