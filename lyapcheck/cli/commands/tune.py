"""``lyapcheck tune``."""

from __future__ import annotations

import sys
from dataclasses import replace
from fractions import Fraction
from pathlib import Path
from typing import TYPE_CHECKING, Any

from lyapcheck.cli.show import progress, require_writable, show, write_data, write_whole
from lyapcheck.cli.task import starts_of, task_of
from lyapcheck.cli.values import Complaints, loop_of, parse_decimals, parse_m, varies
from lyapcheck.errors import argument_error
from lyapcheck.output.answer import FORMATS
from lyapcheck.verdicts import Exit

if TYPE_CHECKING:
    from lyapcheck.answers.tune.answer import Tuning
    from lyapcheck.answers.tune.bench import BenchTuning
    from lyapcheck.answers.tune.trial import Trials
    from lyapcheck.cli.parser import Parser
    from lyapcheck.robots import RobotModel

PAPERS_ARM = "buap3"
Numbers = tuple[Fraction, ...]
ONE = (Fraction(1),)
MOST_RUNS, MOST_SPREAD = 64, 90.0
"""Random motions, and degrees about their middle."""
WAYS = ("19", "proof")
"""How stability may be shown."""
TARGETS = ("overshoot", "settle", "rest_error")
FOR_LARGEST = ("kv_share", "damping")
"""Options that have a meaning without targets only."""
FOR_TARGETS = ("start", "goal", "best", "runs", "spread", "seed", "quantile", "stability")
"""Options that have a meaning with targets only."""


def arguments(parser: Parser) -> None:
    """What the command takes."""
    parser.add_argument("robot", metavar="ROBOT", help="Arm by name or file (.toml, .urdf).")
    parser.add_choice_of_arm()
    parser.add_members(None, more=" Default: 1:3, and 1 with targets and more than three joints.")
    parser.add_number("--digits", int, "Number of decimal places of the gains.", default=3)
    parser.add_number(
        "--overshoot", float, "Target for the largest overshoot, in percent of the step of a joint."
    )
    parser.add_number("--settle", float, "Target for the settling time to 2 %% of the step, in s.")
    parser.add_number("--rest-error", float, "Target for the error under dry friction, in degrees.")
    about = "Usable share of each torque limit, for example 0.8 or 0.8,0.9,1."
    parser.add_argument("--peak-share", metavar="SHARES", default="1", help=about)
    about = "With targets, start of the motions in degrees. Default: 0."
    parser.add_argument("--start", metavar="ANGLES", help=about)
    about = (
        "With targets, goal of a motion in degrees. May be repeated. Default: the paper's, or 45 per joint."
    )
    parser.add_argument("--goal", metavar="ANGLES", action="append", help=about)
    about = "With targets, number of random motions from rest, in addition to --goal."
    parser.add_number("--runs", int, about)
    parser.add_number(
        "--spread", float, "With --runs, largest distance of a motion from --start, in degrees. Default: 90."
    )
    parser.add_number("--seed", int, "Seed of the random motions. Default: 0.")
    about = "With targets, share of the motions that must meet them, joint by joint. Default: 1."
    parser.add_number("--quantile", float, about)
    about = "With targets, method of the stability proof. Default: both."
    parser.add_choice("--stability", ("both", *WAYS), about)
    about = "Smallest share of the largest k_v under (19). Default: 1."
    parser.add_argument("--kv-share", metavar="SHARES", help=about)
    parser.add_argument("--damping", metavar="RATIOS", help="Lower bound of each joint's damping ratio.")
    parser.add_vary()
    parser.add_loop()
    parser.add_argument("--torque", metavar="TORQUES", help="Torque limits in N·m, instead of the arm's.")
    parser.add_argument("--gravity", metavar="TORQUES", help="Gravity bounds in N·m, instead of the arm's.")
    parser.add_argument("--viscous-min", metavar="N", help="λmin(B) in N·m·s/rad, instead of the arm's.")
    parser.add_argument("--out", metavar="FILE", type=Path, help="Write the gains to this file.")
    about = "With targets, write the best set, marked, if no set meets the targets."
    parser.add_argument("--best", action="store_true", help=about)
    parser.add_format((*FORMATS, "toml"))  # the gain file alone


