"""``lyapcheck bounds``."""

from __future__ import annotations

import math
from functools import partial
from pathlib import Path
from typing import TYPE_CHECKING

from lyapcheck._types import part
from lyapcheck.cli.show import certificate_folder, progress, show, write_certificates
from lyapcheck.cli.task import task_of
from lyapcheck.cli.values import Complaints, gains_on_arm, loop_of, parse_decimals, require_joints, varies
from lyapcheck.errors import argument_error
from lyapcheck.verdicts import Exit

if TYPE_CHECKING:
    from fractions import Fraction

    from lyapcheck.cli.parser import Parser
    from lyapcheck.robots import RobotModel

MOST_TORQUE = 1e6


def arguments(parser: Parser) -> None:
    """What the command takes."""
    parser.add_argument("file", metavar="FILE", type=Path, help="A gain file of bounded controllers.")
    parser.add_robot()
    parser.add_vary()
    parser.add_loop(("unknown_payload", "gravity_error"))
    about = "Goal in degrees, one angle per joint. Default: 45 each, or 45,45,90 for three joints."
    parser.add_argument("--target", metavar="ANGLES", help=about)
    parser.add_argument("--start", metavar="ANGLES", help="Initial joint angles in degrees. Default: 0.")
    parser.add_number("--delta", float, "Error in degrees for the simulated time.", default=1.0)
    about = "Largest dry friction of each joint, in N·m. Default: from the arm file."
    parser.add_argument("--friction", metavar="TORQUES", help=about)
    parser.add_number("--time", float, "Duration of the simulated runs, in s.", default=10.0)
    parser.add_certificates()
    parser.add_format()


def run(
    file: Path,
    robot: str | None,
    vary: list[str] | None,
    target: str | None,
    start: str | None,
    delta: float,
    friction: str | None,
    time: float,
    certificates: Path | None,
    format: str,  # noqa: A002
    **loop: str | None,
) -> Exit:
    """Bound the error that dry friction leaves at rest, joint by joint, with proof.

    The bounds hold at every state of rest, for dry friction up to the number in the arm file or in
    --friction. With --vary they hold for every arm in the ranges. A simulated run is printed for comparison.

    Gravity that the controller does not know, by [loop] or options, counts like dry friction.

    Exit code 0: each joint has a proved bound, 1: a joint falls, 2: unusable input, 3: a joint has no bound.

    Examples:
      lyapcheck bounds gains.toml --certificates proof/
      lyapcheck bounds gains.toml --friction 3,2,0.5
      lyapcheck bounds gains.toml --vary coulomb=-10%..+20%
    """
    from lyapcheck.answers.bounds import Comparisons, compare
    from lyapcheck.answers.bounds import certificates as certificates_of
    from lyapcheck.control.sampling import record_of
    from lyapcheck.robots import load

    gain_file, name, model = gains_on_arm(file, robot)
    ranges, record = varies(vary), record_of(loop_of(loop), gain_file.loop, model.loop)
    varied = load(name, vary=ranges) if ranges else None
    require_joints([gain_file], model)
    wrong = Complaints()
    angle = wrong.reading(_angle, delta) or 0.0
    dry = None if friction is None else wrong.reading(_torques, friction, model)
    task = wrong.result(task_of, model, target, start, time)
    folder = certificate_folder(certificates)
    count, result = len(gain_file.gains), []
    asked = partial(compare, motors=gain_file.bounds.torque, varied=varied, record=record)
    with progress("bounds") as advance:
        for done, one in enumerate(gain_file.gains):
            told = part(advance, done / count, (done + 1) / count, f"{one.name}: ")
            result.append(asked(one, model, task, angle, dry, on_progress=told))
    if folder is not None:
        write_certificates(folder, *map(certificates_of, result))
    show(Comparisons(tuple(result), gain_file, name), format)
    if any(one.falls for one in result):
        return Exit.REFUTED
    return Exit.PROVED if all(one.proved for one in result) else Exit.UNDECIDED


def _angle(delta: float) -> float:
    """The error to come below, in rad."""
    if not 0.0 < delta <= 180.0:
        rule = "must be more than 0 and at most 180 degrees"
        raise argument_error("--delta", f"{delta:g}", rule, "write --delta 1")
    return math.nextafter(math.radians(delta), 0.0)


def _torques(text: str, model: RobotModel) -> tuple[Fraction, ...]:
    """Torques in N·m, one a joint and none below 0."""
    option = "--friction"
    values = parse_decimals(option, text) or ()
    if len(values) != model.n or not all(0 <= value <= MOST_TORQUE for value in values):
        rule = f"must be {model.n} torques from 0 to {MOST_TORQUE:g} N·m"
        raise argument_error(option, text, rule, f"write {option} {','.join(['0.1'] * model.n)}")
    return values
