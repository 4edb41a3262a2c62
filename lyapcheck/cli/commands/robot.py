"""``lyapcheck robot``."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path
from typing import TYPE_CHECKING

from lyapcheck.cli.show import (
    certificate_folder,
    progress,
    require_writable,
    show,
    write_certificates,
    write_data,
    write_whole,
)
from lyapcheck.errors import argument_error
from lyapcheck.output.document import command
from lyapcheck.output.escapes import printable
from lyapcheck.verdicts import Exit

if TYPE_CHECKING:
    from lyapcheck.cli.parser import Parser


def arguments(parser: Parser) -> None:
    """What the command takes."""
    parser.add_argument("robot", metavar="NAME|FILE", help="Arm by name or file (.toml, .urdf).")
    parser.add_choice_of_arm()
    about = "Largest number of boxes for each bound. Default: 2000."
    parser.add_number("--max-boxes", int, about, least=1)
    about = "Write the arm as an arm file to edit, and decide nothing. - is standard output."
    parser.add_argument("--export", metavar="FILE", type=Path, help=about)
    about = "List the assumed numbers and all other assumptions of the arm, and decide nothing."
    parser.add_argument("--assumptions", action="store_true", help=about)
    parser.add_certificates("Write the certificates to this folder")
    parser.add_no_store()
    parser.add_format()


def run(
    robot: str,
    max_boxes: int | None,
    export: Path | None,
    assumptions: bool,
    certificates: Path | None,
    format: str,  # noqa: A002
) -> Exit:
    """Decide properties 2.1–2.8 of an arm and bound its constants from both sides.

    The constants are λmin(M), λmax(M) = β_M, k_c, k_g and every k_gi, with the states that reach them. Both
    ends of a constant are certified. The answer also lists friction, torque limits and the source of every
    number. If the source prints C or g, the print is
    compared with M and the potential.

    Exit code 0: all properties proved, 1: a property is refuted, 2: the arm cannot be read, 3: a property is
    undecided.

    Examples:
      lyapcheck robot buap3
      lyapcheck robot arm.urdf --tip hand --certificates proof/
      lyapcheck robot buap3 --export arm.toml
      lyapcheck robot buap3 --assumptions
    """
    from lyapcheck.robots import load, names

    if export is not None:
        from lyapcheck.robots import arm_text

        if str(export) == "-":
            write_data(arm_text(robot, Path()))
            return Exit.PROVED
        require_writable("--export", export)
        if export.exists():
            raise argument_error("--export", export, "is there already", "name another file")
        write_whole(export, arm_text(robot, export.parent))
        print(printable(f"{export}: the arm {robot} as a file to edit"))
        print(f"next: {command('robot', export)}")
        return Exit.PROVED
    model = load(robot)
    if assumptions:
        from lyapcheck.answers.robot.numbers import ArmAssumptions

        show(ArmAssumptions(model, robot), format)
        return Exit.PROVED
    from lyapcheck.answers.robot import build

    folder = certificate_folder(certificates)
    with progress("robot") as advance:
        report = build(model, max_boxes, advance)
    if folder is not None:
        write_certificates(folder, report.certificates)
    show(replace(report, path="" if robot in names() else printable(robot)), format)
    return report.exit_code
