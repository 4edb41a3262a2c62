"""The simulation of the tracking scheme (21), with what theory promises of it."""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from dataclasses import replace
from fractions import Fraction
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

from lyapcheck.search.setting import Setting
from lyapcheck.simulate.gains import gains_for
from lyapcheck.simulate.integrate import MAX_STEPS, Trajectory, integrate
from lyapcheck.simulate.monitor import torque_limits
from lyapcheck.simulate.results import LEAST_ENERGY
from lyapcheck.tracking.form import TrackingForm, tracking_form
from lyapcheck.tracking.loop import TrackingLoop, tracking_loop
from lyapcheck.tracking.reference import Reference
from lyapcheck.tracking.request import BAND, POINTS, Request, request_for
from lyapcheck.tracking.results import bound_of, broken, energies, indices_of
from lyapcheck.tracking.run import Motion, Promise, TrackingFailed, TrackingRun
from lyapcheck.tracking.torque import torque_bounds

if TYPE_CHECKING:
    from lyapcheck.control import GainSet
    from lyapcheck.robots import RobotModel

Array = NDArray[np.float64]
Progress = Callable[[float, str], None]

TOLERANCE = 1e-10
"""Relative tolerance of the first integration; the one handed back is ten times tighter."""

SHARE = Fraction(1, 2)
"""ε₀ as a share of the largest one for which Θ' is positive definite: there the form is singular."""


def track(
    gain_set: GainSet,
    model: RobotModel,
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
        gain_set: the controller, of any family.
        model: the arm; uncertain parameters are at their nominal values.
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
        on_progress: told the fraction done.

    Raises:
        InputError: a request the arm or the reference cannot meet.
        TrackingFailed: the integrator gave up, or a promise broke; carries what was reached.

    Examples:
        >>> from fractions import Fraction as F
        >>> from lyapcheck.control import paper_gain_file, read_gain_file
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
    asked: Request,
    *,
    tolerance: float = TOLERANCE,
    max_steps: int = MAX_STEPS,
    stop: bool = True,
    on_progress: Progress | None = None,
) -> TrackingRun:
    """The same for a request that is known to be possible; see `track`."""
    task = _Task(gain_set, model, reference, asked)
    rough, fine = task.twice(tolerance, max_steps, on_progress or (lambda fraction, note: None))
    failure = fine.failure or rough.failure
    accuracy = math.nan if failure else float(np.max(np.abs(fine.y - rough.y)[:, : 2 * model.n]))
    with np.errstate(over="ignore", invalid="ignore"):  # gains beyond all sense end as inf, not as noise
        run = task.run(fine, accuracy)
    title = f"{gain_set.name} on {model.name}"
    if run.breach is not None and stop:
        end = run.breach.index + 1
        partial = task.run(Trajectory(fine.t[:end], fine.y[:end], "stopped"), accuracy)
        raise TrackingFailed(f"{title}: {run.breach.sentence}", replace(partial, breach=run.breach))
    if failure is not None:
        raise TrackingFailed(f"{title}: {failure}", run)
    return run


class _Task:
    """One controller, arm, reference and request, and all that is computed of them once."""

    def __init__(self, gain_set: GainSet, model: RobotModel, reference: Reference, asked: Request) -> None:
        self.gains = gains_for(gain_set, model.n)
        self.setting, self.reference, self.asked = Setting(gain_set, model), reference, asked
        self.loop: TrackingLoop = tracking_loop(self.gains, model)
        self.suprema = reference.suprema()
        self.form: TrackingForm | None = tracking_form(self.setting, self.suprema.speed)
        first = reference.at(np.zeros(1))[0]
        self.e0, self.w0 = first[0] - np.array(asked.q0), np.array(asked.velocity) - first[1]
        self.promise = self._promise()

    def _promise(self) -> Promise:
        largest = None if self.form is None else self.form.largest()
        reason = ""
        if self.form is None:
            reason = "h is unbounded, and Θ' needs its bound γ"
        elif largest is None:
            reason = "no ε₀ > 0 makes Θ' positive definite; λmin(B) and λmin(K_p) must be positive"
        eps0 = self.asked.eps0
        if eps0 is None:
            eps0 = 0.0 if largest is None else float(largest * SHARE)
        falls = self.form is not None and self.form.certifies(Fraction(eps0))
        start = (self.asked.q0, self.e0.tolist(), self.w0.tolist())
        torque = torque_bounds(self.setting, self.suprema, *start)
        return Promise(self.suprema, eps0, largest, falls, torque, reason)

    def twice(self, tolerance: float, max_steps: int, tell: Progress) -> tuple[Trajectory, Trajectory]:
        """The integration, and again ten times tighter."""
        rate, jacobian, T = self.loop.compiled_rate(), self.loop.compiled_jacobian(), self.asked.T
        t = np.linspace(0.0, T, self.asked.points)
        y0 = np.array([*self.e0, *self.w0, 0.0, 0.0])

        def once(tolerance: float, done: float) -> Trajectory:
            return integrate(
                lambda time, y: rate(y, self._at(time)),
                lambda time, y: jacobian(y, self._at(time)),
                y0,
                t,
                tolerance,
                max_steps=max_steps,
                on_time=lambda time: tell(done + 0.5 * time / T, ""),
            )

        return once(tolerance, 0.0), once(tolerance / 10, 0.5)

    def _at(self, time: float) -> Array:
        return self.reference.at(np.array([time])).ravel()

    def run(self, path: Trajectory, accuracy: float) -> TrackingRun:
        """Everything that can be computed from the samples of a path."""
        n, model = self.setting.n, self.setting.model
        goal = self.reference.at(path.t)
        inputs = (path.y.T, goal.reshape(len(path.t), -1).T)
        tau, energy = (np.array(x) for x in self.loop.signals().map(path.t.size)(*inputs))
        e, w = path.y[:, :n], path.y[:, n : 2 * n]
        motion = Motion(path.t, goal[:, 0] - e, e, w, tau.T, goal[:, 0], goal[:, 1], goal[:, 2])
        V, dV = energies(self.setting, self.gains, self.promise.eps0, motion)
        bound = bound_of(self.form, self.gains, self.promise.eps0, motion)
        return TrackingRun(
            gains=self.gains,
            robot=model.name,
            joints=model.joints,
            reference=self.reference,
            T=self.asked.T,
            motion=motion,
            V=V,
            dV=dV,
            bound=bound,
            promise=self.promise,
            indices=indices_of(motion, float(path.y[-1, 2 * n]), self.asked.band),
            band=self.asked.band,
            accuracy=accuracy,
            work_balance=_imbalance(energy[0], path.y[:, 2 * n + 1]),
            torque_limit=torque_limits(model),
            complete=path.failure is None,
            notes=model.assumptions,
            breach=broken(self.setting, self.promise, motion, V, dV, bound),
        )


def _imbalance(energy: Array, work: Array) -> float:
    """The largest |E(t) − E(0) − W(t)|, relative to the largest change of energy or work of the run."""
    change = energy - energy[0]
    scale = max(float(np.max(np.abs(change))), float(np.max(np.abs(work))), LEAST_ENERGY)
    return float(np.max(np.abs(change - work))) / scale
