"""The command line: one file a command, and only the one that is run gets imported."""

from __future__ import annotations

import gc
import io
import os
import sys

from lyapcheck.errors import InputError
from lyapcheck.verdicts import Exit

TYPE_CHECKING = False
if TYPE_CHECKING:
    import typer

COMMANDS = (
    "bounds",
    "check",
    "epsilon",
    "explain",
    "gate",
    "recheck",
    "report",
    "robot",
    "simulate",
    "table",
    "tune",
)

CLOSED_PIPE = 141
"""128 + SIGPIPE, as a shell reports it: nobody read the result, so it counts as none."""
INTERRUPTED = 130
"""128 + SIGINT."""


def build_app(names: tuple[str, ...] = COMMANDS) -> typer.Typer:
    """The Typer application with the named commands."""
    from lyapcheck.cli.app import build

    return build(names)


def main() -> None:
    """Run one command and leave with its exit code; no input ever shows a traceback."""
    _same_bytes_everywhere()
    wanted = sys.argv[1] if len(sys.argv) > 1 else ""
    try:
        if wanted == "gate":
            _quick_gate(sys.argv[2:])
        build_app((wanted,) if wanted in COMMANDS else COMMANDS)()
    except SystemExit as leave:
        # what Typer makes of a reader that went away is 1, which here would mean refuted
        sys.exit(CLOSED_PIPE if isinstance(leave.__context__, BrokenPipeError) else leave.code)
    except BrokenPipeError:
        os.dup2(
            os.open(os.devnull, os.O_WRONLY), sys.stdout.fileno()
        )  # what is left goes nowhere, in silence
        sys.exit(CLOSED_PIPE)
    except KeyboardInterrupt:
        sys.exit(INTERRUPTED)
    except InputError as error:
        for problem in error.problems:
            print(f"error: {_one_line(str(problem))}", file=sys.stderr)
        sys.exit(Exit.USAGE)
    except Exception as error:
        if os.environ.get("LYAPCHECK_DEBUG"):
            raise
        print(
            f"internal error: {type(error).__name__}: {_one_line(str(error))}; "
            "this is a fault in lyapcheck, run again with LYAPCHECK_DEBUG=1 and report what it prints",
            file=sys.stderr,
        )
        sys.exit(Exit.INTERNAL)


def _quick_gate(words: list[str]) -> None:
    """Run the gate and leave, without Typer, if the words are plain: in a hook the start is what counts."""
    gc.disable()  # neither modules nor results hold cycles worth looking for in so short a run
    try:
        from lyapcheck.cli.gate_options import quick_call

        call = quick_call(words)
        if call is None:
            return
        from lyapcheck.cli.gate_run import run

        code = run(call)
        sys.stdout.flush()
        gc.freeze()  # nor is there anything to be found by the collection that Python ends with
    finally:
        gc.enable()
    sys.exit(int(code))


def _same_bytes_everywhere() -> None:
    """Write UTF-8 whatever the locale: γ must not depend on where a command runs."""
    for stream in (sys.stdout, sys.stderr):
        if isinstance(stream, io.TextIOWrapper):
            stream.reconfigure(encoding="utf-8", errors="backslashreplace")


def _one_line(text: str) -> str:
    """The text with everything that would break the line, or steer a terminal, written as an escape."""
    return "".join(c if c.isprintable() else c.encode("unicode_escape").decode("ascii") for c in text)
