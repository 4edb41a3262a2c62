"""``lyapcheck gate``."""

from __future__ import annotations

from typing import Annotated

import typer

from lyapcheck.cli.gate_options import Condition, Gamma, GateCall, GateFormat


def command(
    files: Annotated[list[str], typer.Argument(help="Gain files (TOML).", metavar="FILE...")],
    format: Annotated[GateFormat, typer.Option(help="How to write it.")] = GateFormat.TEXT,  # noqa: A002
    condition: Annotated[
        list[Condition] | None,
        typer.Option(
            help="A condition that must hold; may be repeated. scalar and global: dV/dt < 0 proved for the "
            "arm. Default: 10p and 19."
        ),
    ] = None,
    robot: Annotated[str | None, typer.Option(help="An arm that replaces the one the files name.")] = None,
    gamma: Annotated[Gamma, typer.Option(help="The certified γ, or the one the paper prints.")] = Gamma.TRUE,
    strict: Annotated[
        bool, typer.Option("--strict", help="What is undecided counts as a failure, exit code 1.")
    ] = False,
    certificates: Annotated[
        str | None, typer.Option(help="Write the certificate of each check there; see recheck.")
    ] = None,
) -> None:
    """Accept or reject gains by the paper's conditions, as the checker judges them.

    For each gain set and joint: value, limit, margin and the largest value that would pass. Exit code 0: all
    accepted, 1: something rejected, 2: a file cannot be used, 3: undecided.
    """
    from lyapcheck.cli.gate_run import run

    conditions = tuple(item.value for item in condition or ())
    call = GateCall(tuple(files), format.value, conditions, robot, gamma.value, strict, certificates)
    raise typer.Exit(int(run(call)))
