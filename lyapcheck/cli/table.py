"""``lyapcheck table``."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer

from lyapcheck.cli.m_range import parse_m
from lyapcheck.cli.output import open_folder, write_whole
from lyapcheck.cli.progress import progress
from lyapcheck.cli.show import show
from lyapcheck.errors import argument_error
from lyapcheck.output.formats import Format
from lyapcheck.verdicts import Exit

if TYPE_CHECKING:
    from lyapcheck.answers.table import Table

_MOST_DIGITS = 2_000
_QUIET_ROWS = 500


def command(
    m: Annotated[str, typer.Option("--m", help="Members of the family: 3, 1,2,5 or 1:12.")] = "1:12",
    digits: Annotated[int, typer.Option(help="Significant digits.")] = 30,
    robot: Annotated[
        str | None, typer.Option(help="Add what this arm's torque limits leave to k_p + k_v of each joint.")
    ] = None,
    asymptotics: Annotated[
        bool,
        typer.Option("--asymptotics", help="Add the leading terms for m → ∞, and what is left beside them."),
    ] = False,
    plot: Annotated[
        Path | None, typer.Option(help="Draw them against m into this folder, as SVG and PNG.")
    ] = None,
    format: Annotated[Format, typer.Option(help="How to write it.")] = Format.TEXT,  # noqa: A002
) -> None:
    """Certified γ, ρ and L of the hyperbolic family, and where each is reached.

    γ = sup h, ρ = sup |h'|, L = sup h(x)/x over x > 0. Every digit in a text is correct; the bounds in JSON
    and CSV enclose the exact number.
    """
    members = parse_m(m)
    if not 1 <= digits <= _MOST_DIGITS:
        raise argument_error("--digits", digits, f"must be from 1 to {_MOST_DIGITS}", "write --digits 30")
    from lyapcheck.answers.table import build_table

    folder = None if plot is None else open_folder("--plot", plot)
    with progress("table", quiet=len(members) < _QUIET_ROWS) as advance:
        table = build_table(members, digits, advance, with_asymptotes=asymptotics)
    if robot is not None:
        from dataclasses import replace

        from lyapcheck.answers.tune.budget import torque_budget

        table = replace(table, budget=torque_budget(robot, table))
    if folder is not None:
        _draw(table, folder)
    show(table, format)
    raise typer.Exit(int(Exit.PROVED))


def _draw(table: Table, folder: Path) -> None:
    """``constants.svg`` and ``constants.png``."""
    from lyapcheck.report.figures.constants import constants_png, constants_svg

    write_whole(folder / "constants.svg", constants_svg(table))
    write_whole(folder / "constants.png", constants_png(table))
