"""``lyapcheck recheck``."""

from __future__ import annotations

from typing import Annotated

import typer

from lyapcheck.check.command import FORMATS, HELP, run
from lyapcheck.check.limits import MOST, Limits
from lyapcheck.check.recheck import Outcome
from lyapcheck.output.formats import JudgedFormat


def command(
    certificates: Annotated[
        list[str], typer.Argument(help="Certificate files, or directories of them.", metavar="CERTIFICATE…")
    ],
    format: Annotated[JudgedFormat, typer.Option(help=HELP["format"])] = JudgedFormat.TEXT,  # noqa: A002
    full: Annotated[bool, typer.Option("--full", help=HELP["full"])] = False,
    trusted: Annotated[bool, typer.Option("--trusted", help=HELP["trusted"])] = False,
    seconds: Annotated[int, typer.Option(min=1, max=MOST, help=HELP["seconds"])] = Limits.seconds,
    memory: Annotated[int, typer.Option(min=1, max=MOST, help=HELP["memory"])] = Limits.memory,
) -> None:
    """Verify certificates with the small checker alone: accepted, refused or undecided, with the reason.

    What is printed as a statement is rendered from its data; the words of its author are marked as such. A
    certificate is undecided as long as one that it uses is not at hand. Exit code 0: all accepted, 1: some
    refused, 2: a file cannot be read, 3: some undecided and none refused, 4: one statement both proved and
    refuted.
    """

    def written(outcome: Outcome, with_trusted: bool) -> str:
        from lyapcheck.answers.recheck import Recheck

        return Recheck(outcome, with_trusted).written(format)

    formats = {format.value: written} | dict(FORMATS)  # text and JSON are the checker's own
    raise typer.Exit(run(certificates, format.value, full, trusted, seconds, memory, formats))
