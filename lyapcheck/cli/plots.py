"""Figures of simulated motions: SVG and PNG at once, and the samples they show as CSV beside them."""

from __future__ import annotations

import re
from pathlib import Path
from typing import TYPE_CHECKING, Any

from lyapcheck.cli.output import write_whole

if TYPE_CHECKING:
    from lyapcheck.simulate.run import Run
    from lyapcheck.tracking.run import TrackingRun


def plot_run(run: Run, number: int, place: Path) -> None:
    """Errors, torques and V of one run, as in Figs. 3 to 10 of the paper; ``number`` counts from 1."""
    from lyapcheck.answers.simulate.samples import runs_csv
    from lyapcheck.report.figures import motion
    from lyapcheck.report.figures.lyapunov import draw_lyapunov

    stem = file_stem(run.name, number)
    write_whole(place / f"{stem}.csv", runs_csv([run]))
    if run.t.size < 2:
        return
    title = f"{run.name} on {run.robot}, {run.kind}"
    figures = {
        "errors": motion.draw_errors(title, run.t, run.e, run.joints),
        "torques": motion.draw_torques(title, run.t, run.tau, run.joints, run.torque_limit),
        "lyapunov": draw_lyapunov(title, run.t, run.V, run.dV),
    }
    _write(figures, place, stem)


def plot_tracking(run: TrackingRun, number: int, place: Path) -> None:
    """Angles beside the reference, errors, torques and V of one tracking run."""
    from lyapcheck.answers.simulate.samples import tracking_csv
    from lyapcheck.report.figures import motion
    from lyapcheck.report.figures.lyapunov import draw_lyapunov

    stem = file_stem(run.name, number)
    write_whole(place / f"{stem}.csv", tracking_csv([run]))
    m = run.motion
    if m.t.size < 2:
        return
    title = f"{run.name} on {run.robot}, tracking"
    figures = {
        "angles": motion.draw_tracking(title, m.t, m.q, m.goal, run.joints),
        "errors": motion.draw_errors(title, m.t, m.e, run.joints),
        "torques": motion.draw_torques(title, m.t, m.tau, run.joints, run.torque_limit),
        "lyapunov": draw_lyapunov(title, m.t, run.V, run.dV, run.bound),
    }
    _write(figures, place, stem)


def file_stem(name: str, number: int) -> str:
    """A gain set's name as part of a file name; two names never become one file."""
    stem = re.sub(r"[^\w.-]+", "_", name)
    return stem if stem == name else f"{stem}-{number}"


def _write(figures: dict[str, Any], place: Path, stem: str) -> None:
    from lyapcheck.report.figures.style import png, svg

    for name, figure in figures.items():
        write_whole(place / f"{stem}-{name}.svg", svg(figure))
        write_whole(place / f"{stem}-{name}.png", png(figure))
