"""The simulation of the tracking scheme (21), with what theory promises of it."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass
from fractions import Fraction
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np

from lyapcheck._types import Array, Progress, silent
from lyapcheck.control.gains import one_gain_set
from lyapcheck.errors import InputError, Problem, argument_problem
from lyapcheck.family import Family
from lyapcheck.robots import arm_of
from lyapcheck.search.controlled_arm import ControlledArm
from lyapcheck.simulate.breach import beyond_bounds, beyond_limits, first_above, rise_of_rate, rise_of_V
from lyapcheck.simulate.closed_loop import Course
from lyapcheck.simulate.integrate import MAX_STEPS, Trajectory
from lyapcheck.simulate.promised import (
    NO_EPS0,
    SHARE,
    UNBOUNDED,
    Promise,
    TrackingForm,
    torque_bounds,
    tracking_form,
)
from lyapcheck.simulate.reference import SECONDS, Reference
from lyapcheck.simulate.results import BAND, imbalance, l2_of, motion_of
from lyapcheck.simulate.run import Breach, Motion
from lyapcheck.simulate.task import FASTEST, Setup, Task, task_for

if TYPE_CHECKING:
    from lyapcheck.control.gains import GainSet
    from lyapcheck.robots import ArmLike, RobotModel

ROUNDING = 1e-9
"""How far dV/dt may be above its bound, relative to the larger of both: what doubles may do."""
POINTS = 2001
"""Samples of a run."""


@dataclass(frozen=True, eq=False, kw_only=True, repr=False)
class TrackingRun(Motion):
    """A motion along a reference, where w = q̇ − q̇_d."""

    reference: Reference
    goal: Array
    """(N, n) q_d, rad."""
    speed: Array
    acceleration: Array
    bound: Array | None
    """(N,) W, −[a b] Θ' [a b]ᵀ, which dV/dt must not exceed; none for an unbounded controller."""
    promise: Promise
    band: float
    """rad, of ``indices.entered``."""
    work_balance: float
    """The largest difference of the arm's energy and the work done on it, relative to the larger of both."""

    @property
    def velocity(self) -> Array:
        """q̇, rad/s."""
        return self.speed + self.w

    @property
    def tightness(self) -> float:
        """The largest share of the seen fall of V that was promised: 1 where the form is met exactly.

        NaN where nothing falls, or nothing was promised.
        """
        if self.bound is None:
            return float("nan")
        inside = self.dV < -ROUNDING * np.max(np.abs(self.dV))
        return float(np.max(self.bound[inside] / self.dV[inside])) if inside.any() else float("nan")


# --- What a run is asked to do, once all of it is known to be possible.


def request_for(
    n: int,
    reference: Reference | None,
    q0: Sequence[float] | None,
    velocity: Sequence[float] | None,
    T: float | None,
    *,
    eps0: float | None,
    band: float = BAND,
    points: int = POINTS,
) -> Task:
    """The task of an arm of ``n`` joints; its goal is where the reference begins.

    Without a reference, because it could not be read, the rest is looked at all the same.

    Raises:
        InputError: all that is wrong with it at once.
    """
    problems: list[Problem] = []
    natural = SECONDS if reference is None else reference.duration
    seconds = natural if T is None else T
    try:
        task = task_for(n, (0.0,) * n, q0, velocity, seconds, eps0=eps0, points=points)
    except InputError as error:
        problems += error.problems
    if not 0.0 < band <= math.pi:
        rule = "must be more than 0 and at most 180°"
        problems.append(argument_problem("band_rad", f"{math.degrees(band):g}°", rule, "choose about 1°"))
    if reference is not None:
        speed, write = reference.suprema().speed, "write another reference file"
        if reference.n != n:
            rule = f"moves {reference.n} joints, but the arm has {n}"
            problems.append(argument_problem("reference", reference.kind, rule, write))
        if speed > FASTEST:
            rule = f"moves at {float(speed):.3g} rad/s, more than {FASTEST:g} rad/s"
            problems.append(argument_problem("reference", reference.kind, rule, write))
    if problems:
        raise InputError(problems)
    return task


# --- A tracking run: its start, its promises, and the run of its samples.