def run(
    robot: str,
    m: str | None,
    out: Path | None,
    vary: list[str] | None,
    format: str,  # noqa: A002
    **options: Any,
) -> Exit:
    """Find gains for an arm that the gate accepts: the largest gains, or gains that meet targets.

    Without a target, the gains are the largest that meet (10p) and (19), exact to the last digit.

    With --overshoot, --settle or --rest-error, the gains meet the targets in simulated motions from rest to
    rest, and (10i) by proof. The motions run on the arm of the file and at the ends of its assumed numbers.
    The search runs once under (19) and once with a stability proof without (19). With --rate or [loop] in
    the arm file, the motions run as on a computer. Only sets that meet the targets are written, unless
    --best is given.

    Exit code 0: every m has gains, or the targets are met, 2: unusable input, or no gains exist, 3: the
    limits of the arm are not known, or the targets were not reached.

    Examples:
      lyapcheck tune buap3 --m 1:5
      lyapcheck tune buap3 --overshoot 5 --settle 1.5 --rest-error 22 --m 1
      lyapcheck tune arm.toml --overshoot 10 --settle 2 --runs 16 --rate 1000
      lyapcheck tune arm.urdf --peak-share 0.8 --damping 0.7 --out gains.toml
    """
    from lyapcheck.answers.tune import tune
    from lyapcheck.answers.tune.search import tune_for
    from lyapcheck.answers.tune.targets import Targets
    from lyapcheck.control.gains import Bounds
    from lyapcheck.robots import load
    from lyapcheck.robots.dynamics import FEW_JOINTS

    wrong = Complaints()
    if out is not None:
        wrong.reading(require_writable, "--out", out)
    wishes = {name: options[name] for name in TARGETS if options[name] is not None}
    model = wrong.reading(load, robot)
    n = None if model is None else model.n
    # one member of an arm of many joints takes as long as three of a small one
    usual = "1" if wishes and n is not None and n > FEW_JOINTS else "1:3"
    members = wrong.reading(parse_m, m or usual) or ()
    ranges, loop = wrong.reading(varies, vary) or (), wrong.reading(loop_of, options)
    shares = {
        name: wrong.reading(parse_decimals, _option(name), options[name])
        for name in ("peak_share", *FOR_LARGEST)
    }
    targets = Targets(options["digits"], shares.pop("peak_share") or ONE, **shares)
    if n is not None:
        wrong.reading(targets.for_joints, n)
    torques = wrong.reading(_limits, "--torque", options["torque"], n)
    gravities = wrong.reading(_limits, "--gravity", options["gravity"], n)
    friction = wrong.reading(_limits, "--viscous-min", options["viscous_min"], 1)
    bounds = Bounds(friction[0] if friction else None, torques, gravities)
    if wishes:
        wrong.reading(_refuse, options, FOR_LARGEST, "cannot go with targets", "leave one of them out")
        if options["runs"] is None:
            rule, repair = "has a meaning with --runs only", "add --runs"
            wrong.reading(_refuse, options, ("spread", "seed"), rule, repair)
        if model is None:
            wrong.raise_all()
        bench = wrong.result(_trials_of, robot, model, wishes, targets.peak_share, options)
        assert loop is not None
        with progress("tune") as advance:
            found = tune_for(robot, bench, members, bounds, ranges, loop, on_progress=advance)
        found = replace(found, out="" if out is None else str(out), marked=options["best"])
        return _told(found, out, format)
    repair = "add --overshoot, --settle or --rest-error"
    wrong.reading(_refuse, options, FOR_TARGETS, "has a meaning with targets only", repair)
    wrong.raise_all()
    assert loop is not None
    largest = tune(robot, members, targets, bounds, ranges, loop)
    return _told(largest, out if largest.exit == Exit.PROVED else None, format)


