"""``lyapcheck simulate``."""

from __future__ import annotations

import re
import sys
from enum import StrEnum
from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer

from lyapcheck.cli.arm import robot_name
from lyapcheck.cli.output import require_writable, write_whole
from lyapcheck.cli.progress import Advance, progress
from lyapcheck.cli.task import task_of
from lyapcheck.errors import argument_error
from lyapcheck.verdicts import Exit

if TYPE_CHECKING:
    from collections.abc import Sequence

    from lyapcheck.control import GainSet
    from lyapcheck.robots import RobotModel
    from lyapcheck.simulate import Run, Task


class SimulateFormat(StrEnum):
    """How the results are written."""

    TEXT = "text"
    JSON = "json"
    MARKDOWN = "markdown"


def command(
    file: Annotated[Path, typer.Argument(help="A gain file.", metavar="FILE")],
    robot: Annotated[
        str | None,
        typer.Option(help="A built-in arm or an arm file, instead of the one the gain file names."),
    ] = None,
    experiment: Annotated[
        bool,
        typer.Option("--experiment", help="As on the bench: hold, encoders, dry friction, torque limits."),
    ] = False,
    time: Annotated[float, typer.Option(help="Duration in s.")] = 5.0,
    target: Annotated[
        str | None,
        typer.Option(help="Desired joint angles in degrees; the paper's 45,45,90 on a 3-joint arm."),
    ] = None,
    start: Annotated[
        str | None, typer.Option(help="Initial joint angles in degrees; all 0 if missing.")
    ] = None,
    eps0: Annotated[float, typer.Option(help="The ε₀ of V; with 0, V is the energy.")] = 0.0,
    csv: Annotated[
        str | None, typer.Option(help="Write all samples to this file; - for standard output.")
    ] = None,
    plot: Annotated[
        Path | None, typer.Option(help="Draw errors and torques as SVG files into this directory.")
    ] = None,
    format: Annotated[SimulateFormat, typer.Option(help="How to write it.")] = SimulateFormat.TEXT,  # noqa: A002
) -> None:
    """Simulate the closed loop of every gain set in FILE and report its performance.

    L2 index, settling, overshoot, peak torque against the limit, and whether V fell all along: observations
    in floating point, never proofs. Exit code 3 if a run could not be finished; what it reached is written
    and marked.
    """
    from lyapcheck.control import read_gain_file
    from lyapcheck.robots import load

    gain_file = read_gain_file(file)
    model = load(robot_name(robot, [gain_file]))
    task = task_of(model, target, start, time, eps0)
    _check_places(csv, plot)
    with progress("simulate") as advance:
        runs, failures = _run_all(gain_file.gains, model, task, eps0=eps0, bench=experiment, advance=advance)
    _write(runs, csv, plot, format)
    for reason in failures:
        print(f"not finished: {reason}", file=sys.stderr)
    raise typer.Exit(int(Exit.UNDECIDED if failures else Exit.PROVED))


def _check_places(csv: str | None, plot: Path | None) -> None:
    if csv is not None and csv != "-":
        require_writable("--csv", Path(csv))
    if plot is not None and not plot.is_dir():
        raise argument_error("--plot", plot, "is not a directory", "create it or name another one")


def _run_all(
    gains: Sequence[GainSet], model: RobotModel, task: Task, *, eps0: float, bench: bool, advance: Advance
) -> tuple[list[Run], list[str]]:
    """The run of every gain set, and the reasons of those that were cut short."""
    from lyapcheck.simulate import SimulationFailed, experiment, simulate

    runs: list[Run] = []
    failures: list[str] = []
    mover = experiment if bench else simulate
    for done, gain_set in enumerate(gains):
        advance(done / len(gains), gain_set.name)
        try:
            runs.append(mover(gain_set, model, task.q_d, task.q0, task.w0, task.T, eps0=eps0))
        except SimulationFailed as failure:
            failures.append(failure.reason)
            runs += [failure.partial] if failure.partial is not None else []
    return runs, failures


def _write(runs: Sequence[Run], csv: str | None, plot: Path | None, form: SimulateFormat) -> None:
    from lyapcheck.simulate.csv import runs_csv
    from lyapcheck.simulate.render import RENDERERS

    if plot is not None:
        _draw(runs, plot)
    if csv is not None and csv != "-":
        write_whole(Path(csv), runs_csv(runs))
    sys.stdout.write(runs_csv(runs) if csv == "-" else RENDERERS[form.value](runs))


def _draw(runs: Sequence[Run], place: Path) -> None:
    """Two figures a run, as in Figs. 3 to 10 of the paper."""
    from lyapcheck.report.figures.motion import errors_figure, torques_figure

    for number, run in enumerate(runs):
        title = f"{run.name} on {run.robot}, {run.kind}"
        stem = re.sub(r"[^\w.-]+", "_", run.name)
        if stem != run.name:  # two names must not become one file
            stem = f"{stem}-{number + 1}"
        write_whole(place / f"{stem}-errors.svg", errors_figure(title, run.t, run.e, run.joints))
        write_whole(
            place / f"{stem}-torques.svg", torques_figure(title, run.t, run.tau, run.joints, run.torque_limit)
        )
