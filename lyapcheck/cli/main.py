"""The command line: one file a command, and only the one that is run gets imported."""

from __future__ import annotations

import os
import sys
from importlib import import_module
from typing import Annotated

import typer

from lyapcheck.errors import InputError
from lyapcheck.verdicts import Exit

COMMANDS = ("check", "epsilon", "explain", "gate", "recheck", "report", "robot", "simulate", "table")


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
    wanted = sys.argv[1] if len(sys.argv) > 1 else ""
    app = build_app((wanted,) if wanted in COMMANDS else COMMANDS)
    try:
        app()
    except InputError as error:
        for problem in error.problems:
            print(f"error: {problem}", file=sys.stderr)
        sys.exit(Exit.USAGE)
    except BrokenPipeError:
        os.dup2(os.open(os.devnull, os.O_WRONLY), sys.stdout.fileno())
        sys.exit(Exit.PROVED)
    except Exception as error:
        if os.environ.get("LYAPCHECK_DEBUG"):
            raise
        print(
            f"internal error: {type(error).__name__}: {error}; "
            "this is a fault in lyapcheck, run again with LYAPCHECK_DEBUG=1 and report what it prints",
            file=sys.stderr,
        )
        sys.exit(Exit.INTERNAL)
