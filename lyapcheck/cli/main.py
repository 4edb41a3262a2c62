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
from itertools import pairwise
from typing import TYPE_CHECKING

from lyapcheck.cli.commands import NAMES, load
from lyapcheck.cli.parser import Parser
from lyapcheck.cli.values import chosen
from lyapcheck.errors import InputError, argument_error, missing, nearest
from lyapcheck.output.escapes import printable
from lyapcheck.output.names import SPELLED, has_all_signs
from lyapcheck.process_tree import Stopping
from lyapcheck.verdicts import Exit

if TYPE_CHECKING:
    from collections.abc import Sequence
    from typing import TextIO

ABOUT = """Check the Lyapunov proof of bounded hyperbolic controllers for robot manipulators.

    Exit codes: 0 all proved or accepted, 1 something refuted or rejected, 2 unusable input, 3 undecided,
    4 internal error.

    Examples:
      lyapcheck gate gains.toml              accept or reject gains
      lyapcheck check published.py           the paper's proof, claim by claim
      lyapcheck robot buap3                  the properties of an arm
      lyapcheck gate --help                  what a command takes
    """
FOR_PROGRAMS = ("json", "csv", "junit", "sarif", "github")
"""Formats that are never empty, whatever is wrong with the input."""
SHELLS = ("bash", "zsh", "fish")
CLOSED_PIPE = 141
"""128 + SIGPIPE, as a shell reports it: nobody read the result, so it counts as none."""
INTERRUPTED = 130
"""128 + SIGINT."""
FULL = (errno.ENOSPC, errno.EDQUOT, errno.EFBIG, errno.EIO, errno.EBADF)
"""What a standard output that takes no more says; files are written elsewhere, by who says their names."""


def run_program(words: Sequence[str]) -> Exit:
    """Do what a command line without a command asks for.

    Raises:
        InputError: nothing, or nothing that lyapcheck knows.
    """
    parser = Parser(prog="lyapcheck", description=ABOUT)
    parser.usage = "%(prog)s COMMAND ..."
    parser.add_argument("--version", action="store_true", help="Print the version and leave.")
    about = "Print a script that completes command lines in a shell."
    parser.add_choice("--completion", SHELLS, about, metavar="SHELL")
    if not words:
        _add_commands(parser)
        sys.stderr.write(parser.format_help())
        return Exit.USAGE
    if not words[0].startswith("-"):
        repair = nearest(words[0], NAMES) or f"choose from {', '.join(NAMES)}"
        raise argument_error("COMMAND", words[0], "is not a command of lyapcheck", repair)
    if "-h" in words or "--help" in words:
        _add_commands(parser)
        parser.print_help()
        return Exit.PROVED
    wanted = parser.parse(words)
    if wanted["version"]:
        from importlib.metadata import version

        print(f"lyapcheck {version('lyapcheck')}")
    elif wanted["completion"]:
        sys.stdout.write(_completion(parser, wanted["completion"]))
    return Exit.PROVED


def _add_commands(parser: Parser) -> list[Parser]:
    """Give a parser those of all commands."""
    commands = parser.add_subparsers(title="commands", metavar="COMMAND")
    parsers = []
    for name in NAMES:
        module = load(name)
        summary = module.run.__doc__.partition("\n")[0]
        parsers.append(commands.add_parser(name, help=summary, description=module.run.__doc__))
        module.arguments(parsers[-1])
    return parsers


def _completion(parser: Parser, shell: str) -> str:
    """What the shell reads, by shtab."""
    import shtab

    places = {
        "FILE": shtab.FILE,
        "FILE...": shtab.FILE,
        "PROOF.py": shtab.FILE,
        "PLAN.toml": shtab.FILE,
        "DIR": shtab.DIRECTORY,
    }
    for each in _add_commands(parser):
        for action in each.actions:
            if action.metavar in places:
                action.complete = places[action.metavar]  # type: ignore[attr-defined]
    text: str = shtab.complete(parser, shell)
    return text


def run(words: Sequence[str]) -> int:
    """Do what the words of a command line ask for, and return the exit code.

    Raises:
        InputError: they, or a file that they name, cannot be used.
    """
    if not words or words[0] not in NAMES:
        return run_program(words)
    from lyapcheck.cli.show import viewed

    command = load(words[0])
    parser = Parser(prog=f"lyapcheck {words[0]}", description=command.run.__doc__)
    command.arguments(parser)
    try:
        values = chosen(viewed(parser, parser.parse(words[1:])))
        if values.pop("no_store", False):
            from lyapcheck.store import OFF

            os.environ[OFF] = "1"
        return int(command.run(**values))
    except InputError as error:
        # programs read no standard error: they get a document of the format that was asked for
        named = [word.removeprefix("--format=") for word in words if word.startswith("--format=")]
        named += [after for word, after in pairwise(words) if word == "--format"]
        if not error.told and named and named[-1] in FOR_PROGRAMS:
            from lyapcheck.cli.show import show
            from lyapcheck.output.answer import Unusable

            show(Unusable(words[0], error.problems), named[-1])
        raise


def main() -> None:
    """Run one command and leave with its exit code; no input ever shows a traceback."""
    for stream in (sys.stdout, sys.stderr):
        if not isinstance(stream, io.TextIOWrapper):
            continue
        if has_all_signs(stream.encoding):
            stream.reconfigure(encoding="utf-8", errors="backslashreplace")
        else:
            stream.reconfigure(errors=SPELLED)
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
    if hasattr(select, "poll"):
        poll = select.poll()
        poll.register(number, 0)
        if any(event & select.POLLERR for _, event in poll.poll(0)):  # its reader has gone
            raise BrokenPipeError(errno.EPIPE, os.strerror(errno.EPIPE))
    os.write(number, b"")  # which a full device refuses, and a full disk does not
    if not hasattr(os, "fstatvfs"):
        return
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
