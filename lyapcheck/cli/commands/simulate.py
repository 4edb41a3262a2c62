"""``lyapcheck simulate``."""

from __future__ import annotations

import math
import re
import sys
from collections.abc import Callable, Iterator
from dataclasses import dataclass, field, replace
from functools import partial
from pathlib import Path
from typing import TYPE_CHECKING, Any

from lyapcheck._types import Progress
from lyapcheck.cli.progress import progress
from lyapcheck.cli.show import open_folder, require_writable, show, write_certificates, write_whole
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
from lyapcheck.cli.values import (
    LOOP,
    Complaints,
    add_certificates,
    add_format,
    add_gain_file,
    add_loop,
    add_robot,
    add_vary,
    gains_on_arm,
    varies,
)
from lyapcheck.output.escapes import document_text
from lyapcheck.verdicts import Exit

if TYPE_CHECKING:
    from lyapcheck.answers.simulate.simulation import Simulation, Unfinished
    from lyapcheck.certificate import Certificate
    from lyapcheck.cli.parser import Parser
    from lyapcheck.control.conditions import Check
    from lyapcheck.control.gains import GainFile, GainSet
    from lyapcheck.robots import RobotModel
    from lyapcheck.simulate.bench import Bench
    from lyapcheck.simulate.many import Starts, Sweep
    from lyapcheck.simulate.reference import Reference
    from lyapcheck.simulate.run import Motion, Run
    from lyapcheck.simulate.task import Task
    from lyapcheck.simulate.tracking import TrackingRun


OF_LOOP = tuple(name for name in LOOP if name not in ("velocity", "within"))
"""Options of the loop; these two have other meanings here."""


def plot_run(run: Motion, number: int, place: Path) -> None:
    """Errors, torques and V of one run, as in Figs. 3 to 10 of the paper; ``number`` counts from 1.

    Of a tracking run also the angles beside the reference.
    """
    from lyapcheck.answers.simulate.samples import runs_csv
    from lyapcheck.report import plots_of_runs as motion
    from lyapcheck.report.plots import png, svg

    stem = file_stem(run.name, number)
    write_whole(place / f"{stem}.csv", runs_csv([run]))
    if run.t.size < 2:
        return
    title = f"{run.name} on {run.robot}, {run.kind}"
    goal, bound = (getattr(run, name, None) for name in ("goal", "bound"))
    figures = {
        "errors": motion.draw_errors(title, run.t, run.e, run.joints),
        "torques": motion.draw_torques(title, run.t, run.tau, run.joints, run.torque_limit),
        "lyapunov": motion.draw_lyapunov(title, run.t, run.V, run.dV, bound),
    }
    if goal is not None:
        figures["angles"] = motion.draw_tracking(title, run.t, run.q, goal, run.joints)
    for name, figure in figures.items():
        write_whole(place / f"{stem}-{name}.svg", svg(figure))
        write_whole(place / f"{stem}-{name}.png", png(figure))


def file_stem(name: str, number: int) -> str:
    """A gain set's name as part of a file name; two names never become one file."""
    stem = re.sub(r"[^\w.-]+", "_", name)
    return stem if stem == name else f"{stem}-{number}"


@dataclass(frozen=True)
class Job:
    """The gain sets of a file on an arm, the progress of them all, and where results go."""

    file: GainFile
    model: RobotModel
    eps0: float | None
    """With which V is watched."""
    certified: bool
    """Whether it is to be certified, for each gain set."""
    advance: Progress
    csv: str | None
    plot: Path | None
    form: str
    certificates: Path | None = None
    unfinished: list[Unfinished] = field(default_factory=list)
    varied: tuple[tuple[str, RobotModel], ...] = ()
    """The arm at other values of its numbers, each with what was changed."""
    arms: str = ""
    """All of these arms in words."""
    unsampled: bool = False
    """Whether the runs leave out how the files say a computer runs the loop."""

    @property
    def cases(self) -> list[tuple[GainSet, RobotModel]]:
        """Each gain set on the arm, and on the arm at other values, then named after them."""
        result = []
        for gain_set in self.file.gains:
            result.append((gain_set, self.model))
            result += [(replace(gain_set, name=f"{gain_set.name}: {what}"), arm) for what, arm in self.varied]
        return result

    def each(self) -> Iterator[tuple[GainSet, RobotModel, Progress]]:
        """Each case with its share of the progress of all."""
        cases = self.cases
        for done, (gain_set, arm) in enumerate(cases):
            yield gain_set, arm, _share_of(self.advance, done, len(cases), gain_set.name)

    def fail(self, gain_set: GainSet, reason: str) -> None:
        """Keep why not all that was asked of a gain set could be found out."""
        from lyapcheck.answers.simulate.simulation import Unfinished

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
        from lyapcheck.answers.epsilon import epsilon
        from lyapcheck.check.numbers.polynomials import Enclosure

        progress(0.0, f"{gain_set.name}: what ε₀ is certified")
        found = epsilon(gain_set, self.model, max_boxes=MAX_BOXES, weights=False).certified
        if found is None:
            name = f"{gain_set.name} on {self.model.name}"
            self.fail(gain_set, f"{name}: no ε₀ is certified, V is watched with ε₀ = 0")
            return 0.0
        return Enclosure(found, found).float_lower

    def write(self, answer: Simulation[Any], samples: Callable[[], str], *drawn: Motion) -> Exit:
        """Samples to their file or to standard output, else the answer there; what went wrong to the other.

        Returns:
            The exit code of the answer.
        """
        for number, run in enumerate(drawn if self.plot is not None else (), start=1):
            plot_run(run, number, self.plot or Path())
        if self.csv is not None and self.csv != "-":
            write_whole(Path(self.csv), samples())
        if self.csv == "-":
            sys.stdout.write(document_text(samples()))
        else:
            show(answer, self.form)
        for sentence in answer.complaints():
            print(sentence, file=sys.stderr)
        return answer.exit_code


