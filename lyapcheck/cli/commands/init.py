"""``lyapcheck init``."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING

from lyapcheck.cli.show import open_folder, write_whole
from lyapcheck.errors import InputError, Problem, argument_error
from lyapcheck.extensions import shipped
from lyapcheck.verdicts import Exit

if TYPE_CHECKING:
    from lyapcheck.cli.parser import Parser

GAINS, ARM = "gains.toml", "arm.toml"
"""Files of ``examples/init``."""


def arguments(parser: Parser) -> None:
    """What the command takes."""
    about = "Folder for the files. Default: this folder."
    parser.add_argument("folder", metavar="DIR", nargs="?", type=Path, default=Path(), help=about)
    about = "Convert the gains in this YAML (ros2_control), JSON or CSV file with a header."
    parser.add_argument("--from", metavar="FILE", type=Path, dest="source", help=about)
    parser.add_argument("--arm", metavar="ROBOT", dest="robot", help="Arm of these gains, by name or file.")
    parser.add_choice_of_arm()


def run(folder: Path, source: Path | None, robot: str | None) -> Exit:
    """Write a gain file and an arm file to edit, gains.toml and arm.toml.

    Existing files stay as they are. With --from and --arm the command writes a gain file only. Its gains have
    the slope of the other program's gains at the goal, reduced to (10p).

    Exit code 0: the files are written, 2: a file exists already, or the folder cannot be written.

    Examples:
      lyapcheck init bench && lyapcheck gate bench/gains.toml
      lyapcheck tune arm.urdf --out gains.toml    instead, for a URDF file
      lyapcheck init --from pid.yaml --arm arm.urdf
    """
    if (source is None) != (robot is None):
        missing = "--arm" if robot is None else "--from"
        repair = "write --from pid.yaml --arm arm.urdf"
        raise argument_error(missing, "", "is missing: gains are brought over for an arm", repair)
    place = open_folder("DIR", folder)
    first = shipped("examples") / "init"
    texts = {name: (first / name).read_text(encoding="utf-8") for name in (GAINS, ARM)}
    if source is not None and robot is not None:
        from lyapcheck.answers.tune.gain_file import brought_file

        texts = {GAINS: brought_file(source, robot, place)}
    there = [name for name in texts if (place / name).exists()]
    if there:
        rule, repair = "is there already", "name another folder, or move it away"
        raise InputError([Problem("argument", None, str(place / name), "", rule, repair) for name in there])
    for name, text in texts.items():
        write_whole(place / name, text)
        print(f"{place / name}")
    print(f"next: lyapcheck gate {place / GAINS}")
    return Exit.PROVED
