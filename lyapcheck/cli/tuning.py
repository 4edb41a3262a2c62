"""What the options of ``lyapcheck tune`` ask for."""

from __future__ import annotations

from dataclasses import replace
from fractions import Fraction
from pathlib import Path
from typing import TYPE_CHECKING

from lyapcheck.cli.complaints import Complaints
from lyapcheck.cli.decimals import parse_decimal, parse_decimals
from lyapcheck.errors import InputError, argument_error

if TYPE_CHECKING:
    from lyapcheck.answers.tune.response.trial import Trials
    from lyapcheck.answers.tune.targets import Targets
    from lyapcheck.control.gains import Bounds, GainFile
    from lyapcheck.simulate.task import Task

PAPERS_ARM, PAPERS_GAINS = "buap3", "table2"
ONE = (Fraction(1),)


def trials_of(
    robot: str,
    wishes: dict[str, float],
    peak_share: str,
    motion: tuple[str | None, list[str] | None],
    ways: tuple[str, ...],
    digits: int,
) -> Trials:
    """What is asked, and of which motions.

    Raises:
        InputError: a target or an angle that cannot be used.
    """
    from lyapcheck.answers.tune.response.trial import Trials, Wishes
    from lyapcheck.simulate.indices import LEAST_STEP

    tasks = tasks_of(robot, *motion)
    for task, goal in zip(tasks, motion[1] or [""], strict=True):
        if not any(abs(step) >= LEAST_STEP for step in task.step):
            raise argument_error("--goal", goal, "is where the motion starts", "give another goal or --start")
    shares = parse_decimals("--peak-share", peak_share) or ONE
    if len(set(shares)) > 1:
        raise argument_error(
            "--peak-share", peak_share, "is one share with targets", "write --peak-share 0.8"
        )
    share = None if shares[0] == 1 else float(shares[0])
    return Trials(Wishes(**wishes, peak_share=share), tasks, ways, digits)


def tasks_of(robot: str, start: str | None, goals: list[str] | None) -> tuple[Task, ...]:
    """Motions from rest to rest: those asked for, or the paper's, or 45° for each joint.

    Raises:
        InputError: angles that cannot be used.
    """
    from lyapcheck.cli.task import task_of
    from lyapcheck.robots import load

    model = load(robot)
    default = "45,45,90" if robot == PAPERS_ARM else ",".join(["45"] * model.n)
    try:
        return tuple(task_of(model, goal, start, None) for goal in goals or [default])
    except InputError as error:
        problems = [
            replace(
                one, **{part: getattr(one, part).replace("--target", "--goal") for part in ("key", "repair")}
            )
            for one in error.problems
        ]
        raise InputError(problems) from None


def targets_of(
    wrong: Complaints,
    digits: int,
    peak_share: str,
    kv_share: str | None,
    kv_min: str | None,
    damping: str | None,
) -> Targets:
    """The targets given on the command line; those that cannot be read are left at their defaults."""
    from lyapcheck.answers.tune.targets import Targets

    shares = wrong.reading(parse_decimals, "--peak-share", peak_share)
    others = (("--kv-share", kv_share), ("--kv-min", kv_min), ("--damping", damping))
    return Targets(digits, shares or ONE, *(wrong.reading(parse_decimals, *each) for each in others))


def bounds_of(
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


def gains_beside(robot: str, compare: Path | None) -> GainFile | None:
    """The gains to compare with."""
    from lyapcheck.control.gains import read_gain_file
    from lyapcheck.control.paper import paper_gain_file

    if compare is not None:
        return read_gain_file(compare)
    if robot != PAPERS_ARM:
        return None
    return replace(read_gain_file(paper_gain_file(PAPERS_GAINS)), path="the paper's Table 2")
