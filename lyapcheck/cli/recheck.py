"""``lyapcheck recheck``."""

from __future__ import annotations

import sys
from enum import StrEnum
from typing import Annotated

import typer


class RecheckFormat(StrEnum):
    """How the outcome is written."""

    TEXT = "text"
    JSON = "json"


def command(
    certificates: Annotated[
        list[str], typer.Argument(help="Certificate files, or directories of them.", metavar="CERTIFICATE…")
    ],
    format: Annotated[RecheckFormat, typer.Option(help="How to write it.")] = RecheckFormat.TEXT,  # noqa: A002
) -> None:
    """Verify certificates with the small checker alone: accepted, or refused with the reason.

    In a directory everything that a certificate uses must be there too. Exit code 0: all accepted, 1: some
    refused, 2: a file cannot be read.
    """
    from lyapcheck.check.files import Unreadable, gather
    from lyapcheck.check.recheck import recheck
    from lyapcheck.check.render import as_json, text
    from lyapcheck.errors import InputError, Problem
    from lyapcheck.verdicts import Exit

    try:
        outcome = recheck(gather(certificates))
    except Unreadable as error:
        repair = "give files written by check --certificates, or their directory"
        problems = [Problem(name, None, "CERTIFICATE", "", rule, repair) for name, rule in error.problems]
        raise InputError(problems) from error
    sys.stdout.write((as_json if format is RecheckFormat.JSON else text)(outcome))
    raise typer.Exit(int(Exit.PROVED if outcome.all_accepted else Exit.REFUTED))
