"""The simulation of the tracking scheme (21), with what theory promises of it."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import replace
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np

from lyapcheck._types import Progress, silent
from lyapcheck.control.gains import one_gain_set
from lyapcheck.robots.registry import arm_of
from lyapcheck.simulate.extremes import with_extremes
from lyapcheck.simulate.integrate import MAX_STEPS
from lyapcheck.tracking.prepared import Prepared
from lyapcheck.tracking.reference import Reference
from lyapcheck.tracking.request import BAND, POINTS, TrackingRequest, request_for
from lyapcheck.tracking.run import TrackingFailed, TrackingRun

if TYPE_CHECKING:
    from lyapcheck.control.gains import GainSet
    from lyapcheck.robots import RobotModel


TOLERANCE = 1e-10
"""Relative tolerance of the first integration; the one handed back is ten times tighter."""


def track(
    gain_set: GainSet | str | Path,
    model: RobotModel | str | Path,
    reference: Reference,
    q0: Sequence[float] | None = None,
    velocity: Sequence[float] | None = None,
    T: float | None = None,
    *,
    eps0: float | None = None,
    band: float = BAND,
    points: int = POINTS,
    tolerance: float = TOLERANCE,
    max_steps: int = MAX_STEPS,
    stop: bool = True,
    on_progress: Progress | None = None,
) -> TrackingRun:
    """Move an arm along a reference under (21).

    ė = −w, M(q) ẇ = K_p h(e) − K_v h(w) − B w − C(q, q̇) w with e = q_d(t) − q and w = q̇ − q̇_d. The
    integration is done twice, the second time ten times tighter; the second is handed back and their
    difference is its ``accuracy``.

    Args:
        gain_set: the controller, of any family, or the path of a gain file with one gain set.
        model: the arm, its name or its file; uncertain parameters are at their nominal values.
        reference: q_d(t).
        q0: (n,) start in rad; home if missing.
        velocity: (n,) initial q̇ in rad/s; rest if missing.
        T: seconds; what the reference asks for if missing.
        eps0: the ε₀ of V; half of the largest for which Θ' is positive definite at v_d if missing.
        band: rad, for the time from which on each |e_i| stays within it.
        points: samples handed back, evenly spaced, both ends included.
        tolerance: relative tolerance of the first integration.
        max_steps: a budget for each integration.
        stop: end the run at the first state that breaks a promise.
        on_progress: receives the fraction done.

    Raises:
        InputError: a request the arm or the reference cannot meet.
        TrackingFailed: the integrator gave up, or a promise broke; carries what was reached.

    Examples:
        >>> from fractions import Fraction as F
        >>> from lyapcheck import paper_gain_file, read_gain_file
        >>> from lyapcheck.robots import load
        >>> from lyapcheck.tracking.reference import MinimumJerk
        >>> way = MinimumJerk((F(0),) * 3, (F(45), F(45), F(90)), F(2))
        >>> gain_set = read_gain_file(paper_gain_file("table2")).gains[0]
        >>> run = track(gain_set, load("buap3"), way, [0.1, 0.0, 0.0], T=1.0)
        >>> run.promise.falls, run.breach
        (True, None)

    Soundness: the motion is floating point: evidence, never a proof. ``promise`` is certified; that a run
        keeps it is what is looked at.

    References: (13), (20), (21) of ``reyes2019family``; ``proofs/tracking.py``.
    """
    gain_set, model = one_gain_set(gain_set), arm_of(model)
    asked = request_for(model.n, reference, q0, velocity, T, eps0=eps0, band=band, points=points)
    return track_as_asked(
        gain_set,
        model,
        reference,
        asked,
        tolerance=tolerance,
        max_steps=max_steps,
        stop=stop,
        on_progress=on_progress,
    )


def track_as_asked(
    gain_set: GainSet,
    model: RobotModel,
    reference: Reference,
    asked: TrackingRequest,
    *,
    tolerance: float = TOLERANCE,
    max_steps: int = MAX_STEPS,
    stop: bool = True,
    on_progress: Progress | None = None,
) -> TrackingRun:
    """The same for a request that is known to be possible; see `track`."""
    task = Prepared(gain_set, model, reference, asked)
    rough, fine = task.twice(tolerance, max_steps, on_progress or silent)
    failure = fine.failure or rough.failure
    accuracy = math.nan if failure else float(np.max(np.abs(fine.y - rough.y)[:, : 2 * model.n]))
    with np.errstate(over="ignore", invalid="ignore"):  # gains beyond all sense end as inf, not as noise
        every = with_extremes(fine, task.watched)
        seen = task.run(every, accuracy)
        breach = seen.breach
        if breach is not None and stop:
            fine = fine.until(breach.t)
            seen = task.run(every.until(breach.t), accuracy)
        run = replace(task.run(fine, accuracy), indices=seen.indices, breach=breach)
    title = f"{gain_set.name} on {model.name}"
    if breach is not None and stop:
        raise TrackingFailed(f"{title}: {breach.sentence}", run)
    if failure is not None:
        raise TrackingFailed(f"{title}: {failure}", run)
    return run
