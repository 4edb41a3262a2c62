"""A process that is ended with all that it has started, on POSIX systems and on Windows."""

from __future__ import annotations

import os
import sys
from collections.abc import Iterator
from contextlib import contextmanager, suppress
from pathlib import Path

TYPE_CHECKING = False

if TYPE_CHECKING:
    import subprocess
    from collections.abc import Mapping, Sequence
    from typing import IO


GROUPS = hasattr(os, "killpg")
"""Whether processes have groups. Windows has none: there what a process has started is looked up."""
LISTED = os.path.isdir("/proc/self")
"""Whether the system lists its processes as files, as Linux does; elsewhere psutil asks it."""
_LOOK = 0.02
"""Seconds after which a process is looked at again, where the system cannot be asked to wait."""


def prepare() -> None:
    """Import what `end_below` needs: in the handler of a signal an import could wait for ever."""
    if not LISTED:
        with suppress(ImportError):  # the light installation: its one process leaves when its input ends
            import psutil  # noqa: F401


def end_below() -> None:
    """End all processes that this one has started, and theirs; each is held first, so that none gets away."""
    if LISTED:
        _end_listed()
    elif "psutil" in sys.modules:
        import psutil

        own, held = psutil.Process(), {}
        while fresh := {one.pid: one for one in own.children(recursive=True) if one.pid not in held}:
            for one in fresh.values():
                with suppress(psutil.Error):
                    one.suspend()
            held.update(fresh)
        for one in held.values():
            with suppress(psutil.Error):
                one.terminate()
                one.resume()


def _end_listed() -> None:
    import signal

    held: set[int] = set()
    while fresh := _below(os.getpid()) - held:
        for process in fresh:
            _send(process, signal.SIGSTOP)
        held |= fresh
    for process in held:
        # Not SIGKILL: the process that removes the locks of a pool lives on until that is done.
        _send(process, signal.SIGTERM)
        _send(process, signal.SIGCONT)


def _below(ancestor: int) -> set[int]:
    """The processes that a process has started, and those that they have."""
    parents: dict[int, int] = {}
    for name in filter(str.isdigit, os.listdir("/proc")):
        # gone meanwhile
        with suppress(OSError), open(f"/proc/{name}/stat", "rb") as stream:
            parents[int(name)] = int(stream.read().rpartition(b")")[2].split()[1])
    result: set[int] = set()
    fresh = {ancestor}
    while fresh := {process for process, parent in parents.items() if parent in fresh} - result:
        result |= fresh
    return result


def _send(process: int, number: int) -> None:
    with suppress(ProcessLookupError):
        os.kill(process, number)


def end_own_group() -> None:
    """End this process and what it has started, where its parent has gone."""
    if GROUPS:
        import signal

        os.killpg(os.getpid(), signal.SIGKILL)
    end_below()
    os._exit(1)


def run_apart(
    command: Sequence[str], request: bytes, stdout: int | IO[str], environment: Mapping[str, str]
) -> int:
    """Run a program in a session of its own and end what it leaves running; returns its exit code.

    As long as its standard input is open the program knows that this process lives.

    Args:
        command: its words.
        request: what it reads first.
        stdout: where its standard output goes.
        environment: its variables.
    """
    import subprocess  # the gate stops too, and starts none

    process = subprocess.Popen(
        command, stdin=subprocess.PIPE, stdout=stdout, env=environment, start_new_session=GROUPS
    )
    assert process.stdin is not None
    try:
        with suppress(OSError):  # it has ended: its exit code tells
            process.stdin.write(request)
            process.stdin.flush()
        _wait(process)
    finally:
        _end_with_all(process)
        with suppress(OSError):
            process.stdin.close()
        process.wait()
    return process.returncode


def _wait(process: subprocess.Popen[bytes]) -> None:
    """Wait for its end; on POSIX without taking note of it, so that its group's number stays its own."""
    if hasattr(os, "waitid"):
        os.waitid(os.P_PID, process.pid, os.WEXITED | os.WNOWAIT)
    elif GROUPS:  # macOS before Python 3.13
        import time

        import psutil

        with suppress(psutil.Error):
            watched = psutil.Process(process.pid)
            while watched.status() != psutil.STATUS_ZOMBIE:
                time.sleep(_LOOK)
    else:
        process.wait()


def _end_with_all(process: subprocess.Popen[bytes]) -> None:
    if GROUPS:
        import signal

        os.killpg(process.pid, signal.SIGKILL)
        return
    import psutil

    process.kill()
    for one in psutil.process_iter(["ppid"]):  # Windows keeps the number of a parent that has gone
        if one.info["ppid"] == process.pid:
            with suppress(psutil.Error):
                for below in [*one.children(recursive=True), one]:
                    below.kill()


# --- Files and folders that must not outlive the command that makes them, however it ends.

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
