"""``lyapcheck check``."""

from __future__ import annotations

import sys
from pathlib import Path
from typing import Annotated

import typer

from lyapcheck.output.formats import JudgedFormat


def command(
    proof: Annotated[
        str, typer.Argument(help="A proof script; published.py is the paper's.", metavar="PROOF.py")
    ],
    m: Annotated[str, typer.Option("--m", help="Members of the family: 3, 1,2,5 or 1:12.")] = "1:3",
    robot: Annotated[str | None, typer.Option(help="A robot name or file. Default: the paper's arm.")] = None,
    n: Annotated[int | None, typer.Option("--n", help="Number of joints, in place of a robot.")] = None,
    gains: Annotated[str | None, typer.Option(help="A gain file. Default: the paper's Table 2.")] = None,
    only: Annotated[list[str] | None, typer.Option(help="Report this claim only; may be repeated.")] = None,
    format: Annotated[JudgedFormat, typer.Option(help="How to write it.")] = JudgedFormat.TEXT,  # noqa: A002
    certificates: Annotated[
        str | None, typer.Option(help="Write a certificate per decided claim there; see recheck.")
    ] = None,
    timings: Annotated[bool, typer.Option("--timings", help="Add the seconds each claim took.")] = False,
) -> None:
    """Run a proof script claim by claim: proved, refuted with a witness, or undecided with a reason.

    A proof script is a program: run only what you trust with your files. It cannot influence a verdict,
    though: it hands over statements, and a fresh process of the checker decides them.

    Exit code 0: all proved, 1: something refuted, 2: the script or an input cannot be used, 3: something
    undecided and nothing refuted.
    """
    from dataclasses import replace

    from lyapcheck.claims import run_proof
    from lyapcheck.claims.fresh_check import Alarm
    from lyapcheck.cli.m_range import parse_m
    from lyapcheck.cli.output import open_folder, write_whole
    from lyapcheck.cli.progress import progress
    from lyapcheck.cli.show import show
    from lyapcheck.errors import argument_error
    from lyapcheck.verdicts import Exit

    if n is not None and robot is not None:
        raise argument_error(
            "--n", n, "a robot already says how many joints there are", "give --robot or --n"
        )
    if n is not None and n < 1:
        raise argument_error("--n", n, "there is at least one joint", "give 1 or more")
    folder = None if certificates is None else open_folder("--certificates", Path(certificates))
    try:
        with progress("check") as advance:
            result = run_proof(proof, parse_m(m), robot, n, gains, tuple(only or ()), advance)
    except Alarm as alarm:
        sys.stderr.write(f"ALARM: {alarm}\n")
        raise typer.Exit(int(Exit.INTERNAL)) from alarm
    if folder is not None:
        for name, certificate in result.certificates.items():
            write_whole(folder / name, certificate.text())
    show(replace(result, timings=timings), format)
    raise typer.Exit(int(result.exit_code))
