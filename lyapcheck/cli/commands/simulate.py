"""``lyapcheck simulate``."""

from __future__ import annotations

import math
import sys
from collections.abc import Callable, Iterator
from dataclasses import dataclass, field, replace
from functools import partial
from pathlib import Path
from typing import TYPE_CHECKING, Any

from lyapcheck._types import Progress
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
    MAX_BOXES,
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
    from lyapcheck.answers.simulate import Simulation, Unfinished
    from lyapcheck.answers.simulate.runs import SetPointRuns
    from lyapcheck.answers.simulate.starts import RandomStarts
    from lyapcheck.answers.simulate.tracking import TrackingRuns
    from lyapcheck.cli.parser import Parser
    from lyapcheck.control.gains import GainFile, GainSet
    from lyapcheck.robots import RobotModel
    from lyapcheck.simulate.bench import Bench
    from lyapcheck.simulate.many import Starts
    from lyapcheck.simulate.reference import Reference
    from lyapcheck.simulate.run import Motion
    from lyapcheck.simulate.task import Task


OF_LOOP = tuple(name for name in LOOP if name not in ("velocity", "within"))
"""Options of the loop; these two have other meanings here."""


@dataclass(frozen=True)
class Job:
    """The gain sets of a file on an arm, and the progress of them all."""

    file: GainFile
    model: RobotModel
    eps0: float | None
    """With which V is watched."""
    certified: bool
    """Whether it is to be certified, for each gain set."""
    advance: Progress
    varied: tuple[tuple[str, RobotModel], ...]
    """The arm at other values of its numbers, each with what was changed."""
    unfinished: list[Unfinished] = field(default_factory=list)

    def each(self) -> Iterator[tuple[GainSet, RobotModel, Progress]]:
        """Each gain set on the arm, and on the arm at other values, with its share of the progress of all."""
        arms = (("", self.model), *self.varied)
        cases = [(one, what, arm) for one in self.file.gains for what, arm in arms]
        for done, (one, what, arm) in enumerate(cases):
            named = replace(one, name=f"{one.name}: {what}") if what else one
            yield named, arm, partial(self._share, done, len(cases), named.name)

    def _share(self, done: int, cases: int, name: str, fraction: float, note: str) -> None:
        self.advance((done + fraction) / cases, note or name)

    def fail(self, gain_set: GainSet, reason: str) -> None:
        """Keep why not all that was asked of a gain set could be found out."""
        from lyapcheck.answers.simulate import Unfinished

        self.unfinished.append(Unfinished(gain_set.name, reason))

    def moved(self, gain_set: GainSet, mover: Callable[[], Any]) -> Any:
        """The run of a gain set, or as much of it as was reached."""
        from lyapcheck.simulate.run import PromiseBroken, SimulationFailed

        try:
            return mover()
        except SimulationFailed as failure:
            if not isinstance(failure, PromiseBroken):
                self.fail(gain_set, failure.reason)
            return failure.partial

    def watching(self, gain_set: GainSet, progress: Progress) -> float:
        """The ε₀ to watch V with, rounded down; 0 where nothing is asked, or none is certified."""
        if not self.certified:
            return self.eps0 or 0.0
        from lyapcheck.answers.epsilon.compute import epsilon
        from lyapcheck.check.numbers.polynomials import Enclosure

        progress(0.0, f"{gain_set.name}: what ε₀ is certified")
        found = epsilon(gain_set, self.model, max_boxes=MAX_BOXES, weights=False).certified
        if found is None:
            name = f"{gain_set.name} on {self.model.name}"
            self.fail(gain_set, f"{name}: no ε₀ is certified, V is watched with ε₀ = 0")
            return 0.0
        return Enclosure(found, found).float_lower


