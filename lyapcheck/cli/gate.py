"""``lyapcheck gate``."""

from __future__ import annotations

from enum import StrEnum
from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer

from lyapcheck.cli.show import show
from lyapcheck.output.formats import JudgedFormat

if TYPE_CHECKING:
    from lyapcheck.answers.gate import GateAnswer


class Condition(StrEnum):
    """The conditions that can decide."""

    NORM = "10"
    JOINT = "10p"
    DAMPING = "19"
    SCALAR = "scalar"
    GLOBAL = "global"


class Gamma(StrEnum):
    """Which γ the conditions use."""

    TRUE = "true"
    PRINTED = "printed"


def command(
    files: Annotated[list[str], typer.Argument(help="Gain files (TOML).", metavar="FILE...")],
    format: Annotated[JudgedFormat, typer.Option(help="How to write it.")] = JudgedFormat.TEXT,  # noqa: A002
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
        Path | None, typer.Option(help="Write the certificate of each check there; see recheck.")
    ] = None,
) -> None:
    """Accept or reject gains by the paper's conditions, as the checker judges them.

    For each gain set and joint: value, limit, margin and the largest value that would pass. Exit code 0: all
    accepted, 1: something rejected, 2: a file cannot be used, 3: undecided.
    """
    from lyapcheck.answers.gate import DECIDING, GateAnswer, gate
    from lyapcheck.cli.output import open_folder
    from lyapcheck.control.arm_limits import ArmLimits
    from lyapcheck.control.gains import read_gain_file
    from lyapcheck.errors import InputError, Problem

    folder = None if certificates is None else open_folder("--certificates", certificates)
    results: list[GateAnswer] = []
    problems: list[Problem] = []
    arms: dict[str, ArmLimits] = {}
    deciding = tuple(item.value for item in condition or ()) or DECIDING
    for file in files:
        try:
            results.append(gate(read_gain_file(file), robot, deciding, gamma.value, strict, arms))
        except InputError as error:
            problems += error.problems
    answer = GateAnswer(result for found in results for result in found)
    if answer:
        if folder is not None:
            _write_certificates(folder, answer)
        show(answer, format)
    if problems:
        raise InputError(problems)
    raise typer.Exit(int(answer.exit_code))


def _write_certificates(folder: Path, answer: GateAnswer) -> None:
    """One file for each check that was decided."""
    from lyapcheck.answers.gate.certificates import certificates
    from lyapcheck.cli.output import write_whole

    for name, certificate in certificates(answer).items():
        write_whole(folder / name, certificate.text())
