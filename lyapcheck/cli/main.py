"""The command line: one file a command, and only the one that is run gets imported."""

from __future__ import annotations

import io
import os
import sys
from importlib import import_module
from typing import Annotated

import typer

from lyapcheck.errors import InputError
from lyapcheck.verdicts import Exit

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


def _version(wanted: bool) -> None:
    if wanted:
        from importlib.metadata import version

        print(f"lyapcheck {version('lyapcheck')}")
        raise typer.Exit(int(Exit.PROVED))


def _top(
    version: Annotated[
        bool, typer.Option("--version", help="Print the version and leave.", callback=_version, is_eager=True)
    ] = False,
) -> None:
    """Check the Lyapunov proof of bounded hyperbolic controllers for robot manipulators.

    Exit codes: 0 all proved or accepted, 1 something refuted or rejected, 2 unusable input, 3 undecided,
    4 internal error.
    """


def build_app(names: tuple[str, ...] = COMMANDS) -> typer.Typer:
    """The Typer application with the named commands."""
    app = typer.Typer(
        name="lyapcheck",
        callback=_top,
        no_args_is_help=True,
        add_completion=False,
        pretty_exceptions_enable=False,
    )
    for name in names:
        app.command(name)(import_module(f"lyapcheck.cli.{name}").command)
    return app


def main() -> None:
    """Run one command and leave with its exit code; no input ever shows a traceback."""
    _same_bytes_everywhere()
    wanted = sys.argv[1] if len(sys.argv) > 1 else ""
    app = build_app((wanted,) if wanted in COMMANDS else COMMANDS)
    try:
        app()
    except SystemExit as leave:
        # what Typer makes of a reader that went away is 1, which here would mean refuted
        sys.exit(CLOSED_PIPE if isinstance(leave.__context__, BrokenPipeError) else leave.code)
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


def _same_bytes_everywhere() -> None:
    """Write UTF-8 whatever the locale: γ must not depend on where a command runs."""
    for stream in (sys.stdout, sys.stderr):
        if isinstance(stream, io.TextIOWrapper):
            stream.reconfigure(encoding="utf-8", errors="backslashreplace")


def _one_line(text: str) -> str:
    """The text with everything that would break the line, or steer a terminal, written as an escape."""
    return "".join(c if c.isprintable() else c.encode("unicode_escape").decode("ascii") for c in text)
