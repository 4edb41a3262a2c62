"""The task of the command line: from where, to where, for how long, with which ε₀."""

from __future__ import annotations

import math
import sys
from collections.abc import Callable, Collection, Mapping
from dataclasses import replace
from functools import partial
from typing import TYPE_CHECKING, TypeVar

from lyapcheck.cli.parser import LOOP
from lyapcheck.cli.values import Complaints, loop_of
from lyapcheck.errors import InputError, argument_error, argument_problem

if TYPE_CHECKING:
    from lyapcheck.control.gains import GainFile
    from lyapcheck.robots import RobotModel
    from lyapcheck.simulate.bench import Bench
    from lyapcheck.simulate.many import Starts
    from lyapcheck.simulate.reference import Reference
    from lyapcheck.simulate.task import Task

MOST_DEGREES = 36_000.0
"""A hundred turns of a joint."""
CERTIFIED = "certified"
MAX_BOXES = 100_000
"""Budget of branch and bound for one gain set; ``lyapcheck epsilon`` goes further."""
Made = TypeVar("Made")
SECONDS = 5.0
"""Duration of a set-point task, as in the paper."""
SMALL, TURN = 2.0, 360.0
"""Degrees; goals below or beyond look like radians or a slip."""
SPREAD = 45.0
"""Degrees."""
BAND = 1.0
"""Degrees."""
_OPTIONS = {
    "T": "--time",
    "eps0": "--eps0",
    "band_rad": "--band",
    "reference": "--reference",
    "velocity_rad": "--velocity",
    "start_rad": "--start",
    "target_rad": "--target",
}
_NEEDS = {"--spread": "--runs", "--seed": "--runs", "--band": "--reference"}
_CLASHES = (
    ("--reference", "--experiment"),
    ("--reference", "--runs"),
    ("--reference", "--target"),
    ("--runs", "--experiment"),
    *((name, f"--{key.replace('_', '-')}") for name in ("--runs", "--reference") for key in LOOP),
    ("--runs", "--keep-going"),
    ("--runs", "--plot"),
    ("--runs", "--vary"),
    ("--reference", "--vary"),
    ("--experiment", "--keep-going"),
    ("--experiment", "--certificates"),
    ("--reference", "--certificates"),
    ("--runs", "--certificates"),
)


def parse_angles(option: str, text: str, joints: tuple[str, ...]) -> tuple[float, ...]:
    """The angles in rad, one a joint.

    Raises:
        InputError: something that is not a number of degrees, or another number of angles than joints.
    """
    words = [word.strip() for word in text.split(",")] if text.strip() else []
    example = f"write {option} {','.join(['45'] * len(joints))}"
    if len(words) != len(joints):
        many = "number" if len(words) == 1 else "numbers"
        rule = f"has {len(words)} {many}, but the arm has {len(joints)} joints ({', '.join(joints)})"
        raise argument_error(option, text, rule, example)
    degrees = [_degrees(word) for word in words]
    if any(math.isnan(angle) for angle in degrees):
        rule = f"each must be a number from {-MOST_DEGREES:g} to {MOST_DEGREES:g} degrees"
        raise argument_error(option, text, rule, example)
    return tuple(math.radians(angle) for angle in degrees)


def _degrees(word: str) -> float:
    """The number, NaN if it is none or out of range."""
    try:
        angle = float(word)
    except ValueError:
        return math.nan
    return angle if abs(angle) <= MOST_DEGREES else math.nan


def eps0_of(text: str | None) -> float | None:
    """The number that ``--eps0`` asks for; ``None`` where it asks for none, or for `CERTIFIED`.

    Raises:
        InputError: neither a number nor ``certified``; a number out of range is refused with its task.
    """
    if text is None or text == CERTIFIED:
        return None
    try:
        number = float(text)
    except ValueError:
        number = math.nan
    if math.isnan(number):
        rule = f"must be a number or {CERTIFIED}"
        raise argument_error("--eps0", text, rule, f"write --eps0 0.01, or --eps0 {CERTIFIED}")
    return number


