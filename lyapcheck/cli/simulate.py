"""``lyapcheck simulate``."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated

import typer

from lyapcheck.cli.arm import robot_name
from lyapcheck.cli.complaints import Complaints
from lyapcheck.cli.eps0 import Eps0, eps0_of
from lyapcheck.cli.motions import Job, Output, follow, regulate, spread_out
from lyapcheck.cli.progress import progress
from lyapcheck.cli.task import Asked, check_options, check_places, starts_of
from lyapcheck.output.formats import JudgedFormat


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
    reference: Annotated[
        Path | None,
        typer.Option(help="Follow the trajectory of this reference file under (21), instead of a target."),
    ] = None,
    time: Annotated[
        float | None, typer.Option(help="Duration in s; 5, or the length of the reference.")
    ] = None,
    target: Annotated[
        str | None,
        typer.Option(help="Desired joint angles in degrees; the paper's 45,45,90 on a 3-joint arm."),
    ] = None,
    start: Annotated[
        str | None, typer.Option(help="Initial joint angles in degrees; all 0 if missing.")
    ] = None,
    velocity: Annotated[
        str | None, typer.Option(help="Initial joint rates in degrees a second; at rest if missing.")
    ] = None,
    eps0: Annotated[
        str | None,
        typer.Option(
            help="The ε₀ of V: a number, or 'certified' (takes a while); 0 if missing (V is the energy). "
            "With --reference half of what is proved for (21)."
        ),
    ] = None,
    band: Annotated[
        float | None,
        typer.Option(help="Degrees: with --reference, the time from which on all errors stay inside; 1."),
    ] = None,
    runs: Annotated[
        int | None, typer.Option(help="So many runs from random starts; tells how the indices spread.")
    ] = None,
    spread: Annotated[
        float | None, typer.Option(help="Degrees: with --runs, starts lie so far about --start; 45.")
    ] = None,
    seed: Annotated[int | None, typer.Option(help="Of the random starts; 0.")] = None,
    keep_going: Annotated[
        bool, typer.Option("--keep-going", help="Go on after a broken promise instead of stopping there.")
    ] = False,
    csv: Annotated[
        str | None, typer.Option(help="Write all samples to this file; - for standard output.")
    ] = None,
    plot: Annotated[
        Path | None, typer.Option(help="Draw figures into this directory: SVG, PNG, their data as CSV.")
    ] = None,
    format: Annotated[JudgedFormat, typer.Option(help="How to write it.")] = JudgedFormat.TEXT,  # noqa: A002
) -> None:
    """Simulate the closed loop of every gain set in FILE and report its performance.

    L2 index, settling, overshoot, peak torque against the limit: observations in floating point, never
    proofs. A run by the equations is stopped at the first state that breaks a promise: V falls, ‖τ‖ stays
    below (9), every motor within its limit. Exit code 1 if such a state is confirmed in balls, 3 if a run
    could not be finished; what was reached is written and marked.
    """
    from lyapcheck.control.gains import read_gain_file
    from lyapcheck.robots import load
    from lyapcheck.tracking.reference import read_reference

    gain_file = read_gain_file(file)
    model = load(robot_name(robot, [gain_file]))
    wrong = Complaints()
    watched = wrong.reading(eps0_of, eps0) or Eps0(None)
    asked = Asked(target, start, velocity, time, watched)
    given = {
        "--experiment": experiment or None,
        "--reference": reference,
        "--target": target,
        "--band": band,
        "--runs": runs,
        "--spread": spread,
        "--seed": seed,
        "--keep-going": keep_going or None,
        "--plot": plot,
    }
    wrong.reading(check_options, [name for name, value in given.items() if value is not None])
    wrong.reading(check_places, csv, plot)
    starts = path = task = request = None
    if runs is not None:
        starts = wrong.reading(starts_of, runs, spread, seed)
    if reference is None:
        task = wrong.reading(asked.task, model)
    else:
        path = wrong.reading(read_reference, reference, model.n)
        request = wrong.reading(asked.request, model, path, band)
    wrong.tell()
    with progress("simulate") as advance:
        job = Job(gain_file, model, Output(csv, plot, format.value), advance)
        stop = not keep_going
        if path is not None and request is not None:
            code = follow(job, path, request, stop=stop)
        elif task is not None and starts is not None:
            code = spread_out(job, task, starts, eps0=watched)
        elif task is not None:
            code = regulate(job, task, eps0=watched, bench=experiment, stop=stop)
    raise typer.Exit(int(code))
