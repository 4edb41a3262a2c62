"""``lyapcheck explain``."""

from __future__ import annotations

import sys
from typing import Annotated

import typer

from lyapcheck.verdicts import Exit


def command(
    id: Annotated[str, typer.Argument(help="The id of a claim, such as 7a or 16.6.", metavar="ID")],  # noqa: A002
    proof: Annotated[str, typer.Option(help="The proof script that makes the claim.")] = "published.py",
) -> None:
    """Say what a claim states, where the paper makes it, what it uses and how it is decided."""
    from lyapcheck.claims.explain import explain

    sys.stdout.write(explain(id, proof))
    raise typer.Exit(int(Exit.PROVED))
