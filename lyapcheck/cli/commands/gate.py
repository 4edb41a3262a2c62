"""``lyapcheck gate``."""

from __future__ import annotations

import sys
from pathlib import Path
from typing import TYPE_CHECKING

from lyapcheck.cli.show import certificate_folder, progress, show, write_certificates
from lyapcheck.cli.values import loop_of, varies
from lyapcheck.errors import InputError, Problem

if TYPE_CHECKING:
    from lyapcheck.answers.gate import GateAnswer
    from lyapcheck.cli.parser import Parser
    from lyapcheck.verdicts import Exit


CONDITIONS = ("10", "10p", "10i", "19", "scalar", "global", "lasalle", "sampled", "holds")
"""The conditions that can decide."""


def arguments(parser: Parser) -> None:
    """What the command takes."""
    parser.add_argument("files", metavar="FILE...", nargs="+", help="Gain files (TOML).")
    parser.add_robot("Arm by name or file, instead of the arm in the gain files.")
    about = (
        "Condition that must hold. May be repeated. 10i is 10p without its √n. scalar and global prove "
        "dV/dt < 0 for the arm. lasalle proves stability without friction. sampled is stability on a "
        "computer. holds means that unknown gravity is held. Default: the conditions of the gain file, "
        "else 10p and 19."
    )
    parser.add_choice("--condition", CONDITIONS, about, repeated=True)
    about = "Treat undecided as a failure, exit code 1."
    parser.add_argument("--strict", action="store_true", help=about)
    parser.add_vary()
    parser.add_loop()
    parser.add_certificates("Write the certificate of each verdict and check to this folder")
    parser.add_format()


def run(
    files: list[str],
    robot: str | None,
    condition: list[str] | None,
    strict: bool,
    vary: list[str] | None,
    certificates: Path | None,
    format: str,  # noqa: A002
    **loop: str | None,
) -> Exit:
    """Accept or reject gains by the paper's conditions or by a proof for the arm, as the checker judges them.

    The answer has the value, the limit and the margin of each gain set and joint. It also has the largest
    value that would pass.

    Exit code 0: all accepted, 1: something rejected, 2: a file cannot be used, 3: something undecided.

    Examples:
      lyapcheck gate gains.toml
      lyapcheck gate config/*.toml --format junit > gate.xml
      lyapcheck gate gains.toml --condition 10p --condition scalar
      lyapcheck gate gains.toml --rate 1000 --unknown-payload 2
      lyapcheck gate gains.toml --rate 1000 --within 90
    """
    import gc

    gc.set_threshold(3_000_000)  # modules and ten thousand sets hold no garbage, and would be looked through

    from lyapcheck._types import part
    from lyapcheck.answers.gate import GateAnswer, gate
    from lyapcheck.control.gains import arm_named_in, read_gain_file
    from lyapcheck.control.limits import Limits, arm_limits
    from lyapcheck.robots.choice import named

    folder = certificate_folder(certificates)
    results: list[GateAnswer] = []
    problems: list[Problem] = []
    arms: dict[str, Limits] = {}
    ranges, run = varies(vary), loop_of(loop)
    with progress("gate") as advance:
        for done, file in enumerate(files):
            try:
                gain_file = read_gain_file(file, robot, undamped=True)
                name = named(robot, gain_file.robot)
                if ranges and name is not None and name not in arms:
                    with arm_named_in(gain_file, robot):
                        arms[name] = arm_limits(name, ranges)
                advanced = part(advance, done / len(files), (done + 1) / len(files))
                results.append(gate(gain_file, robot, condition, strict, arms, advanced, run))
            except InputError as error:
                problems += error.problems
    answer = GateAnswer(result for outcome in results for result in outcome)
    answer.problems = tuple(problems)
    if answer:
        if folder is not None:
            from lyapcheck.answers.gate.certificates import certificates as certificates_of

            made, granted = certificates_of(answer)
            write_certificates(folder, made)
            for sentence in granted:
                print(f"note: {sentence}", file=sys.stderr)
        show(answer, format)
    if problems:
        unusable = InputError(problems)
        unusable.told = bool(answer)
        raise unusable
    return answer.exit_code
