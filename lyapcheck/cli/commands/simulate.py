"""``lyapcheck simulate``."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING

from lyapcheck.cli.arm import robot_name
from lyapcheck.cli.complaints import Complaints
from lyapcheck.cli.eps0 import Eps0, eps0_of
from lyapcheck.cli.motions import Job, Output, follow, regulate, spread_out
from lyapcheck.cli.options import add_certificates, add_format, add_gain_file, add_robot, add_vary, varies
from lyapcheck.cli.output import open_folder
from lyapcheck.cli.progress import progress
from lyapcheck.cli.task import check_options, check_places, request_of, starts_of, task_of

if TYPE_CHECKING:
    from lyapcheck.cli.parser import Parser
    from lyapcheck.verdicts import Exit


def arguments(parser: Parser) -> None:
    """What the command takes."""
    add_gain_file(parser)
    add_robot(parser)
    about = "As on the bench: hold, encoders, dry friction, torque limits."
    parser.add_argument("--experiment", action="store_true", help=about)
    about = "Follow the trajectory of this reference file under (21), instead of a target."
    parser.add_argument("--reference", metavar="FILE", type=Path, help=about)
    parser.add_number("--time", float, "Duration in s; 5, or the length of the reference.")
    about = "Desired joint angles in degrees; the paper's 45,45,90 on a 3-joint arm."
    parser.add_argument("--target", metavar="ANGLES", help=about)
    parser.add_argument(
        "--start", metavar="ANGLES", help="Initial joint angles in degrees; all 0 if missing."
    )
    about = "Initial joint rates in degrees a second; at rest if missing."
    parser.add_argument("--velocity", metavar="RATES", help=about)
    about = (
        "The ε₀ of V: a number, or 'certified' (takes a while); 0 if missing (V is the energy). "
        "With --reference half of what is proved for (21)."
    )
    parser.add_argument("--eps0", metavar="N", help=about)
    about = "Degrees: with --reference, the time from which on all errors stay inside; 1."
    parser.add_number("--band", float, about)
    parser.add_number("--runs", int, "So many runs from random starts; shows how the indices spread.")
    parser.add_number("--spread", float, "Degrees: with --runs, starts lie so far about --start; 45.")
    parser.add_number("--seed", int, "Of the random starts; 0.")
    add_vary(parser)
    about = "Go on after a broken promise instead of stopping there."
    parser.add_argument("--keep-going", action="store_true", help=about)
    about = "Write all samples to this file; - for standard output."
    parser.add_argument("--csv", metavar="FILE", help=about)
    about = "Draw figures into this directory: SVG, PNG, their data as CSV."
    parser.add_argument("--plot", metavar="DIR", type=Path, help=about)
    add_certificates(parser, "Write a certificate there of each state at which V rises")
    add_format(parser)


def run(
    file: Path,
    robot: str | None,
    experiment: bool,
    reference: Path | None,
    time: float | None,
    target: str | None,
    start: str | None,
    velocity: str | None,
    eps0: str | None,
    band: float | None,
    runs: int | None,
    spread: float | None,
    seed: int | None,
    vary: list[str] | None,
    keep_going: bool,
    csv: str | None,
    plot: Path | None,
    certificates: Path | None,
    format: str,  # noqa: A002
) -> Exit:
    """Simulate the closed loop of every gain set in FILE and report its performance.

    L2 index, settling, overshoot, peak torque against the limit: observations in floating point, never
    proofs. A run by the equations is stopped at the first state that breaks a promise: V falls, ‖τ‖ stays
    below (9), every motor within its limit.

    Exit code 0: all runs are finished, 1: such a state is confirmed in balls, 2: unusable input, 3: a run
    could not be finished; what was reached is written and marked.

    Examples:
      lyapcheck simulate gains.toml --experiment --plot figures/
      lyapcheck simulate gains.toml --target 30,-45,60 --csv run.csv
      lyapcheck simulate gains.toml --runs 1000 --spread 90
      lyapcheck simulate gains.toml --vary viscous=-30%..+0%
      lyapcheck simulate gains.toml --eps0 1 --certificates breaches/
    """
    from lyapcheck.control.gains import arm_named_in, read_gain_file
    from lyapcheck.robots import load
    from lyapcheck.robots.vary import corners, corners_text, outside
    from lyapcheck.tracking.reference import read_reference

    gain_file = read_gain_file(file)
    name = robot_name(robot, [gain_file])
    with arm_named_in(gain_file, robot):
        model = load(name)
    wrong = Complaints()
    watched = wrong.reading(eps0_of, eps0) or Eps0(None)
    given = {
        "--experiment": experiment or None,
        "--reference": reference,
        "--target": target,
        "--band": band,
        "--runs": runs,
        "--spread": spread,
        "--seed": seed,
        "--vary": vary,
        "--keep-going": keep_going or None,
        "--plot": plot,
        "--certificates": certificates,
    }
    wrong.reading(check_options, [name for name, value in given.items() if value is not None])
    wrong.reading(check_places, csv, plot)
    ranges = wrong.reading(varies, vary) or ()
    starts = path = task = request = None
    if runs is not None:
        starts = wrong.reading(starts_of, runs, spread, seed)
    if reference is None:
        task = wrong.reading(task_of, model, target, start, time, watched.number, velocity)
    else:
        path = wrong.reading(read_reference, reference, model.n)
        request = wrong.reading(request_of, model, path, start, velocity, time, watched, band)
    wrong.raise_all()
    ranged = load(name, vary=ranges) if ranges else model
    arms = tuple(corners(ranged, ranges)) if ranges else ()
    where = ", which lies outside the ranges," if outside(model, ranged) else ""
    text = f"the arm of the file{where} and {corners_text(ranged, ranges)}" if ranges else ""
    folder = None if certificates is None else open_folder("--certificates", certificates)
    with progress("simulate") as advance:
        job = Job(gain_file, model, Output(csv, plot, format, folder), advance, varied=arms, arms=text)
        stop = not keep_going
        if path is not None and request is not None:
            code = follow(job, path, request, stop=stop)
        elif task is not None and starts is not None:
            code = spread_out(job, task, starts, eps0=watched)
        elif task is not None:
            code = regulate(job, task, eps0=watched, bench=experiment, stop=stop)
    return code
