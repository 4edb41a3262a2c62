"""``lyapcheck gate``."""

from __future__ import annotations

import sys
from enum import StrEnum
from typing import Annotated

import typer

from lyapcheck.errors import InputError, Problem
from lyapcheck.verdicts import Exit


class GateFormat(StrEnum):
    """How the results are written."""

    TEXT = "text"
    JSON = "json"
    JUNIT = "junit"
    SARIF = "sarif"
    GITHUB = "github"
    MARKDOWN = "markdown"


class Condition(StrEnum):
    """The conditions that can decide."""

    NORM = "10"
    JOINT = "10p"
    DAMPING = "19"


class Gamma(StrEnum):
    """Which γ the conditions use."""

    TRUE = "true"
    PRINTED = "printed"


def command(
    files: Annotated[list[str], typer.Argument(help="Gain files (TOML).", metavar="FILE...")],
    format: Annotated[GateFormat, typer.Option(help="How to write it.")] = GateFormat.TEXT,  # noqa: A002
    condition: Annotated[
        list[Condition] | None,
        typer.Option(help="A condition that must hold; may be repeated. Default: 10p and 19."),
    ] = None,
    robot: Annotated[str | None, typer.Option(help="An arm that replaces the one the files name.")] = None,
    gamma: Annotated[Gamma, typer.Option(help="The certified γ, or the one the paper prints.")] = Gamma.TRUE,
) -> None:
    """Accept or reject gains by the paper's conditions, decided exactly.

    For each gain set and joint: value, limit, margin and the largest value that would pass. Exit code 0: all
    accepted, 1: something rejected, 2: a file cannot be used, 3: undecided.
    """
    from lyapcheck.control.gains import read_gain_file
    from lyapcheck.control.gate import DECIDING, GateResult, gate, gate_exit
    from lyapcheck.control.gate_formats import renderer

    deciding = tuple(item.value for item in condition) if condition else DECIDING
    results: list[GateResult] = []
    problems: list[Problem] = []
    for file in files:
        try:
            results += gate(read_gain_file(file), robot, deciding, gamma.value)
        except InputError as error:
            problems += error.problems
    if results:
        sys.stdout.write(renderer(format.value)(results))
    if problems:
        sys.stdout.flush()
        raise InputError(problems)
    raise typer.Exit(int(gate_exit(results) if results else Exit.USAGE))
