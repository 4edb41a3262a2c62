"""The Typer application."""

from __future__ import annotations

from collections.abc import Sequence
from importlib import import_module
from typing import Annotated

import typer

from lyapcheck.verdicts import Exit


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


def build(names: Sequence[str]) -> typer.Typer:
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
