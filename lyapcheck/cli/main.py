"""The command line: a file a command, and only the one that is run gets imported."""

from __future__ import annotations

import atexit
import errno
import gc
import io
import os
import select
import stat
import sys

from lyapcheck.cli.commands import NAMES, load
from lyapcheck.cli.stopping import Stopping
from lyapcheck.errors import InputError, argument_error
from lyapcheck.libraries import missing
from lyapcheck.output.escapes import printable
from lyapcheck.verdicts import Exit

TYPE_CHECKING = False
if TYPE_CHECKING:
    from collections.abc import Sequence
    from typing import TextIO

CLOSED_PIPE = 141
"""128 + SIGPIPE, as a shell reports it: nobody read the result, so it counts as none."""
INTERRUPTED = 130
"""128 + SIGINT."""
FULL = (errno.ENOSPC, errno.EDQUOT, errno.EFBIG, errno.EIO, errno.EBADF)
"""What a standard output that takes no more says; files are written elsewhere, by who says their names."""


def run(words: Sequence[str]) -> int:
    """Do what the words of a command line ask for, and return the exit code.

    Raises:
        InputError: they, or a file that they name, cannot be used.
    """
    if not words or words[0] not in NAMES:
        from lyapcheck.cli.program import run_program

        return run_program(words)
    from lyapcheck.cli.parser import Parser

    command = load(words[0])
    parser = Parser(prog=f"lyapcheck {words[0]}", description=command.run.__doc__)
    command.arguments(parser)
    return int(command.run(**parser.parse(words[1:])))


def main() -> None:
    """Run one command and leave with its exit code; no input ever shows a traceback."""
    _same_bytes_everywhere()
    # matrices are small here: threads of BLAS wait for each other and double the time
    os.environ.setdefault("OPENBLAS_NUM_THREADS", "1")
    atexit.register(gc.freeze)  # a last look for garbage takes longer than the gate to decide
    try:
        _require_output()
        with Stopping():
            code = run(sys.argv[1:])
            sys.stdout.flush()
        sys.exit(code)
    except BrokenPipeError:
        _drop(sys.stdout)
        sys.exit(CLOSED_PIPE)
    except KeyboardInterrupt:
        sys.exit(INTERRUPTED)
    except InputError as error:
        for problem in error.problems:
            _tell(f"error: {problem}")
        sys.exit(Exit.USAGE)
    except Exception as error:
        if isinstance(error, ImportError) and (lack := missing(error)) is not None:
            _tell(f"error: {lack}")
            sys.exit(Exit.USAGE)
        if isinstance(error, OSError) and error.filename is None and error.errno in FULL:
            _drop(sys.stdout)
            rule = f"cannot be written ({error.strerror})"
            lost = argument_error("standard output", "", rule, "free some space, or send it elsewhere")
            _tell(f"error: {lost}")
            sys.exit(Exit.USAGE)
        if os.environ.get("LYAPCHECK_DEBUG"):
            raise
        _tell(
            f"internal error: {type(error).__name__}: {error}; "
            "this is a fault in lyapcheck, run again with LYAPCHECK_DEBUG=1 and report what it prints"
        )
        sys.exit(Exit.INTERNAL)


def _require_output() -> None:
    """Refuse to run, perhaps for minutes, where nobody could take the result.

    Without a standard output the first file that is opened would take its place.

    Raises:
        InputError: standard output is closed.
        BrokenPipeError: whoever reads it has gone.
        OSError: it is a full device, or a file on a full disk.
    """
    if sys.stderr is None:
        sys.stderr = open(os.devnull, "w")  # noqa: SIM115 (to the end of the process)
    if sys.stdout is None:
        raise argument_error("standard output", "", "is closed", "open it, or send it to /dev/null")
    try:
        number = sys.stdout.fileno()
    except (OSError, ValueError):  # something that is no file stands in for it
        return
    poll = select.poll()
    poll.register(number, 0)
    if any(event & select.POLLERR for _, event in poll.poll(0)):
        raise BrokenPipeError(errno.EPIPE, os.strerror(errno.EPIPE))
    os.write(number, b"")  # which a full device refuses, and a full disk does not
    disk = os.fstatvfs(number)
    if stat.S_ISREG(os.fstat(number).st_mode) and disk.f_blocks and not disk.f_bavail:
        raise OSError(errno.ENOSPC, os.strerror(errno.ENOSPC))


def _drop(stream: TextIO) -> None:
    """Send what is left for a stream that takes no more nowhere, in silence."""
    try:
        stream.flush()
    except OSError:
        os.dup2(os.open(os.devnull, os.O_WRONLY), stream.fileno())


def _tell(line: str) -> None:
    """One line on standard error, with nothing in it that would break it or steer a terminal."""
    try:
        print(printable(line), file=sys.stderr)
    except OSError:
        _drop(sys.stderr)


def _same_bytes_everywhere() -> None:
    """Write UTF-8 whatever the locale: γ must not depend on where a command runs."""
    for stream in (sys.stdout, sys.stderr):
        if isinstance(stream, io.TextIOWrapper):
            stream.reconfigure(encoding="utf-8", errors="backslashreplace")


if __name__ == "__main__":
    main()
