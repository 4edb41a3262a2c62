"""``lyapcheck robot``."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path
from typing import Annotated

import typer

from lyapcheck.cli.progress import progress
from lyapcheck.cli.show import show
from lyapcheck.output.escapes import printable
from lyapcheck.output.formats import JudgedFormat


def command(
    robot: Annotated[
        str, typer.Argument(help="A built-in arm, or an arm file (.toml, .urdf).", metavar="NAME|FILE")
    ],
    tip: Annotated[
        str | None, typer.Option(help="For a URDF: the link that ends the chain. Default: the longest chain.")
    ] = None,
    max_boxes: Annotated[
        int | None,
        typer.Option(help="Budget of boxes for each constant. Default: 200000/n² for n joints.", min=1),
    ] = None,
    certificates: Annotated[
        str | None, typer.Option(help="Write the certificates of what is decided there; see recheck.")
    ] = None,
    format: Annotated[JudgedFormat, typer.Option(help="How to write it.")] = JudgedFormat.TEXT,  # noqa: A002
) -> None:
    """Decide properties 2.1–2.8 of an arm and bound its constants from both sides.

    λmin(M), λmax(M) = β_M, k_c, k_g and every k_gi, each with a state that shows it: ends that a certificate
    shows, and the sharper ones of floating point (numeric; wider where the budget of boxes ends). Friction,
    torque limits, and every number with its source.
    Where the source prints C or g too, the print is compared with what M and the potential give.

    Exit code 0: all properties proved, 1: one is refuted, 2: the arm cannot be read, 3: one is undecided.
    """
    from lyapcheck.cli.output import open_folder, write_whole
    from lyapcheck.robots import load, names

    model = load(robot, tip)
    from lyapcheck.answers.robot import build

    folder = None if certificates is None else open_folder("--certificates", Path(certificates))
    with progress("robot") as advance:
        report = build(model, max_boxes, advance)
    if folder is not None:
        for name, certificate in report.certificates.items():
            write_whole(folder / name, certificate.text())
    show(replace(report, path="" if robot in names() else printable(robot)), format)
    raise typer.Exit(int(report.exit_code))
