"""``lyapcheck export``."""

from __future__ import annotations

from fractions import Fraction
from pathlib import Path
from typing import TYPE_CHECKING

from lyapcheck.cli.values import (
    Complaints,
    add_format,
    add_gain_file,
    add_robot,
    parse_decimal,
    parse_decimals,
)
from lyapcheck.errors import InputError, Problem, argument_error

if TYPE_CHECKING:
    from lyapcheck.cli.parser import Parser
    from lyapcheck.verdicts import Exit

SLOWEST, FASTEST = 1, 1_000_000
"""Hz."""
MOST_TAPS, LARGEST_TAP, MOST_HELD = 64, 1000, 1000


def arguments(parser: Parser) -> None:
    """What the command takes."""
    add_gain_file(parser)
    about = "The folder for the files, made if need be."
    parser.add_argument("--out", metavar="DIR", type=Path, help=about)
    about = "How often NAME_step is called, Hz."
    parser.add_argument("--rate", metavar="HZ", help=about)
    about = "Weights of backward differences in the velocity, newest first; their sum is 1."
    parser.add_argument("--filter", metavar="F,…", default="1", help=about)
    about = "Readings jump at a full turn; NAME_step counts turns."
    parser.add_argument("--wrapped", action="store_true", help=about)
    about = "Samples without a good reading for which the last torque is sent, before gravity alone."
    parser.add_number("--hold-samples", int, about, default=3, least=0, most=MOST_HELD)
    add_robot(parser)
    add_format(parser)


def run(
    file: Path,
    out: Path | None,
    rate: str | None,
    filter: str,  # noqa: A002
    wrapped: bool,
    hold_samples: int,
    robot: str | None,
    format: str,  # noqa: A002
) -> Exit:
    """Write each gain set as a controller in C99, with a computed bound of rounding.

    NAME.h, NAME.c, NAME_test.c and NAME.json, whose names come from the gain set's. NAME_torque computes
    K_p h(e) − K_v h(w) + g(q); NAME_step reads angles at a rate, and keeps motors within their limits.

    Exit code 0: written, whatever the gate says of the gains, 2: a file cannot be used, or another is there.

    Examples:
      lyapcheck export gains.toml --out controller --rate 1000
      lyapcheck export gains.toml --out controller --rate 400 --filter 0.5,0.5 --wrapped
    """
    from lyapcheck.cli.show import open_folder, show, write_whole
    from lyapcheck.cli.values import gains_on_arm, require_joints
    from lyapcheck.export.controller import Sampling
    from lyapcheck.verdicts import Exit

    wrong = Complaints()
    hertz = wrong.reading(_rate, rate)
    taps = wrong.reading(_taps, filter)
    gain_file, _, model = wrong.result(gains_on_arm, file, robot)
    assert hertz is not None
    assert taps is not None
    require_joints([gain_file], model)
    if out is None:
        raise argument_error("--out", "", "is missing", "name a folder: --out controller")
    from lyapcheck.answers.export import export

    answer = export(gain_file, model, Sampling(1 / hertz, taps, wrapped, hold_samples), robot)
    files = {name: text for one in answer.sets for name, text in one.files.items()}
    folder = open_folder("--out", out)
    others = [folder / name for name, text in files.items() if not _free(folder / name, text)]
    if others:
        rule, repair = "is there already, with other content", "name another folder, or move it away"
        raise InputError([Problem("argument", None, "--out", str(path), rule, repair) for path in others])
    for name, text in files.items():
        write_whole(folder / name, text)
    show(answer, format)
    return Exit.PROVED


def _free(path: Path, text: str) -> bool:
    """Whether nothing else is lost where this is written."""
    return not path.exists() or (path.is_file() and path.read_bytes() == text.encode())


def _rate(text: str | None) -> Fraction:
    value = parse_decimal("--rate", text)
    if value is None:
        rule = "is missing: NAME_step divides differences by its period"
        raise argument_error("--rate", "", rule, "write --rate 1000, in Hz")
    if not SLOWEST <= value <= FASTEST:
        rule = f"must be from {SLOWEST} to {FASTEST} Hz"
        raise argument_error("--rate", text, rule, "write --rate 1000")
    return value


def _taps(text: str) -> tuple[Fraction, ...]:
    values = parse_decimals("--filter", text) or ()
    if len(values) > MOST_TAPS or max(map(abs, values)) > LARGEST_TAP:
        rule = f"must be up to {MOST_TAPS} weights of up to {LARGEST_TAP}"
        raise argument_error("--filter", text, rule, "write --filter 0.5,0.5")
    if sum(values) != 1:
        rule = f"has the sum {float(sum(values)):.6g}, and rates would be scaled by it"
        raise argument_error("--filter", text, rule, "give weights whose sum is 1: --filter 0.5,0.5")
    return values
