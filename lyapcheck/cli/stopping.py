"""Ctrl-C and SIGTERM end a command at once, whatever it is doing, with every process that it started.

An exception in the main thread would not do: IPOPT takes one for a wish to end its search only, a pool of
processes waits for its work, and C code that lets go of Python sees none before it returns. So the process
is ended where the signal is noticed: in the handler, which CasADi asks for between iterations, or in a thread
that waits for signals, whichever comes first.
"""

from __future__ import annotations

import _thread  # threading takes longer to load than the gate to decide
import os
import signal
import sys

TYPE_CHECKING = False
if TYPE_CHECKING:
    from collections.abc import Iterable
    from typing import Any

STOPS = (signal.SIGINT, signal.SIGTERM)
_SILENCE = "ignore::UserWarning:multiprocessing.resource_tracker"
"""The process that removes the locks of a pool must not complain that the command did not do it."""
_ending = _thread.RLock()


class Stopping:
    """While this lasts, SIGINT and SIGTERM end the process with 128 + their number, as a shell reports it.

    A signal that was ignored from the start, as in a job in the background, stays ignored. Processes that are
    started meanwhile do not see Ctrl-C: they are ended by this one.
    """

    def __enter__(self) -> None:
        self.handlers: dict[int, Any] = {
            number: signal.signal(number, _stop)
            for number in STOPS
            if signal.getsignal(number) is not signal.SIG_IGN
        }
        reader, self.writer = os.pipe()
        os.set_blocking(self.writer, False)
        self.wakeup = signal.set_wakeup_fd(self.writer, warn_on_full_buffer=False)
        _thread.start_new_thread(_listen, (reader,))
        # after the start of the thread, which alone is to take it: a mask is inherited, by processes too
        self.set_mask = signal.pthread_sigmask
        self.before = self.set_mask(signal.SIG_BLOCK, [signal.SIGINT])
        signal.pthread_sigmask = self._set_mask
        sys.warnoptions.append(_SILENCE)  # is handed on to processes when they start

    def __exit__(self, *raised: object) -> None:
        sys.warnoptions.remove(_SILENCE)
        signal.set_wakeup_fd(self.wakeup)
        os.close(self.writer)
        for number, handler in self.handlers.items():
            signal.signal(number, handler)
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
        _end_processes()
        temporary = sys.modules.get("lyapcheck.temporary")  # nothing is pending where nobody has loaded it
        if temporary is not None:
            temporary.clear()
        if "rich.progress" in sys.modules and os.isatty(2):
            os.write(2, b"\r\x1b[K\x1b[?25h")  # the bar is cleared, the cursor shown again
        os._exit(128 + number)


def _end_processes() -> None:
    """End all processes below; each is held before its own are looked for, so that none gets away."""
    held: set[int] = set()
    while fresh := _below(os.getpid()) - held:
        for process in fresh:
            _send(process, signal.SIGSTOP)
        held |= fresh
    for process in held:
        # not SIGKILL: the process that removes the locks of a pool lives on until that is done
        _send(process, signal.SIGTERM)
        _send(process, signal.SIGCONT)


def _below(ancestor: int) -> set[int]:
    """The processes that a process has started, and those that they have; none where there is no /proc."""
    try:
        processes = [name for name in os.listdir("/proc") if name.isdigit()]
    except OSError:
        return set()
    parents: dict[int, int] = {}
    for name in processes:
        try:
            with open(f"/proc/{name}/stat", "rb") as stream:
                parents[int(name)] = int(stream.read().rpartition(b")")[2].split()[1])
        except OSError:
            continue  # gone meanwhile
    result: set[int] = set()
    fresh = {ancestor}
    while fresh := {process for process, parent in parents.items() if parent in fresh} - result:
        result |= fresh
    return result


def _send(process: int, number: int) -> None:
    try:
        os.kill(process, number)
    except ProcessLookupError:
        return
