"""Which arm a command is about, and whether the gains fit it."""

from __future__ import annotations

from collections.abc import Iterable
from typing import TYPE_CHECKING

from lyapcheck.errors import InputError, Problem, argument_error

if TYPE_CHECKING:
    from lyapcheck.control.gains import GainFile
    from lyapcheck.robots import RobotModel


def robot_name(robot: str | None, gain_files: Iterable[GainFile]) -> str:
    """The arm of ``--robot``, else the first that a gain file names.

    Raises:
        InputError: nobody names an arm.
    """
    files = list(gain_files)
    name = robot or next((file.robot for file in files if file.robot), None)
    if name is None:
        rule = f"{', '.join(file.path for file in files)} names no arm and --robot is missing"
        raise argument_error("--robot", "", rule, "add --robot buap3, or robot = … to the file")
    return name


def require_joints(gain_files: Iterable[GainFile], model: RobotModel) -> None:
    """Refuse gains for another number of joints, at the lines where they stand.

    Raises:
        InputError: one problem a gain set.
    """
    problems = []
    for file in gain_files:
        for item in file.gains:
            if item.n != model.n:
                place = file.place(item, "kp")
                rule = f"{item.name} has gains for {item.n} joints, but the arm {model.name} has {model.n}"
                repair = f"choose an arm of {item.n} joints, or give {model.n} gains, one a joint"
                problems.append(Problem(file.path, place.line if place else None, "kp", "", rule, repair))
    if problems:
        raise InputError(problems)