def _told(tuning: Tuning | BenchTuning, out: Path | None, format: str) -> Exit:  # noqa: A002
    text = tuning.gain_file(None if out is None else out.parent)
    if out is not None and text:
        write_whole(out, text)
    for line in tuning.unwritten if out is not None or format == "toml" else ():
        print(line, file=sys.stderr)
    if format == "toml":
        write_data(tuning.gain_file())
    else:
        show(tuning, format)
    return tuning.exit


def _trials_of(
    robot: str, model: RobotModel, wishes: dict[str, float], shares: Numbers, options: dict[str, Any]
) -> Trials:
    """What is asked, and of which motions.

    Raises:
        InputError: a target or an angle that cannot be used.
    """
    from lyapcheck.answers.tune.trial import Trials, Wishes
    from lyapcheck.simulate.results import LEAST_STEP

    goals, runs = options["goal"], options["runs"]
    quantile = 1.0 if options["quantile"] is None else options["quantile"]
    if not 0 < quantile <= 1:
        raise argument_error("--quantile", quantile, "must be above 0, up to 1", "write --quantile 0.9")
    default = "45,45,90" if robot == PAPERS_ARM else ",".join(["45"] * model.n)
    tasks = tuple(task_of(model, goal, options["start"], None, goal="--goal") for goal in goals or [default])
    for task, goal in zip(tasks, goals or [""], strict=True):
        if not any(abs(step) >= LEAST_STEP for step in task.step):
            raise argument_error("--goal", goal, "is where the motion starts", "give another goal or --start")
    if len(set(shares)) > 1:
        rule = "is one share with targets"
        raise argument_error("--peak-share", options["peak_share"], rule, "write --peak-share 0.8")
    if runs is not None:
        size = MOST_SPREAD if options["spread"] is None else options["spread"]
        if not 1 <= runs <= MOST_RUNS or not 1 <= size <= MOST_SPREAD:
            rule = f"must be 1 to {MOST_RUNS} motions within 1 to {MOST_SPREAD:g} degrees"
            raise argument_error("--runs", f"{runs} within {size:g}", rule, "write --runs 16 --spread 90")
        pairs = zip(*starts_of(runs, size, options["seed"]).motions(tasks[0].q0), strict=True)
        random = [replace(tasks[0], q0=tuple(a.tolist()), q_d=tuple(b.tolist())) for a, b in pairs]
        tasks = (*(tasks if goals else ()), *random)
    asked = Wishes(**wishes, peak_share=None if shares[0] == 1 else float(shares[0]))
    ways = WAYS if options["stability"] in (None, "both") else (options["stability"],)
    return Trials(asked, tasks, ways, options["digits"], quantile)


def _limits(option: str, text: str | None, n: int | None) -> Numbers | None:
    """The limits that an option gives, as many as joints where that is known; ``None`` where it gives none.

    Raises:
        InputError: the first that is wrong.
    """
    from lyapcheck.files.decimals import decimal_text

    values, alone, may_be_0 = parse_decimals(option, text), option == "--viscous-min", option == "--gravity"
    if values is None:
        return None
    if alone and len(values) != 1:
        raise argument_error(option, text, "must be one number", f"write {option} 0.406")
    if n is not None and len(values) != n:
        rule = f"has {len(values)} value{'s' * (len(values) > 1)} for {n} joint{'s' * (n > 1)}"
        given = ",".join(map(decimal_text, values))
        raise argument_error(option, given, rule, f"give {n}, separated by commas")
    if min(values) < 0 or (min(values) == 0 and not may_be_0):
        rule = "must not be negative" if may_be_0 else "must be positive"
        raise argument_error(option, decimal_text(min(values)), rule, "correct the value")
    return values


def _refuse(options: dict[str, Any], names: tuple[str, ...], rule: str, repair: str) -> None:
    """Refuse options that have no meaning here.

    Raises:
        InputError: the first of them.
    """
    for name in names:
        value = options[name]
        if value not in (None, False):
            shown = value[0] if isinstance(value, list) else "" if value is True else value
            raise argument_error(_option(name), shown, rule, repair)


def _option(name: str) -> str:
    return f"--{name.replace('_', '-')}"
