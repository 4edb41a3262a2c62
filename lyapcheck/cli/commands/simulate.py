"""``lyapcheck simulate``."""

from __future__ import annotations

import math
import sys
from collections.abc import Callable
from functools import partial
from pathlib import Path
from typing import TYPE_CHECKING, Any

from lyapcheck.cli.parser import LOOP
from lyapcheck.cli.show import (
    certificate_folder,
    open_folder,
    progress,
    require_writable,
    show,
    write_certificates,
    write_data,
    write_whole,
)
from lyapcheck.cli.task import (
    BAND,
    CERTIFIED,
    bench_of,
    check_options,
    eps0_of,
    request_of,
    starts_of,
    task_of,
)
from lyapcheck.cli.values import Complaints, gains_on_arm, varies
from lyapcheck.files.fields import file_stem
from lyapcheck.verdicts import Exit

if TYPE_CHECKING:
    from lyapcheck.answers.simulate import Simulation
    from lyapcheck.cli.parser import Parser
    from lyapcheck.control.conditions import Check
    from lyapcheck.control.gains import GainFile
    from lyapcheck.robots import RobotModel
    from lyapcheck.simulate.bench import Bench
    from lyapcheck.simulate.many import Starts
    from lyapcheck.simulate.reference import Reference
    from lyapcheck.simulate.run import Motion
    from lyapcheck.simulate.task import Task


OF_LOOP = tuple(name for name in LOOP if name not in ("velocity", "within"))
"""Options of the loop; these two have other meanings here."""


def way_of(
    task: Task, path: Reference | None, starts: Starts | None, bench: Bench | None, band: float, stop: bool
) -> tuple[Callable[..., Any], type[Simulation[Any]], Callable[[Any], str]]:
    """What simulates a gain set on an arm, the answer that takes the results, and their samples as CSV."""
    from lyapcheck.answers.simulate import runs_csv
    from lyapcheck.answers.simulate.runs import SetPointRuns
    from lyapcheck.answers.simulate.starts import RandomStarts, starts_csv
    from lyapcheck.answers.simulate.tracking import TrackingRuns
    from lyapcheck.simulate.closed_loop import simulate
    from lyapcheck.simulate.many import sweep
    from lyapcheck.simulate.tracking import track
    from lyapcheck.simulate.trial import experiment

    if starts is not None:
        return partial(sweep, task=task, starts=starts), RandomStarts, starts_csv
    way: dict[str, Any] = {"start_rad": task.q0, "velocity_rad": task.w0, "T": task.T}
    if path is not None:
        return partial(track, reference=path, band_rad=band, stop=stop, **way), TrackingRuns, runs_csv
    if bench is not None:
        return partial(experiment, target_rad=task.q_d, bench=bench, **way), SetPointRuns, runs_csv
    return partial(simulate, target_rad=task.q_d, stop=stop, **way), SetPointRuns, runs_csv


def plot_run(run: Motion, place: Path) -> None:
    """The samples of a run, and as figures its errors, torques and V; of a tracking run also its angles."""
    from lyapcheck.answers.simulate import runs_csv
    from lyapcheck.report.plots import drawn, png, svg

    stem = file_stem(run.name)
    write_whole(place / f"{stem}.csv", runs_csv([run]))
    for name, figure in drawn(f"{run.name} on {run.robot}, {run.kind}", run).items():
        write_whole(place / f"{stem}-{name}.svg", svg(figure))
        write_whole(place / f"{stem}-{name}.png", png(figure))


def arguments(parser: Parser) -> None:
    """What the command takes."""
    parser.add_gain_file()
    parser.add_robot()
    about = "Run as on the paper's bench, at 2.5 ms without delay, with encoders and dry friction."
    parser.add_argument("--experiment", action="store_true", help=about)
    parser.add_loop(OF_LOOP)
    about = "Follow the trajectory in this reference file by (21), instead of a goal."
    parser.add_argument("--reference", metavar="FILE", type=Path, help=about)
    parser.add_number("--time", float, "Duration in s. Default: 5, or the length of the reference.")
    about = "Goal in degrees, one angle per joint. Default: 45 each, or 45,45,90 for three joints."
    parser.add_argument("--target", metavar="ANGLES", help=about)
    parser.add_argument("--start", metavar="ANGLES", help="Initial joint angles in degrees. Default: 0.")
    about = "Initial joint velocities in degrees per second. Default: 0."
    parser.add_argument("--velocity", metavar="RATES", help=about)
    about = (
        "ε₀ of V, a number or 'certified', which takes a while. Default: 0, and V is the energy. "
        "With --reference, half of the ε₀ that is proved for (21)."
    )
    parser.add_argument("--eps0", metavar="N", help=about)
    about = "With --reference, report when all errors are within this many degrees. Default: 1."
    parser.add_number("--band", float, about)
    parser.add_number("--runs", int, "Number of runs from random starts.")
    parser.add_number(
        "--spread", float, "With --runs, largest distance of a start from --start, in degrees. Default: 45."
    )
    parser.add_number("--seed", int, "Seed of the random starts. Default: 0.")
    parser.add_vary()
    about = "Continue after a violated bound instead of stopping."
    parser.add_argument("--keep-going", action="store_true", help=about)
    about = "Write all samples to this file. - is standard output."
    parser.add_argument("--csv", metavar="FILE", help=about)
    about = "Draw figures into this folder, as SVG and PNG, with their data as CSV."
    parser.add_argument("--plot", metavar="DIR", type=Path, help=about)
    parser.add_certificates("Write a certificate of each state at which V rises to this folder")
    parser.add_format()


