"""The task of the command line: from where, to where, for how long."""

from __future__ import annotations

from dataclasses import replace
from typing import TYPE_CHECKING

from lyapcheck.cli.angles import parse_angles
from lyapcheck.errors import InputError, Problem

if TYPE_CHECKING:
    from lyapcheck.robots import RobotModel
    from lyapcheck.simulate import Task

_OPTIONS = {"T": "--time", "eps0": "--eps0"}


def task_of(
    model: RobotModel, target: str | None, start: str | None, time: float, eps0: float | None = None
) -> Task:
    """The task that the options ask for, at rest at the start.

    Raises:
        InputError: every problem with it at once.
    """
    from lyapcheck.simulate.task import task_for

    problems: list[Problem] = []
    q_d = _angles("--target", _goal(target, model, problems), model, problems)
    q0 = _angles("--start", _home(model) if start is None else start, model, problems)
    try:
        task = task_for(model.n, q_d, q0, None, time, eps0=eps0)
    except InputError as error:
        problems += [replace(problem, key=_OPTIONS[problem.key]) for problem in error.problems]
    if problems:
        raise InputError(problems)
    return task


def _angles(option: str, text: str, model: RobotModel, problems: list[Problem]) -> tuple[float, ...]:
    try:
        return parse_angles(option, text, model.joints)
    except InputError as error:
        problems += error.problems
        return (0.0,) * model.n


def _goal(target: str | None, model: RobotModel, problems: list[Problem]) -> str:
    """What was asked for, or the published goal, which only an arm of three joints has."""
    if target is None and model.n != 3:
        rule = f"is missing, and the paper's goal is for 3 joints where {model.name} has {model.n}"
        repair = f"write --target {','.join(['45'] * model.n)}"
        problems.append(Problem("argument", None, "--target", "", rule, repair))
        return _home(model)
    return "45,45,90" if target is None else target


def _home(model: RobotModel) -> str:
    return ",".join(["0"] * model.n)
