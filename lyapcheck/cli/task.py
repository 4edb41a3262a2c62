"""The task of the command line: from where, to where, for how long, with which ε₀."""

from __future__ import annotations

import math
import sys
from collections.abc import Collection, Mapping
from typing import TYPE_CHECKING

from lyapcheck.cli.parser import LOOP
from lyapcheck.cli.values import Complaints, loop_of
from lyapcheck.errors import InputError, argument_error, argument_problem, told_as

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
    *((f"--{key.replace('_', '-')}", "--keep-going") for key in ("experiment", *LOOP)),
    *((f"--{key.replace('_', '-')}", "--certificates") for key in ("experiment", *LOOP)),
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
    degrees = [_number(word) for word in words]
    if not all(abs(angle) <= MOST_DEGREES for angle in degrees):  # which no NaN is
        rule = f"each must be a number from {-MOST_DEGREES:g} to {MOST_DEGREES:g} degrees"
        raise argument_error(option, text, rule, example)
    return tuple(math.radians(angle) for angle in degrees)


def _number(word: str) -> float:
    """NaN where it is none."""
    try:
        return float(word)
    except ValueError:
        return math.nan


def eps0_of(text: str | None) -> float | None:
    """The number that ``--eps0`` asks for; ``None`` where it asks for none, or for `CERTIFIED`.

    Raises:
        InputError: neither a number nor ``certified``; a number out of range is refused with its task.
    """
    if text is None or text == CERTIFIED:
        return None
    number = _number(text)
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
    goal: str = "--target",
) -> Task:
    """The task that the options ask for; ``goal`` is the name of the one with the target.

    Raises:
        InputError: every problem with it at once.
    """
    from lyapcheck.simulate.task import task_for

    wrong = Complaints()
    q_d = wrong.reading(_target, goal, target, model) or (0.0,) * model.n
    q0, w0 = _begin(wrong, model, start, velocity)
    seconds = SECONDS if time is None else time
    with told_as(_OPTIONS | {"target_rad": goal}):
        return wrong.result(task_for, model.n, q_d, q0, w0, seconds, eps0=eps0)


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
    with told_as(_OPTIONS):
        return wrong.result(request_for, model.n, reference, q0, rates, time, eps0=eps0, band=band)


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

    size, number = SPREAD if spread is None else spread, 0 if seed is None else seed
    refused = [
        ("--runs", runs, 1 <= runs <= MOST_RUNS, f"must be from 1 to {MOST_RUNS}", "1000"),
        ("--spread", size, 0.0 <= size <= 360.0, "must be from 0 to 360 degrees", "45"),
        ("--seed", number, number >= 0, "must not be negative", "0"),
    ]
    problems = [
        argument_problem(name, value, rule, f"write {name} {good}")
        for name, value, fits, rule, good in refused
        if not fits
    ]
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


def _target(option: str, text: str | None, model: RobotModel) -> tuple[float, ...]:
    """What was asked for, or the published goal for an arm of three joints, 45° for each joint of others."""
    default = "45,45,90" if model.n == 3 else ",".join(["45"] * model.n)
    goal = parse_angles(option, default if text is None else text, model.joints)
    farthest = math.degrees(max(map(abs, goal)))
    if 0 < farthest < SMALL or farthest >= TURN:
        print(f"note: {option} is in degrees, and goes {farthest:.4g}° at most", file=sys.stderr)
    return goal
