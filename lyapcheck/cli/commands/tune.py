"""``lyapcheck tune``."""

from __future__ import annotations

import sys
from fractions import Fraction
from pathlib import Path
from typing import TYPE_CHECKING

from lyapcheck.cli.complaints import Complaints
from lyapcheck.cli.decimals import parse_decimal, parse_decimals
from lyapcheck.cli.m_range import parse_m
from lyapcheck.cli.options import add_format, add_members
from lyapcheck.cli.output import require_writable, write_whole
from lyapcheck.cli.show import show
from lyapcheck.errors import argument_error
from lyapcheck.output.escapes import document_text
from lyapcheck.output.formats import Format
from lyapcheck.verdicts import Exit

if TYPE_CHECKING:
    from lyapcheck.answers.tune import Targets
    from lyapcheck.cli.parser import Parser
    from lyapcheck.control.gains import Bounds, GainFile

ONE = (Fraction(1),)

PAPERS_ARM, PAPERS_GAINS = "buap3", "table2"


FORMATS = (*Format, "toml")
"""What every answer can be written in, and the gain file alone."""


def arguments(parser: Parser) -> None:
    """What the command takes."""
    parser.add_argument("robot", metavar="ROBOT", help="A built-in arm or an arm file (.toml, .urdf).")
    add_members(parser, "1:3")
    parser.add_whole("--digits", "Decimal places of the gains.", default=3)
    about = "Share of each torque limit that may be used, 0.8 or 0.8,0.9,1."
    parser.add_argument("--peak-share", metavar="SHARES", default="1", help=about)
    about = "Share that k_v takes, at least, of the largest that (19) admits; 1 if missing."
    parser.add_argument("--kv-share", metavar="SHARES", help=about)
    about = "Lower bound of k_v, N·m, instead of a share."
    parser.add_argument("--kv-min", metavar="TORQUES", help=about)
    about = "Lower bound of each joint's damping ratio."
    parser.add_argument("--damping", metavar="RATIOS", help=about)
    parser.add_argument("--torque", metavar="TORQUES", help="Torque limits instead of the arm's, N·m.")
    parser.add_argument("--gravity", metavar="TORQUES", help="Gravity bounds instead of the arm's, N·m.")
    parser.add_argument("--viscous-min", metavar="N", help="λmin(B) instead of the arm's, N·m·s/rad.")
    about = "A gain file to compare with. For buap3: the paper's Table 2."
    parser.add_argument("--compare", metavar="FILE", type=Path, help=about)
    parser.add_argument("--out", metavar="FILE", type=Path, help="Write the gain file there.")
    add_format(parser, FORMATS)


def run(
    robot: str,
    m: str,
    digits: int,
    peak_share: str,
    kv_share: str | None,
    kv_min: str | None,
    damping: str | None,
    torque: str | None,
    gravity: str | None,
    viscous_min: str | None,
    compare: Path | None,
    out: Path | None,
    format: str,  # noqa: A002
) -> Exit:
    """The largest gains that an arm's limits admit, as a gain file that the gate accepts.

    For each m the largest k_p, and beside it the largest k_v, that meet (10p), (19) and the targets, exact to
    the last digit: no gain can be one unit larger.

    Exit code 0: every m has gains, 2: unusable input or no gains exist, 3: the arm's limits are not known.

    Examples:
      lyapcheck tune buap3 --m 1:5
      lyapcheck tune arm.urdf --peak-share 0.8 --damping 0.7 --out gains.toml
    """
    from lyapcheck.answers.tune import tune
    from lyapcheck.answers.tune.gain_file import gain_file_text

    wrong = Complaints()
    if out is not None:
        wrong.reading(require_writable, "--out", out)
    members = wrong.reading(parse_m, m)
    targets = _targets(wrong, digits, peak_share, kv_share, kv_min, damping)
    bounds = _bounds(wrong, robot, targets, torque, gravity, viscous_min)
    against = wrong.reading(_against, robot, compare)
    wrong.tell()
    tuning = tune(robot, members or (), targets, bounds, against)
    if out is not None and tuning.exit == Exit.PROVED:
        write_whole(out, gain_file_text(tuning, out.parent))
    if format != "toml":
        show(tuning, format)
    else:
        sys.stdout.write(document_text(gain_file_text(tuning)))
        for item in tuning.sets:
            for reason in item.reasons:
                print(f"no gains for m = {item.m}: {reason}", file=sys.stderr)
    return tuning.exit


def _targets(
    wrong: Complaints,
    digits: int,
    peak_share: str,
    kv_share: str | None,
    kv_min: str | None,
    damping: str | None,
) -> Targets:
    """The targets given on the command line; those that cannot be read are left at their defaults."""
    from lyapcheck.answers.tune import Targets

    shares = wrong.reading(parse_decimals, "--peak-share", peak_share)
    others = (("--kv-share", kv_share), ("--kv-min", kv_min), ("--damping", damping))
    return Targets(digits, shares or ONE, *(wrong.reading(parse_decimals, *each) for each in others))


def _bounds(
    wrong: Complaints,
    robot: str,
    targets: Targets,
    torque: str | None,
    gravity: str | None,
    viscous_min: str | None,
) -> Bounds:
    """The limits given on the command line; these and the targets are held against the joints of the arm."""
    from lyapcheck.answers.tune.targets import require_usable
    from lyapcheck.control.gains import Bounds
    from lyapcheck.robots import load

    torques = wrong.reading(parse_decimals, "--torque", torque)
    gravities = wrong.reading(parse_decimals, "--gravity", gravity)
    friction = wrong.reading(parse_decimal, "--viscous-min", viscous_min)
    model = wrong.reading(load, robot)
    if model is not None:
        wrong.reading(require_usable, targets, model.n)
    n = None if model is None else model.n
    wrong.reading(_require_limits, "--torque", torques, n, True)
    wrong.reading(_require_limits, "--gravity", gravities, n, False)
    wrong.reading(_require_limits, "--viscous-min", None if friction is None else (friction,), None, True)
    return Bounds(friction, torques, gravities)


def _require_limits(option: str, values: tuple[Fraction, ...] | None, n: int | None, positive: bool) -> None:
    """Refuse a negative limit, or another number of them than joints where that is known.

    Raises:
        InputError: the first that is wrong.
    """
    if values is None:
        return
    if n is not None and len(values) != n:
        rule = f"has {len(values)} values for {n} joints"
        raise argument_error(option, _written(values), rule, f"give {n}, separated by commas")
    if min(values) < 0 or (positive and min(values) == 0):
        rule = "must be positive" if positive else "must not be negative"
        raise argument_error(option, _written((min(values),)), rule, "correct the value")


def _written(values: tuple[Fraction, ...]) -> str:
    from lyapcheck.files.decimals import decimal_text

    return ",".join(map(decimal_text, values))


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
