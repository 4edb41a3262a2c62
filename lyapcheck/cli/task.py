"""The task of the command line: from where, to where, for how long."""

from __future__ import annotations

import math
from collections.abc import Collection
from dataclasses import dataclass, replace
from pathlib import Path
from typing import TYPE_CHECKING

from lyapcheck.cli.angles import parse_angles
from lyapcheck.cli.eps0 import CERTIFIED, Eps0
from lyapcheck.cli.output import open_folder, require_writable
from lyapcheck.errors import InputError, Problem, argument_error, argument_problem

if TYPE_CHECKING:
    from lyapcheck.robots import RobotModel
    from lyapcheck.simulate.starts import Starts
    from lyapcheck.simulate.task import Task
    from lyapcheck.tracking.reference import Reference
    from lyapcheck.tracking.request import TrackingRequest

SECONDS = 5.0
"""Duration of a set-point task, as in the paper."""
SPREAD = 45.0
"""Degrees."""
BAND = 1.0
"""Degrees."""

_OPTIONS = {
    "T": "--time",
    "eps0": "--eps0",
    "band": "--band",
    "reference": "--reference",
    "w0": "--velocity",
    "q0": "--start",
    "q_d": "--target",
}

_NEEDS = {"--spread": "--runs", "--seed": "--runs", "--band": "--reference"}
_CLASHES = (
    ("--reference", "--experiment"),
    ("--reference", "--runs"),
    ("--reference", "--target"),
    ("--runs", "--experiment"),
    ("--runs", "--keep-going"),
    ("--runs", "--plot"),
    ("--runs", "--vary"),
    ("--reference", "--vary"),
    ("--experiment", "--keep-going"),
    ("--experiment", "--certificates"),
    ("--reference", "--certificates"),
    ("--runs", "--certificates"),
)


def task_of(
    model: RobotModel,
    target: str | None,
    start: str | None,
    time: float,
    eps0: float | None = None,
    velocity: str | None = None,
) -> Task:
    """The task that the options ask for.

    Raises:
        InputError: every problem with it at once.
    """
    from lyapcheck.simulate.task import task_for

    problems: list[Problem] = []
    q_d = _angles("--target", _goal(target, model, problems), model, problems)
    q0 = _angles("--start", _home(model) if start is None else start, model, problems)
    w0 = _angles("--velocity", _home(model) if velocity is None else velocity, model, problems)
    try:
        task = task_for(model.n, q_d, q0, w0, time, eps0=eps0)
    except InputError as error:
        problems += [_renamed(problem) for problem in error.problems]
    if problems:
        raise InputError(problems)
    return task


@dataclass(frozen=True)
class TypedTask:
    """What ``lyapcheck simulate`` was asked for, as it was typed."""

    target: str | None
    start: str | None
    velocity: str | None
    time: float | None
    eps0: Eps0

    def task(self, model: RobotModel) -> Task:
        """The set-point task; see `task_of`."""
        time = SECONDS if self.time is None else self.time
        return task_of(model, self.target, self.start, time, self.eps0.number, self.velocity)

    def request(self, model: RobotModel, reference: Reference | None, band: float | None) -> TrackingRequest:
        """The tracking request; without a reference only its problems are of interest.

        Raises:
            InputError: every problem with it at once.
        """
        from lyapcheck.tracking.request import request_for

        problems: list[Problem] = []
        if self.eps0.certified:
            repair = "leave --eps0 out: one that is proved for (21) is taken"
            problems.append(argument_problem("--eps0", CERTIFIED, "is for tasks without --reference", repair))
        number = self.eps0.number
        home = _home(model)
        q0 = _angles("--start", home if self.start is None else self.start, model, problems)
        rates = _angles("--velocity", home if self.velocity is None else self.velocity, model, problems)
        size = math.radians(BAND if band is None else band)
        try:
            request = request_for(model.n, reference, q0, rates, self.time, eps0=number, band=size)
        except InputError as error:
            problems += [_renamed(problem) for problem in error.problems]
        if problems:
            raise InputError(problems)
        return request


def starts_of(runs: int, spread: float | None, seed: int | None) -> Starts:
    """The random starts that the options ask for.

    Raises:
        InputError: every problem with them at once.
    """
    from lyapcheck.simulate.starts import MOST_RUNS, Starts

    problems = []
    size, number = SPREAD if spread is None else spread, 0 if seed is None else seed
    if not 1 <= runs <= MOST_RUNS:
        problems.append(
            argument_problem("--runs", runs, f"must be from 1 to {MOST_RUNS}", "write --runs 1000")
        )
    if not 0.0 <= size <= 360.0:
        problems.append(
            argument_problem("--spread", size, "must be from 0 to 360 degrees", "write --spread 45")
        )
    if number < 0:
        problems.append(argument_problem("--seed", number, "must not be negative", "write --seed 0"))
    if problems:
        raise InputError(problems)
    return Starts(runs, math.radians(size), number)


def check_options(given: Collection[str]) -> None:
    """Refuse options that have no meaning together, or without another one.

    Raises:
        InputError: every such pair.
    """
    problems = [
        argument_problem(name, "", f"has a meaning with {needed} only", f"add {needed}, or leave {name} out")
        for name, needed in _NEEDS.items()
        if name in given and needed not in given
    ]
    problems += [
        argument_problem(second, "", f"cannot go with {first}", "leave one of them out")
        for first, second in _CLASHES
        if first in given and second in given
    ]
    if problems:
        raise InputError(problems)


def check_places(csv: str | None, plot: Path | None) -> None:
    """Refuse places that could not be written to at the end.

    Raises:
        InputError: the first of them.
    """
    if csv is not None and csv != "-":
        require_writable("--csv", Path(csv))
    if plot is not None and not plot.is_dir():
        raise argument_error("--plot", plot, "is not a directory", "create it or name another one")
    if plot is not None:
        open_folder("--plot", plot)


def _renamed(problem: Problem) -> Problem:
    return replace(problem, key=_OPTIONS[problem.key])


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
