"""The three kinds of simulation that ``lyapcheck simulate`` knows, each for all gain sets of a file."""

from __future__ import annotations

import sys
from collections.abc import Callable
from dataclasses import dataclass, field, replace
from functools import partial
from pathlib import Path
from typing import TYPE_CHECKING, Any

from lyapcheck._types import Progress
from lyapcheck.cli.eps0 import Eps0
from lyapcheck.cli.output import write_certificates, write_whole
from lyapcheck.cli.plots import plot_run, plot_tracking
from lyapcheck.cli.show import show
from lyapcheck.output.escapes import document_text
from lyapcheck.verdicts import Exit

if TYPE_CHECKING:
    from lyapcheck.answers.simulate.simulation import Simulation, Unfinished
    from lyapcheck.certificate import Certificate
    from lyapcheck.control.gains import GainFile, GainSet
    from lyapcheck.robots import RobotModel
    from lyapcheck.simulate.run import Run
    from lyapcheck.simulate.starts import Starts, Sweep
    from lyapcheck.simulate.task import Task
    from lyapcheck.tracking.reference import Reference
    from lyapcheck.tracking.request import TrackingRequest
    from lyapcheck.tracking.run import TrackingRun


@dataclass(frozen=True)
class Output:
    """Where results go, and how."""

    csv: str | None
    plot: Path | None
    form: str
    certificates: Path | None = None

    def write(self, answer: Simulation[Any], samples: Callable[[], str]) -> Exit:
        """Samples to their file or to standard output, else the answer there; what went wrong to the other.

        Returns:
            The exit code of the answer.
        """
        if self.csv is not None and self.csv != "-":
            write_whole(Path(self.csv), samples())
        if self.csv == "-":
            sys.stdout.write(document_text(samples()))
        else:
            show(answer, self.form)
        for sentence in answer.complaints():
            print(sentence, file=sys.stderr)
        return answer.exit_code


@dataclass(frozen=True)
class Job:
    """The gain sets of a file on an arm, and the progress of them all."""

    file: GainFile
    model: RobotModel
    output: Output
    advance: Progress
    unfinished: list[Unfinished] = field(default_factory=list)
    varied: tuple[tuple[str, RobotModel], ...] = ()
    """The arm at other values of its numbers, each with what was changed."""
    arms: str = ""
    """All of these arms in words."""

    @property
    def cases(self) -> list[tuple[GainSet, RobotModel]]:
        """Each gain set on the arm, and on the arm at other values, then named after them."""
        result = []
        for gain_set in self.file.gains:
            result.append((gain_set, self.model))
            result += [(replace(gain_set, name=f"{gain_set.name}: {what}"), arm) for what, arm in self.varied]
        return result

    def each(self) -> list[tuple[GainSet, Progress]]:
        """Each gain set with its share of the progress of all."""
        gains = self.file.gains
        return [(one, _share_of(self.advance, done, len(gains), one.name)) for done, one in enumerate(gains)]

    def fail(self, gain_set: GainSet, reason: str) -> None:
        """Keep why not all that was asked of a gain set could be found out."""
        from lyapcheck.answers.simulate.simulation import Unfinished

        self.unfinished.append(Unfinished(gain_set.name, reason))

    def watching(self, eps0: Eps0, gain_set: GainSet, progress: Progress) -> float:
        """The ε₀ to watch V with; 0 where none is certified, which is noted."""
        number = eps0.of(gain_set, self.model, progress)
        if number is None:
            name = f"{gain_set.name} on {self.model.name}"
            self.fail(gain_set, f"{name}: no ε₀ is certified, V is watched with ε₀ = 0")
        return number or 0.0


def _share_of(advance: Progress, done: int, cases: int, name: str) -> Progress:
    return lambda fraction, note: advance((done + fraction) / cases, note or name)


def regulate(job: Job, task: Task, *, eps0: Eps0, bench: bool, stop: bool) -> Exit:
    """The set-point task, by the equations or on the bench."""
    from lyapcheck.answers.simulate.runs import SetPointRuns, breach_certificate
    from lyapcheck.answers.simulate.samples import runs_csv
    from lyapcheck.files.names import file_stem
    from lyapcheck.simulate.closed_loop import simulate
    from lyapcheck.simulate.run import PromiseBroken, SimulationFailed
    from lyapcheck.simulate.trial import experiment

    runs: list[Run] = []
    broken: dict[str, Certificate] = {}
    mover = experiment if bench else partial(simulate, stop=stop)
    for done, (gain_set, arm) in enumerate(job.cases):
        progress = _share_of(job.advance, done, len(job.cases), gain_set.name)
        number = job.watching(eps0, gain_set, progress)
        way = (task.q_d, task.q0, task.w0, task.T)
        try:
            runs.append(mover(gain_set, arm, *way, eps0=number, on_progress=progress))
        except SimulationFailed as failure:
            if not isinstance(failure, PromiseBroken):
                job.fail(gain_set, failure.reason)
            runs += [] if failure.partial is None else [failure.partial]
        if job.output.certificates is not None and not bench and runs:
            certificate = breach_certificate(runs[-1], gain_set, arm)
            if certificate is not None and runs[-1].name == gain_set.name:
                broken[f"{file_stem(gain_set.name)}.breach.json"] = certificate
    if job.output.plot is not None:
        for number, run in enumerate(runs, start=1):
            plot_run(run, number, job.output.plot)
    if job.output.certificates is not None:
        write_certificates(job.output.certificates, broken)
    answer = SetPointRuns(tuple(runs), tuple(job.unfinished), job.file, job.arms)
    return job.output.write(answer, lambda: runs_csv(runs))


def follow(job: Job, reference: Reference, request: TrackingRequest, *, stop: bool) -> Exit:
    """The tracking scheme (21) along a reference."""
    from lyapcheck.answers.simulate.samples import tracking_csv
    from lyapcheck.answers.simulate.tracking import TrackingRuns
    from lyapcheck.tracking.run import TrackingFailed
    from lyapcheck.tracking.simulation import track_as_asked

    runs: list[TrackingRun] = []
    for gain_set, progress in job.each():
        try:
            run = track_as_asked(gain_set, job.model, reference, request, stop=stop, on_progress=progress)
        except TrackingFailed as failure:
            run = failure.partial
            if run.breach is None:
                job.fail(gain_set, failure.reason)
        runs.append(run)
    if job.output.plot is not None:
        for number, run in enumerate(runs, start=1):
            plot_tracking(run, number, job.output.plot)
    answer = TrackingRuns(tuple(runs), tuple(job.unfinished), job.file)
    return job.output.write(answer, lambda: tracking_csv(runs))


def spread_out(job: Job, task: Task, starts: Starts, *, eps0: Eps0) -> Exit:
    """The set-point task from many random starts."""
    from lyapcheck.answers.simulate.samples import starts_csv
    from lyapcheck.answers.simulate.starts import RandomStarts
    from lyapcheck.simulate.starts import sweep

    result: list[Sweep] = []
    for gain_set, progress in job.each():
        number = job.watching(eps0, gain_set, progress)
        result.append(sweep(gain_set, job.model, task, starts, eps0=number, on_progress=progress))
        left = starts.count - result[-1].finished
        if left:
            job.fail(gain_set, f"{gain_set.name} on {job.model.name}: {left} of {starts.count} runs")
    answer = RandomStarts(tuple(result), tuple(job.unfinished), job.file)
    return job.output.write(answer, lambda: starts_csv(result))