class Tracking(Course[TrackingRun]):
    """The way along a reference.

    Args:
        gain_set: the controller.
        model: the arm.
        reference: q_d(t).
        task: a task that is known to be possible.
        eps0: as `track` has it.
        band: rad.
        points: samples of the run.
    """

    easier = 100.0  # only W feels the kinks of q̈_d at the ends of a motion, and it is no more than a check

    def __init__(
        self,
        gain_set: GainSet,
        model: RobotModel,
        reference: Reference,
        task: Task,
        *,
        eps0: float | None,
        band: float,
        points: int,
    ) -> None:
        controlled = ControlledArm(gain_set, model)
        self.reference, self.band, suprema = reference, band, reference.suprema()
        self.form: TrackingForm | None = tracking_form(controlled, suprema.speed)
        first = reference.at(np.zeros(1))[0]
        e0, w0 = (first[0] - np.array(task.q0)).tolist(), (np.array(task.w0) - first[1]).tolist()
        largest = None if self.form is None else self.form.largest()
        if eps0 is None:
            eps0 = 0.0 if largest is None else float(largest * SHARE)
        self.promise = Promise(
            suprema,
            largest,
            falls=self.form is not None and self.form.certifies(Fraction(eps0)),
            torque=torque_bounds(controlled, suprema, task.q0, e0, w0),
            reason=UNBOUNDED if self.form is None else NO_EPS0 if largest is None else "",
        )
        super().__init__(Setup(controlled, task, eps0), [*e0, *w0], points, moving=True)

    def goal(self, t: Array) -> Array:
        return self.reference.at(t).reshape(t.size, -1)

    def watched(self, path: Trajectory) -> Array:
        """τ and e."""
        return np.hstack((self.signals(path)[0], path.y[:, : self.n]))

    def run(self, path: Trajectory, accuracy: float) -> TrackingRun:
        n, t, y, setup = self.n, path.t, path.y, self.setup
        goal, speed, acceleration = np.split(self.goal(t), 3, axis=1)
        tau, energy = self.signals(path)
        e, w, change = y[:, :n], y[:, n:-2], energy - energy[0]
        return TrackingRun(
            **motion_of(
                setup,
                "tracking",
                t,
                e,
                goal - e,
                w,
                tau,
                L2=l2_of(float(y[-1, -1]), float(t[-1])),
                complete=path.failure is None,
                band=self.band,
                speed=speed,
            ),
            acceleration=acceleration,
            accuracy=accuracy,
            reference=self.reference,
            goal=goal,
            bound=None
            if self.form is None
            else bound_of(self.form, setup.controlled.family, setup.eps0, e, w),
            promise=self.promise,
            band=self.band,
            work_balance=imbalance(change - y[:, -2], change, y[:, -2]),
        )

    @staticmethod
    def breaches(setup: Setup, run: TrackingRun) -> Sequence[Breach | None]:
        low, form = run.bound, None
        if low is not None:
            forgiven = ROUNDING * max(float(np.max(np.abs(x))) for x in (low, run.dV))
            form = first_above(run, "dV/dt ≤ −zᵀΘ'z", run.dV, low, "W", forgiven)
        torque = None if run.promise.torque is None else tuple(map(float, run.promise.torque.total))
        joints = beyond_bounds(run, "its bound for (21)", torque)
        return rise_of_rate(setup, run), rise_of_V(run), form, joints, beyond_limits(setup, run)


def bound_of(form: TrackingForm, family: Family, eps0: float, e: Array, w: Array) -> Array:
    """−[a b] Θ' [a b]ᵀ at the samples, W."""
    r, a, b = (np.linalg.norm(x, axis=1) for x in (e, family.h(e), w))
    return form.promised(eps0, r, a, b)


TOLERANCE = 1e-10
"""Relative tolerance of the first integration; the one handed back is ten times tighter."""


def track(
    gain_set: GainSet | str | Path,
    model: ArmLike,
    reference: Reference,
    start_rad: Sequence[float] | None = None,
    velocity_rad: Sequence[float] | None = None,
    T: float | None = None,
    *,
    eps0: float | None = None,
    band_rad: float = BAND,
    points: int = POINTS,
    tolerance: float = TOLERANCE,
    max_steps: int = MAX_STEPS,
    stop: bool = True,
    on_progress: Progress | None = None,
) -> TrackingRun:
    """Simulate an arm along a reference under (21).

    ė = −w, M(q) ẇ = K_p h(e) − K_v h(w) − B w − C(q, q̇) w with e = q_d(t) − q and w = q̇ − q̇_d. The
    integration is done twice, the second time ten times tighter. The second run is returned, and the
    difference is its ``accuracy``.

    Args:
        gain_set: the controller, of any family, or the path of a gain file with one gain set.
        model: the arm, its name or its file; uncertain parameters are at their nominal values.
        reference: q_d(t).
        start_rad: (n,) start in rad. Default: 0.
        velocity_rad: (n,) initial q̇ in rad/s. Default: 0.
        T: seconds. Default: the duration of the reference.
        eps0: the ε₀ of V. Default: half of the largest with Θ' positive definite at v_d.
        band_rad: rad, for the time from which on each |e_i| stays within it.
        points: number of returned samples, evenly spaced with both ends.
        tolerance: relative tolerance of the first integration.
        max_steps: a budget for each integration.
        stop: end the run at the first state that violates a bound.
        on_progress: receives the fraction done.

    Raises:
        InputError: a request the arm or the reference cannot meet.
        SimulationFailed: the integrator stopped. The error has the run so far.
        PromiseBroken: a bound was violated. The error has the run up to that state.

    Examples:
        >>> from fractions import Fraction as F
        >>> from lyapcheck import paper_gain_file, read_gain_file
        >>> from lyapcheck.robots import load
        >>> from lyapcheck.simulate.reference import MinimumJerk
        >>> way = MinimumJerk((F(0),) * 3, (F(45), F(45), F(90)), F(2))
        >>> gain_set = read_gain_file(paper_gain_file("table2")).gains[0]
        >>> run = track(gain_set, load("buap3"), way, [0.1, 0.0, 0.0], T=1.0)
        >>> run.promise.falls, run.breach
        (True, None)

    Soundness: the motion is floating point, which is evidence and never a proof. ``promise`` is certified.
        The run is compared with it.

    References: (13), (20), (21) of ``reyes2019family``; ``proofs/tracking.py``.
    """
    gain_set, model = one_gain_set(gain_set), arm_of(model)
    way = (reference, start_rad, velocity_rad, T)
    task = request_for(model.n, *way, eps0=eps0, band=band_rad, points=points)
    course = Tracking(gain_set, model, reference, task, eps0=eps0, band=band_rad, points=points)
    return course.moved(tolerance, max_steps, stop, on_progress or silent)
