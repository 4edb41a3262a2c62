"""``lyapcheck table``."""

from __future__ import annotations

import sys
from enum import StrEnum
from typing import Annotated

import typer

from lyapcheck.cli.m_range import parse_m
from lyapcheck.cli.progress import progress
from lyapcheck.errors import argument_error
from lyapcheck.verdicts import Exit

_MOST_DIGITS = 2_000
_QUIET_ROWS = 500


class TableFormat(StrEnum):
    """How the table is written."""

    TEXT = "text"
    JSON = "json"
    CSV = "csv"
    MARKDOWN = "markdown"
    LATEX = "latex"


def command(
    m: Annotated[str, typer.Option("--m", help="Members of the family: 3, 1,2,5 or 1:12.")] = "1:12",
    digits: Annotated[int, typer.Option(help="Significant digits.")] = 30,
    robot: Annotated[
        str | None, typer.Option(help="Add what this arm's torque limits leave to k_p + k_v of each joint.")
    ] = None,
    format: Annotated[TableFormat, typer.Option(help="How to write it.")] = TableFormat.TEXT,  # noqa: A002
) -> None:
    """Certified γ, ρ and L of the hyperbolic family, and where each is reached.

    γ = sup h, ρ = sup |h'|, L = sup h(x)/x over x > 0. Every digit in a text is correct; the bounds in JSON
    and CSV enclose the exact number.
    """
    members = parse_m(m)
    if not 1 <= digits <= _MOST_DIGITS:
        raise argument_error("--digits", digits, f"must be from 1 to {_MOST_DIGITS}", "write --digits 30")
    from lyapcheck.family.table import RENDERERS, build_table

    with progress("table", quiet=len(members) < _QUIET_ROWS) as advance:
        table = build_table(members, digits, advance)
    if robot is not None:
        from dataclasses import replace

        from lyapcheck.tune.budget import torque_budget

        table = replace(table, budget=torque_budget(robot, table))
    sys.stdout.write(RENDERERS[format.value](table))
    raise typer.Exit(int(Exit.PROVED))