def run(
    file: Path,
    robot: str | None,
    csv: str | None,
    plot: Path | None,
    certificates: Path | None,
    format: str,  # noqa: A002
    **options: Any,
) -> Exit:
    """Simulate the closed loop of every gain set in FILE and report its performance.

    The answer has the L2 index, settling time, overshoot and peak torque relative to the limit. These are
    observations in floating point, never proofs. A run of (11) stops at the first state that violates a
    bound. V must fall, ‖τ‖ must stay below (9), and every motor within its limit. With --rate, --experiment
    or [loop] in a file, the loop runs as on a computer. It is sampled and late, with encoders, dry friction
    and unknown payload.

    Exit code 0: all runs are finished, 1: a violated bound is confirmed in interval arithmetic, or a sampled
    run shows a limit cycle or a falling payload, 2: unusable input, 3: a run could not be finished, and its
    part is written and marked.

    Examples:
      lyapcheck simulate gains.toml --experiment --plot figures/
      lyapcheck simulate gains.toml --rate 1000 --delay 1 --unknown-payload 2
      lyapcheck simulate gains.toml --target 30,-45,60 --csv run.csv
      lyapcheck simulate gains.toml --runs 1000 --spread 90
      lyapcheck simulate gains.toml --vary viscous=-30%..+0%
      lyapcheck simulate gains.toml --eps0 1 --certificates breaches/
    """
    from lyapcheck.answers.simulate.moved import moved, on_arms
    from lyapcheck.answers.simulate.runs import SetPointRuns, breach_certificate
    from lyapcheck.robots import load
    from lyapcheck.robots.vary import corners, outside
    from lyapcheck.simulate.reference import read_reference

    gain_file, name, model = gains_on_arm(file, robot)
    wrong, model = Complaints(), model.with_motors(gain_file.bounds.torque)
    eps0, certified = wrong.reading(eps0_of, options["eps0"]), options["eps0"] == CERTIFIED
    start, velocity, time = (options[key] for key in ("start", "velocity", "time"))
    band = math.radians(BAND if options["band"] is None else options["band"])
    loop = {key: options[key] for key in OF_LOOP}
    written = {"plot": plot, "certificates": certificates, **options}
    given = [
        f"--{key.replace('_', '-')}"
        for key, value in written.items()
        if value not in (None, False) and (key in OF_LOOP or key not in LOOP)
    ]
    wrong.reading(check_options, given)
    if csv is not None and csv != "-":
        wrong.reading(require_writable, "--csv", Path(csv))
    if plot is not None:
        wrong.reading(open_folder, "--plot", plot)
    bench = wrong.reading(bench_of, loop, options["experiment"], gain_file, model)
    ranges = wrong.reading(varies, options["vary"]) or ()
    starts = path = task = None
    if options["runs"] is not None:
        starts = wrong.reading(starts_of, options["runs"], options["spread"], options["seed"])
    if options["reference"] is None:
        task = wrong.reading(task_of, model, options["target"], start, time, eps0, velocity)
    else:
        path = wrong.reading(read_reference, options["reference"], model.n)
        task = wrong.reading(request_of, model, path, start, velocity, time, eps0, band, certified)
    wrong.raise_all()
    ranged = load(name, vary=ranges).with_motors(gain_file.bounds.torque) if ranges else model
    corner_text, others = corners(ranged) if ranges else ("", ())
    where = ", which lies outside the ranges," if outside(model, ranged) else ""
    arms = f"the arm of the file{where} and {corner_text}" if ranges else ""
    folder, cases = certificate_folder(certificates), on_arms(gain_file.gains, model, others)
    assert task is not None
    move, kind, samples = way_of(task, path, starts, bench, band, not options["keep_going"])
    watched = eps0 if path is not None else eps0 or 0.0
    with progress("simulate") as advance:
        results, left = moved(cases, move, watched, model if certified else None, advance)
        if folder is not None:
            tried = [] if bench else list(zip(results, cases, strict=True))
            broken = {one.name: breach_certificate(one, *case) for one, case in tried}
            made = {f"{file_stem(key)}.breach.json": one for key, one in broken.items() if one is not None}
            write_certificates(folder, made)
        known: dict[str, Any] = {"unsampled": bench is not None}
        if kind is SetPointRuns:
            judged = {} if bench is None or ranges else judged_as_run(gain_file, model, bench)
            known = {"arms": arms, "judged": judged}
        answer = kind(tuple(results), tuple(left), gain_file, robot=name, **known)
        return told(answer, samples, csv, plot, format)


def judged_as_run(file: GainFile, model: RobotModel, bench: Bench) -> dict[str, tuple[Check, ...]]:
    """What the checker says of each gain set on a computer."""
    from lyapcheck.answers.gate.judge import judged_sets
    from lyapcheck.answers.running import runs_of
    from lyapcheck.control.limits import model_limits

    limits = {model.name: model_limits(model)}
    results = judged_sets(file, model.name, arms=limits, explained=0, loop=bench.entry)
    return {result.name: runs_of(result) for result in results}


def told(
    answer: Simulation[Any],
    samples: Callable[[Any], str],
    csv: str | None,
    plot: Path | None,
    format: str,  # noqa: A002
) -> Exit:
    """Write figures, and samples or the answer; what went wrong goes to standard error."""
    for run in answer.results if plot is not None else ():
        plot_run(run, plot or Path())
    if csv is not None and csv != "-":
        write_whole(Path(csv), samples(answer.results))
    if csv == "-":
        write_data(samples(answer.results))
    else:
        show(answer, format)
    for sentence in answer.complaints():
        print(sentence, file=sys.stderr)
    return answer.exit_code