def _share_of(advance: Progress, done: int, cases: int, name: str) -> Progress:
    return lambda fraction, note: advance((done + fraction) / cases, note or name)


def regulate(job: Job, task: Task, bench: Bench | None, stop: bool) -> Exit:
    """The set-point task, by the equations or as a computer runs it."""
    from lyapcheck.answers.simulate.runs import SetPointRuns, breach_certificate
    from lyapcheck.answers.simulate.samples import runs_csv
    from lyapcheck.files.fields import file_stem
    from lyapcheck.simulate.closed_loop import simulate
    from lyapcheck.simulate.trial import experiment

    runs: list[Run] = []
    broken: dict[str, Certificate] = {}
    mover = partial(experiment, bench=bench) if bench else partial(simulate, stop=stop)
    way = (task.q_d, task.q0, task.w0, task.T)
    for gain_set, arm, told in job.each():
        number = job.watching(gain_set, told)
        runs.append(job.moved(gain_set, partial(mover, gain_set, arm, *way, eps0=number, on_progress=told)))
        if job.certificates is not None and bench is None:
            certificate = breach_certificate(runs[-1], gain_set, arm)
            if certificate is not None and runs[-1].name == gain_set.name:
                broken[f"{file_stem(gain_set.name)}.breach.json"] = certificate
    if job.certificates is not None:
        write_certificates(job.certificates, broken)
    judged = {} if bench is None or job.varied else _judged(job, bench)
    answer = SetPointRuns(tuple(runs), tuple(job.unfinished), job.file, job.arms, judged=judged)
    return job.write(answer, lambda: runs_csv(answer.results), *runs)


def _judged(job: Job, bench: Bench) -> dict[str, tuple[Check, ...]]:
    """What the checker says of each gain set, run like that."""
    from lyapcheck.answers.gate.judge import judged_sets
    from lyapcheck.answers.running import runs_of
    from lyapcheck.control.limits import model_limits

    name, arms = job.model.name, {job.model.name: model_limits(job.model)}
    results = judged_sets(job.file, name, arms=arms, explained=0, loop=bench.entry)
    return {result.name: runs_of(result) for result in results}


def follow(job: Job, reference: Reference, task: Task, band: float, stop: bool) -> Exit:
    """The tracking scheme (21) along a reference."""
    from lyapcheck.answers.simulate.samples import runs_csv
    from lyapcheck.answers.simulate.tracking import TrackingRuns
    from lyapcheck.simulate.tracking import track

    runs: list[TrackingRun] = []
    mover = partial(track, eps0=job.eps0, band_rad=band, stop=stop)
    for gain_set, arm, told in job.each():
        way = (gain_set, arm, reference, task.q0, task.w0, task.T)
        runs.append(job.moved(gain_set, partial(mover, *way, on_progress=told)))
    answer = TrackingRuns(tuple(runs), tuple(job.unfinished), job.file, unsampled=job.unsampled)
    return job.write(answer, lambda: runs_csv(answer.results), *runs)


def spread_out(job: Job, task: Task, starts: Starts) -> Exit:
    """The set-point task from many random starts."""
    from lyapcheck.answers.simulate.samples import starts_csv
    from lyapcheck.answers.simulate.starts import RandomStarts
    from lyapcheck.simulate.many import sweep

    result: list[Sweep] = []
    for gain_set, arm, told in job.each():
        number = job.watching(gain_set, told)
        result.append(sweep(gain_set, arm, task, starts, eps0=number, on_progress=told))
        left = starts.count - result[-1].finished
        if left:
            job.fail(gain_set, f"{gain_set.name} on {arm.name}: {left} of {starts.count} runs")
    answer = RandomStarts(tuple(result), tuple(job.unfinished), job.file, unsampled=job.unsampled)
    return job.write(answer, lambda: starts_csv(result))


def arguments(parser: Parser) -> None:
    """What the command takes."""
    add_gain_file(parser)
    add_robot(parser)
    about = "Run as on the paper's bench, at 2.5 ms without delay, with encoders and dry friction."
    parser.add_argument("--experiment", action="store_true", help=about)
    add_loop(parser, OF_LOOP)
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
    add_vary(parser)
    about = "Continue after a violated bound instead of stopping."
    parser.add_argument("--keep-going", action="store_true", help=about)
    about = "Write all samples to this file. - is standard output."
    parser.add_argument("--csv", metavar="FILE", help=about)
    about = "Draw figures into this folder, as SVG and PNG, with their data as CSV."
    parser.add_argument("--plot", metavar="DIR", type=Path, help=about)
    add_certificates(parser, "Write a certificate of each state at which V rises to this folder")
    add_format(parser)


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
    folder = None if certificates is None else open_folder("--certificates", certificates)
    assert task is not None
    stop = not options["keep_going"]
    with progress("simulate") as advance:
        job = Job(
            gain_file,
            model,
            eps0,
            certified,
            advance,
            csv,
            plot,
            format,
            folder,
            varied=arms,
            arms=text,
            unsampled=bench is not None,
        )
        if path is not None:
            return follow(job, path, task, band, stop)
        if starts is not None:
            return spread_out(job, task, starts)
        return regulate(job, task, bench, stop)