def task_of(
    model: RobotModel,
    target: str | None,
    start: str | None,
    time: float | None,
    eps0: float | None = None,
    velocity: str | None = None,
) -> Task:
    """The task that the options ask for.

    Raises:
        InputError: every problem with it at once.
    """
    from lyapcheck.simulate.task import task_for

    wrong = Complaints()
    q_d = wrong.reading(_goal, target, model) or (0.0,) * model.n
    q0, w0 = _begin(wrong, model, start, velocity)
    seconds = SECONDS if time is None else time
    return wrong.result(_by_options(partial(task_for, model.n, q_d, q0, w0, seconds, eps0=eps0)))


def request_of(
    model: RobotModel,
    reference: Reference | None,
    start: str | None,
    velocity: str | None,
    time: float | None,
    eps0: float | None,
    band: float,
    certified: bool,
) -> Task:
    """The task along a reference that the options ask for; without one only its problems count.

    Raises:
        InputError: every problem with it at once.
    """
    from lyapcheck.simulate.tracking import request_for

    wrong = Complaints()
    if certified:
        repair = "leave --eps0 out: one that is proved for (21) is taken"
        rule = "is for tasks without --reference"
        wrong.problems.append(argument_problem("--eps0", CERTIFIED, rule, repair))
    q0, rates = _begin(wrong, model, start, velocity)
    made = partial(request_for, model.n, reference, q0, rates, time, eps0=eps0, band=band)
    return wrong.result(_by_options(made))


def bench_of(
    options: Mapping[str, str | None], experiment: bool, file: GainFile, model: RobotModel
) -> Bench | None:
    """How the loop is run: by options, else the published experiment, else the gain file, else the arm file.

    Returns:
        ``None`` where nothing is said of it: at an infinite rate.

    Raises:
        InputError: an option that cannot be used; an unknown payload on an arm whose links are not known.
    """
    from lyapcheck.control.sampling import record_of
    from lyapcheck.files.loop import NOTHING, LoopEntry
    from lyapcheck.simulate.bench import Bench

    published = LoopEntry(period=Bench().period, delay=0) if experiment else NOTHING
    record = record_of(loop_of(options).over(published), file.loop, model.loop)
    bench = None if record is None else Bench.of(record)
    if bench is not None:
        bench.carried(model)
    return bench


def starts_of(runs: int, spread: float | None, seed: int | None) -> Starts:
    """The random starts that the options ask for.

    Raises:
        InputError: every problem with them at once.
    """
    from lyapcheck.simulate.many import MOST_RUNS, Starts

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


def _begin(
    wrong: Complaints, model: RobotModel, start: str | None, velocity: str | None
) -> list[tuple[float, ...]]:
    """Angles and rates at the beginning; 0 where nothing is said, or nothing that can be read."""
    rest = (0.0,) * model.n
    given = (("--start", start), ("--velocity", velocity))
    return [
        rest if text is None else wrong.reading(parse_angles, option, text, model.joints) or rest
        for option, text in given
    ]


def _by_options(make: Callable[[], Made]) -> Callable[[], Made]:
    """The same, with its problems under the names of options."""

    def made() -> Made:
        try:
            return make()
        except InputError as error:
            raise InputError([replace(one, key=_OPTIONS[one.key]) for one in error.problems]) from None

    return made


def _goal(target: str | None, model: RobotModel) -> tuple[float, ...]:
    """What was asked for, or the published goal for an arm of three joints, 45° for each joint of others."""
    default = "45,45,90" if model.n == 3 else ",".join(["45"] * model.n)
    goal = parse_angles("--target", default if target is None else target, model.joints)
    farthest = math.degrees(max(map(abs, goal)))
    if 0 < farthest < SMALL or farthest >= TURN:
        print(f"note: --target is in degrees, and goes {farthest:.4g}° at most", file=sys.stderr)
    return goal
