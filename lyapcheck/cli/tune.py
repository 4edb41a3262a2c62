"""``lyapcheck tune``."""

from __future__ import annotations

import sys
from enum import StrEnum
from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer

from lyapcheck.cli.decimals import parse_decimal, parse_decimals
from lyapcheck.cli.m_range import parse_m
from lyapcheck.cli.output import require_writable, write_whole
from lyapcheck.errors import argument_error
from lyapcheck.verdicts import Exit

if TYPE_CHECKING:
    from lyapcheck.control.gains import Bounds, GainFile

PAPERS_ARM, PAPERS_GAINS = "buap3", "table2"


class TuneFormat(StrEnum):
    """How the result is written."""

    TEXT = "text"
    JSON = "json"
    MARKDOWN = "markdown"
    TOML = "toml"


def command(
    robot: Annotated[
        str, typer.Argument(help="A built-in arm or an arm file (.toml, .urdf).", metavar="ROBOT")
    ],
    m: Annotated[str, typer.Option("--m", help="Members of the family: 3, 1,2,5 or 1:12.")] = "1:3",
    digits: Annotated[int, typer.Option(help="Decimal places of the gains.")] = 3,
    peak_share: Annotated[
        str, typer.Option(help="Share of each torque limit that may be used, 0.8 or 0.8,0.9,1.")
    ] = "1",
    kv_share: Annotated[
        str | None,
        typer.Option(help="Share that k_v takes, at least, of the largest that (19) admits. Default: 1."),
    ] = None,
    kv_min: Annotated[str | None, typer.Option(help="Lower bound of k_v, N·m, instead of a share.")] = None,
    damping: Annotated[str | None, typer.Option(help="Lower bound of each joint's damping ratio.")] = None,
    torque: Annotated[str | None, typer.Option(help="Torque limits instead of the arm's, N·m.")] = None,
    gravity: Annotated[str | None, typer.Option(help="Gravity bounds instead of the arm's, N·m.")] = None,
    viscous_min: Annotated[str | None, typer.Option(help="λmin(B) instead of the arm's, N·m·s/rad.")] = None,
    compare: Annotated[
        Path | None, typer.Option(help="A gain file to compare with. For buap3: the paper's Table 2.")
    ] = None,
    out: Annotated[Path | None, typer.Option(help="Write the gain file there.")] = None,
    format: Annotated[TuneFormat, typer.Option(help="How to write it.")] = TuneFormat.TEXT,  # noqa: A002
) -> None:
    """The largest gains that an arm's limits admit, as a gain file that the gate accepts.

    For each m the largest k_p, and beside it the largest k_v, that meet (10p), (19) and the targets, exact to
    the last digit: no gain can be one unit larger. Exit code 0: every m has gains, 2: unusable input or no
    gains exist, 3: the arm's limits are not known.
    """
    from lyapcheck.tune import Targets, tune
    from lyapcheck.tune.formats import renderer
    from lyapcheck.tune.gain_file import gain_file_text

    if out is not None:
        require_writable("--out", out)
    targets = Targets(
        digits,
        parse_decimals("--peak-share", peak_share) or (),
        parse_decimals("--kv-share", kv_share),
        parse_decimals("--kv-min", kv_min),
        parse_decimals("--damping", damping),
    )
    bounds = _bounds(robot, torque, gravity, viscous_min)
    tuning = tune(robot, parse_m(m), targets, bounds, _against(robot, compare))
    if out is not None and tuning.exit == Exit.PROVED:
        write_whole(out, gain_file_text(tuning, out.parent))
    sys.stdout.write(renderer(format.value)(tuning))
    if format is TuneFormat.TOML:
        for item in tuning.sets:
            for reason in item.reasons:
                print(f"no gains for m = {item.m}: {reason}", file=sys.stderr)
    raise typer.Exit(int(tuning.exit))


def _bounds(robot: str, torque: str | None, gravity: str | None, viscous_min: str | None) -> Bounds:
    """The limits given on the command line.

    Raises:
        InputError: a negative one, or another number of them than joints.
    """
    from lyapcheck.control.gains import Bounds
    from lyapcheck.robots import load

    n = load(robot).n
    torques, gravities = parse_decimals("--torque", torque), parse_decimals("--gravity", gravity)
    friction = parse_decimal("--viscous-min", viscous_min)
    for option, values in (("--torque", torques), ("--gravity", gravities)):
        if values is not None and len(values) != n:
            rule = f"has {len(values)} values for {n} joints"
            raise argument_error(option, len(values), rule, f"give {n}, separated by commas")
    positive = (("--torque", torques), ("--viscous-min", None if friction is None else (friction,)))
    for option, values in positive:
        if values is not None and min(values) <= 0:
            raise argument_error(option, float(min(values)), "must be positive", "correct the value")
    if gravities is not None and min(gravities) < 0:
        raise argument_error("--gravity", float(min(gravities)), "must not be negative", "correct the value")
    return Bounds(friction, torques, gravities)


def _against(robot: str, compare: Path | None) -> GainFile | None:
    """The gains to compare with."""
    from dataclasses import replace

    from lyapcheck.control.gains import read_gain_file
    from lyapcheck.control.paper import paper_gain_file

    if compare is not None:
        return read_gain_file(compare)
    if robot != PAPERS_ARM:
        return None
    return replace(read_gain_file(paper_gain_file(PAPERS_GAINS)), path="the paper's Table 2")
