"""``lyapcheck explain``."""

from __future__ import annotations

from typing import Annotated

import typer

from lyapcheck.cli.show import show
from lyapcheck.output.formats import Format
from lyapcheck.verdicts import Exit


def command(
    id: Annotated[str, typer.Argument(help="The id of a claim, such as 7a or 16.6.", metavar="ID")],  # noqa: A002
    proof: Annotated[
        str | None,
        typer.Option(help="The proof script that makes the claim. Default: the first of lyapcheck's own."),
    ] = None,
    format: Annotated[Format, typer.Option(help="How to write it.")] = Format.TEXT,  # noqa: A002
) -> None:
    """Say what a claim states, where the paper makes it, what it uses and how it is decided."""
    from lyapcheck.answers.explain import explain

    show(explain(id, proof), format)
    raise typer.Exit(int(Exit.PROVED))
