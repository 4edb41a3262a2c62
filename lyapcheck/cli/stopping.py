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

from lyapcheck.process_tree import clear, end_below, prepare

TYPE_CHECKING = False
if TYPE_CHECKING:
    from collections.abc import Iterable
    from typing import Any

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
        prepare()
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