def regulate(
    job: Job, task: Task, bench: Bench | None, stop: bool, arms: str, certificates: Path | None
) -> SetPointRuns:
    """The set-point task, by the equations or as a computer runs it; ``arms`` names all arms in words."""
    from lyapcheck.answers.gate.judge import judged_sets
    from lyapcheck.answers.running import runs_of
    from lyapcheck.answers.simulate.runs import SetPointRuns, breach_certificate
    from lyapcheck.control.limits import model_limits
    from lyapcheck.simulate.closed_loop import simulate
    from lyapcheck.simulate.trial import experiment

    runs, broken = [], {}
    mover = partial(experiment, bench=bench) if bench else partial(simulate, stop=stop)
    way = (task.q_d, task.q0, task.w0, task.T)
    for gain_set, arm, told in job.each():
        number = job.watching(gain_set, told)
        runs.append(job.moved(gain_set, partial(mover, gain_set, arm, *way, eps0=number, on_progress=told)))
        if certificates is not None and bench is None:
            certificate = breach_certificate(runs[-1], gain_set, arm)
            if certificate is not None:
                broken[f"{file_stem(gain_set.name)}.breach.json"] = certificate
    if certificates is not None:
        write_certificates(certificates, broken)
    judged = {}
    if bench is not None and not job.varied:  # what the checker says of each gain set, run like that
        name, limits = job.model.name, {job.model.name: model_limits(job.model)}
        results = judged_sets(job.file, name, arms=limits, explained=0, loop=bench.entry)
        judged = {result.name: runs_of(result) for result in results}
    return SetPointRuns(tuple(runs), tuple(job.unfinished), job.file, arms, judged=judged)


def follow(
    job: Job, reference: Reference, task: Task, band: float, stop: bool, unsampled: bool
) -> TrackingRuns:
    """The tracking scheme (21) along a reference."""
    from lyapcheck.answers.simulate.tracking import TrackingRuns
    from lyapcheck.simulate.tracking import track

    runs = []
    mover = partial(track, eps0=job.eps0, band_rad=band, stop=stop)
    for gain_set, arm, told in job.each():
        way = (gain_set, arm, reference, task.q0, task.w0, task.T)
        runs.append(job.moved(gain_set, partial(mover, *way, on_progress=told)))
    return TrackingRuns(tuple(runs), tuple(job.unfinished), job.file, unsampled=unsampled)


def spread_out(job: Job, task: Task, starts: Starts, unsampled: bool) -> RandomStarts:
    """The set-point task from many random starts."""
    from lyapcheck.answers.simulate.starts import RandomStarts
    from lyapcheck.simulate.many import sweep

    result = []
    for gain_set, arm, told in job.each():
        number = job.watching(gain_set, told)
        result.append(sweep(gain_set, arm, task, starts, eps0=number, on_progress=told))
        if left := starts.count - result[-1].finished:
            job.fail(gain_set, f"{gain_set.name} on {arm.name}: {left} of {starts.count} runs")
    return RandomStarts(tuple(result), tuple(job.unfinished), job.file, unsampled=unsampled)


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
    from lyapcheck.answers.simulate import runs_csv
    from lyapcheck.answers.simulate.starts import starts_csv
    from lyapcheck.robots import load
    from lyapcheck.robots.vary import corners, corners_text, outside
    from lyapcheck.simulate.reference import read_reference

    gain_file, name, model = gains_on_arm(file, robot)
    wrong = Complaints()
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
    ranged = load(name, vary=ranges) if ranges else model
    arms = tuple(corners(ranged, ranges)) if ranges else ()
    where = ", which lies outside the ranges," if outside(model, ranged) else ""
    text = f"the arm of the file{where} and {corners_text(ranged, ranges)}" if ranges else ""
    folder = certificate_folder(certificates)
    assert task is not None
    stop, unsampled = not options["keep_going"], bench is not None
    with progress("simulate") as advance:
        job = Job(gain_file, model, eps0, certified, advance, arms)
        if path is not None:
            return told(follow(job, path, task, band, stop, unsampled), name, runs_csv, csv, plot, format)
        if starts is not None:
            return told(spread_out(job, task, starts, unsampled), name, starts_csv, csv, plot, format)
        return told(regulate(job, task, bench, stop, text, folder), name, runs_csv, csv, plot, format)


def told(
    answer: Simulation[Any],
    robot: str,
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
        show(replace(answer, robot=robot), format)
    for sentence in answer.complaints():
        print(sentence, file=sys.stderr)
    return answer.exit_code
