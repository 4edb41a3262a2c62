"""One file or folder a question that users ask; each answer is ready for every format of ``output``.

Here is what they share: the one line about the assumptions of an arm, and an arm as words of a command line.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

from lyapcheck.files.decimals import decimal_text
from lyapcheck.output.document import command
from lyapcheck.robots.choice import split

if TYPE_CHECKING:
    from lyapcheck.control.gains import Bounds, GainFile
    from lyapcheck.robots import RobotModel


def arm_words(robot: str) -> list[str]:
    """The arm as words of a command line: its name or path, then options for the part that is chosen."""
    path, choice = split(robot)
    words = [path]
    for option, value in (("--base", choice.base), ("--tip", choice.tip)):
        words += [option, value] if value else []
    for joint, place in choice.fixed.items():
        words += ["--fixed", f"{joint}={decimal_text(place)}"]
    for name, text in choice.xacro.items():
        words += ["--xacro", f"{name}:={text}"]
    return words


def file_words(file: GainFile, robot: str) -> list[str]:
    """A gain file as words of a command line, with the arm if the file names another."""
    return [file.path, *([] if robot in ("", file.robot) else ["--robot", *arm_words(robot)])]


def bounds_words(bounds: Bounds) -> list[str]:
    """``[bounds]`` of a gain file as words for ``tune``."""
    friction = bounds.viscous_min and (bounds.viscous_min,)
    rows = (("--torque", bounds.torque), ("--gravity", bounds.gravity), ("--viscous-min", friction))
    return [word for name, row in rows if row for word in (name, ",".join(map(decimal_text, row)))]


def assumed_line(model: RobotModel, robot: str) -> str:
    """How many numbers of the arm are assumed, and the command that lists all assumptions.

    Args:
        model: the arm.
        robot: its name or path, as a file or an option gives it.
    """
    count = sum(number.assumed for number in model.numbers.values())
    listed = f": {command('robot', *arm_words(robot), '--assumptions')}" if model.assumptions else ""
    if not count:
        return f"no number of this arm is assumed{'; other assumptions' if listed else ''}{listed}"
    verb = "is" if count == 1 else "are"
    return f"{count} of {len(model.numbers)} numbers of this arm {verb} assumed{listed}"
