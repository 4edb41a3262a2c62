"""The processes of a command: ended with all that they have started, on POSIX systems and on Windows.

Ctrl-C and SIGTERM end a command at once, whatever it is doing. An exception in the main thread would not do:
IPOPT takes one for a wish to end its search only, a pool of processes waits for its work, and C code that
lets go of Python sees none before it returns. So the process is ended where the signal is noticed first: in
the handler, which CasADi asks for between iterations, or in a thread that waits for signals.
"""

from __future__ import annotations

import _thread  # threading takes longer to load than the gate to decide
import os
import signal
import sys
from collections.abc import Iterator
from contextlib import contextmanager, suppress
from pathlib import Path

TYPE_CHECKING = False

if TYPE_CHECKING:
    import subprocess
    from collections.abc import Iterable, Mapping, Sequence
    from typing import IO, Any


GROUPS = hasattr(os, "killpg")
"""Whether processes have groups. Windows has none: there what a process has started is looked up."""
LISTED = os.path.isdir("/proc/self")
"""Whether the system lists its processes as files, as Linux does; elsewhere psutil asks it."""
_LOOK = 0.02
"""Seconds after which a process is looked at again, where the system cannot be asked to wait."""


def end_below() -> None:
    """End all processes that this one has started, and theirs; each is held first, so that none gets away."""
    if LISTED:
        stopped: set[int] = set()
        while found := _below(os.getpid()) - stopped:
            for process in found:
                _send(process, signal.SIGSTOP)
            stopped |= found
        for process in stopped:
            # Not SIGKILL: the process that removes the locks of a pool lives on until that is done.
            _send(process, signal.SIGTERM)
            _send(process, signal.SIGCONT)
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
        os.killpg(process.pid, signal.SIGKILL)
        return
    import psutil

    process.kill()
    for one in psutil.process_iter(["ppid"]):  # Windows keeps the number of a parent that has gone
        if one.info["ppid"] == process.pid:
            with suppress(psutil.Error):
                for below in [*one.children(recursive=True), one]:
                    below.kill()


# --- A command that is told to stop.


STOPS = (signal.SIGINT, signal.SIGTERM)
MASKS = hasattr(signal, "pthread_sigmask")
"""Whether a thread can wait for signals. On Windows the handler alone ends the command, between two steps."""
_SILENCE = "ignore::UserWarning:multiprocessing.resource_tracker"
"""The process that removes the locks of a pool must not complain that the command did not do it."""
_ending = _thread.RLock()


class Stopping:
    """While this lasts, SIGINT and SIGTERM end the process with 128 + their number, as a shell reports it.

    A signal that was ignored from the start, as in a job in the background, stays ignored. Processes that are
    started meanwhile do not see Ctrl-C: they are ended by this one.
    """

    def __enter__(self) -> None:
        if not LISTED:  # in the handler of a signal an import could wait for ever
            with suppress(ImportError):  # the light installation: its one process leaves when its input ends
                import psutil  # noqa: F401
        self.handlers: dict[int, Any] = {
            number: signal.signal(number, _stop)
            for number in STOPS
            if signal.getsignal(number) is not signal.SIG_IGN
        }
        sys.warnoptions.append(_SILENCE)  # is handed on to processes when they start
        if not MASKS:
            return
        reader, self.writer = os.pipe()
        os.set_blocking(self.writer, False)
        self.wakeup = signal.set_wakeup_fd(self.writer, warn_on_full_buffer=False)
        _thread.start_new_thread(_listen, (reader,))
        # after the start of the thread, which alone is to take it: a mask is inherited, by processes too
        self.set_mask = signal.pthread_sigmask
        self.before = self.set_mask(signal.SIG_BLOCK, [signal.SIGINT])
        signal.pthread_sigmask = self._set_mask

    def __exit__(self, *raised: object) -> None:
        sys.warnoptions.remove(_SILENCE)
        for number, handler in self.handlers.items():
            signal.signal(number, handler)
        if not MASKS:
            return
        signal.set_wakeup_fd(self.wakeup)
        os.close(self.writer)
        signal.pthread_sigmask = self.set_mask
        signal.pthread_sigmask(signal.SIG_SETMASK, self.before)

    def _set_mask(self, how: int, mask: Iterable[int]) -> set[int | signal.Signals]:
        """What `signal.pthread_sigmask` does, but SIGINT stays blocked.

        Before its first process multiprocessing unblocks it, whether it was blocked before or not.
        """
        kept = set(mask) - {signal.SIGINT} if how == signal.SIG_UNBLOCK else mask
        return self.set_mask(how, kept)


def _listen(reader: int) -> None:
    """Wait for signals to the end of `Stopping`."""
    while numbers := os.read(reader, 1):
        if numbers[0] in STOPS:
            _stop(numbers[0])
    os.close(reader)


def _stop(number: int, frame: object = None) -> None:
    """End this process and all below it; nothing that was half written stays."""
    with _ending:
        end_below()
        clear()
        if "rich.progress" in sys.modules and os.isatty(2):
            os.write(2, b"\r\x1b[K\x1b[?25h")  # the bar is cleared, the cursor shown again
        os._exit(128 + number)


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
