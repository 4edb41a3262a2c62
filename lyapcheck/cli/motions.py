"""The three kinds of simulation that ``lyapcheck simulate`` knows, each for all gain sets of a file."""

from __future__ import annotations

import sys
from collections.abc import Callable, Sequence
from dataclasses import dataclass, field
from functools import partial
from pathlib import Path
from typing import TYPE_CHECKING

from lyapcheck.cli.eps0 import Eps0
from lyapcheck.cli.output import write_whole
from lyapcheck.cli.plots import plot_run, plot_tracking
from lyapcheck.cli.progress import Advance
from lyapcheck.output.escapes import document_text
from lyapcheck.verdicts import Exit

if TYPE_CHECKING:
    from lyapcheck.control import GainSet
    from lyapcheck.robots import RobotModel
    from lyapcheck.simulate import Run, Task
    from lyapcheck.simulate.breach import Breach
    from lyapcheck.simulate.starts import Starts, Sweep
    from lyapcheck.tracking import Reference, Request, TrackingRun


@dataclass(frozen=True)
class Output:
    """Where results go, and how."""

    csv: str | None
    plot: Path | None
    form: str

    def write(self, samples: Callable[[], str], summary: Callable[[], str]) -> None:
        """Samples to their file or to standard output, else the summary to standard output."""
        if self.csv is not None and self.csv != "-":
            write_whole(Path(self.csv), samples())
        sys.stdout.write(document_text(samples() if self.csv == "-" else summary()))


@dataclass
class Ending:
    """What went wrong on the way, and the exit code that follows."""

    unfinished: list[str] = field(default_factory=list)
    breaches: list[tuple[str, Breach]] = field(default_factory=list)

    def note(self, name: str, breach: Breach | None) -> None:
        """A promise that a run broke, if it did."""
        if breach is not None:
            self.breaches.append((name, breach))

    def watching(self, eps0: Eps0, gain_set: GainSet, model: RobotModel, advance: Advance) -> float:
        """The ε₀ to watch V with; 0 where none is certified, which is noted."""
        number = eps0.of(gain_set, model, advance)
        if number is None:
            name = f"{gain_set.name} on {model.name}"
            self.unfinished.append(f"{name}: no ε₀ is certified, V is watched with ε₀ = 0")
        return number or 0.0

    def tell(self) -> Exit:
        """Say it all on standard error.

        A promise that balls prove broken is refuted; what was only seen in doubles decides nothing.
        """
        for name, breach in self.breaches:
            print(f"promise broken: {name}: {breach.sentence}", file=sys.stderr)
        for reason in self.unfinished:
            print(f"not finished: {reason}", file=sys.stderr)
        if any(breach.confirmed for _, breach in self.breaches):
            return Exit.REFUTED
        return Exit.UNDECIDED if self.unfinished or self.breaches else Exit.PROVED


def regulate(
    gains: Sequence[GainSet],
    model: RobotModel,
    task: Task,
    *,
    eps0: Eps0,
    bench: bool,
    stop: bool,
    output: Output,
    advance: Advance,
) -> Ending:
    """The set-point task, by the equations or on the bench."""
    from lyapcheck.simulate import PromiseBroken, SimulationFailed, experiment, simulate
    from lyapcheck.simulate.csv import runs_csv
    from lyapcheck.simulate.render import RENDERERS

    runs: list[Run] = []
    ending = Ending()
    mover = experiment if bench else partial(simulate, stop=stop)
    for gain_set, tell in _each(gains, advance):
        number = ending.watching(eps0, gain_set, model, tell)
        try:
            found = mover(gain_set, model, task.q_d, task.q0, task.w0, task.T, eps0=number, on_progress=tell)
        except SimulationFailed as failure:
            if not isinstance(failure, PromiseBroken):
                ending.unfinished.append(failure.reason)
            if failure.partial is None:
                continue
            found = failure.partial
        ending.note(found.name, found.breach)
        runs.append(found)
    if output.plot is not None:
        for number, run in enumerate(runs, start=1):
            plot_run(run, number, output.plot)
    output.write(lambda: runs_csv(runs), lambda: RENDERERS[output.form](runs))
    return ending


def follow(
    gains: Sequence[GainSet],
    model: RobotModel,
    reference: Reference,
    request: Request,
    *,
    stop: bool,
    output: Output,
    advance: Advance,
) -> Ending:
    """The tracking scheme (21) along a reference."""
    from lyapcheck.tracking import TrackingFailed, track_as_asked
    from lyapcheck.tracking.csv import tracking_csv
    from lyapcheck.tracking.render import RENDERERS

    runs: list[TrackingRun] = []
    ending = Ending()
    for gain_set, tell in _each(gains, advance):
        try:
            run = track_as_asked(gain_set, model, reference, request, stop=stop, on_progress=tell)
        except TrackingFailed as failure:
            run = failure.partial
            if run.breach is None:
                ending.unfinished.append(failure.reason)
        ending.note(run.name, run.breach)
        runs.append(run)
    if output.plot is not None:
        for number, run in enumerate(runs, start=1):
            plot_tracking(run, number, output.plot)
    output.write(lambda: tracking_csv(runs), lambda: RENDERERS[output.form](runs))
    return ending


def spread_out(
    gains: Sequence[GainSet],
    model: RobotModel,
    task: Task,
    starts: Starts,
    *,
    eps0: Eps0,
    output: Output,
    advance: Advance,
) -> Ending:
    """The set-point task from many random starts."""
    from lyapcheck.simulate.starts import sweep
    from lyapcheck.simulate.starts_render import RENDERERS, sweeps_csv

    found: list[Sweep] = []
    ending = Ending()
    for gain_set, tell in _each(gains, advance):
        number = ending.watching(eps0, gain_set, model, tell)
        found.append(sweep(gain_set, model, task, starts, eps0=number, on_progress=tell))
        left = starts.count - found[-1].finished
        if left:
            ending.unfinished.append(f"{gain_set.name} on {model.name}: {left} of {starts.count} runs")
        ending.note(gain_set.name, found[-1].breach)
    output.write(lambda: sweeps_csv(found), lambda: RENDERERS[output.form](found))
    return ending


def _each(gains: Sequence[GainSet], advance: Advance) -> list[tuple[GainSet, Advance]]:
    """Each gain set with what tells its share of the progress of all."""

    def telling(done: int, name: str) -> Advance:
        return lambda fraction, note: advance((done + fraction) / len(gains), note or name)

    return [(gain_set, telling(done, gain_set.name)) for done, gain_set in enumerate(gains)]
