"""``lyapcheck check``."""

from __future__ import annotations

import sys
from pathlib import Path
from typing import TYPE_CHECKING

from lyapcheck.cli.show import certificate_folder, progress, show, write_certificates
from lyapcheck.cli.values import parse_m
from lyapcheck.output.escapes import printable
from lyapcheck.verdicts import Exit

if TYPE_CHECKING:
    from lyapcheck.cli.parser import Parser


def arguments(parser: Parser) -> None:
    """What the command takes."""
    parser.add_argument("proof", metavar="PROOF.py", help="Proof script. The paper is published.py.")
    parser.add_members("1:3")
    parser.add_robot("Arm by name or file. Default: the paper's arm.")
    parser.add_number("--n", int, "Number of joints, instead of an arm.")
    parser.add_argument("--gains", metavar="FILE", help="Gain file. Default: Table 2 of the paper.")
    parser.add_argument(
        "--only", metavar="ID", action="append", help="Report this claim only. May be repeated."
    )
    parser.add_certificates("Write a certificate of each decided claim to this folder")
    parser.add_argument("--timings", action="store_true", help="Add the seconds of each claim.")
    about = "Show each claim that is not proved, with its counterexample or the reason."
    parser.add_argument("--failed", action="store_true", help=about)
    parser.add_argument("--all", action="store_true", help="Show each claim with its statement and evidence.")
    parser.add_no_store()
    parser.add_format()


def run(
    proof: str,
    m: str,
    robot: str | None,
    n: int | None,
    gains: str | None,
    only: list[str] | None,
    certificates: Path | None,
    timings: bool,
    failed: bool,
    all: bool,  # noqa: A002
    format: str,  # noqa: A002
) -> Exit:
    """Decide if each claim of a proof script is proved, refuted with a counterexample, or undecided.

    A proof script is a program. Run only scripts that you trust with your files. A script cannot influence
    a verdict, because a fresh process of the checker decides its statements.

    Exit code 0: all proved, 1: something refuted, 2: the script or an input cannot be used, 3: something
    undecided and nothing refuted.

    Examples:
      lyapcheck check published.py --m 1:5
      lyapcheck check my_proof.py --robot arm.urdf --only 16.6 --certificates proof/
    """
    from dataclasses import replace

    from lyapcheck.answers.check import ALL, FAILED, SHORT
    from lyapcheck.answers.check.run import run_proof
    from lyapcheck.claims.decision import ContradictionError
    from lyapcheck.errors import argument_error

    if n is not None and robot is not None:
        raise argument_error(
            "--n", n, "a robot already says how many joints there are", "give --robot or --n"
        )
    if n is not None and n < 1:
        raise argument_error("--n", n, "there is at least one joint", "give 1 or more")
    folder = certificate_folder(certificates)
    try:
        with progress("check") as advance:
            result = run_proof(proof, parse_m(m), robot, n, gains, tuple(only or ()), advance)
    except ContradictionError as alarm:
        sys.stderr.write(f"ALARM: {alarm}\n")
        return Exit.INTERNAL
    if gains is not None:
        from lyapcheck.answers.check.run import left_out

        for sentence in left_out(gains, result.n, result.ms):
            print(printable(f"note: {sentence}"), file=sys.stderr)
    if folder is not None:
        write_certificates(folder, result.certificates)
    extent = ALL if all else FAILED if failed else SHORT
    written = str(folder or "")
    show(replace(result, timings=timings, extent=extent, folder=written), format)
    return result.exit_code
