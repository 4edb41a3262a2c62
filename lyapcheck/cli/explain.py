"""``lyapcheck explain``."""

from __future__ import annotations

import sys
from enum import StrEnum
from typing import Annotated

import typer

from lyapcheck.output.escapes import document_text
from lyapcheck.verdicts import Exit


class ExplainFormat(StrEnum):
    """How the explanation is written."""

    TEXT = "text"
    JSON = "json"
    MARKDOWN = "markdown"


def command(
    id: Annotated[str, typer.Argument(help="The id of a claim, such as 7a or 16.6.", metavar="ID")],  # noqa: A002
    proof: Annotated[
        str | None,
        typer.Option(help="The proof script that makes the claim. Default: the first of lyapcheck's own."),
    ] = None,
    format: Annotated[ExplainFormat, typer.Option(help="How to write it.")] = ExplainFormat.TEXT,  # noqa: A002
) -> None:
    """Say what a claim states, where the paper makes it, what it uses and how it is decided."""
    from lyapcheck.claims.explain import explain
    from lyapcheck.claims.explain_formats import renderer

    sys.stdout.write(document_text(renderer(format.value)(explain(id, proof))))
    raise typer.Exit(int(Exit.PROVED))
