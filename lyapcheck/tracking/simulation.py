"""The simulation of the tracking scheme (21), with what theory promises of it."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass, replace
from fractions import Fraction
from pathlib import Path
from typing import TYPE_CHECKING, Any

import casadi as ca
import numpy as np

from lyapcheck._types import Array, Progress, silent
from lyapcheck.control.gains import one_gain_set
from lyapcheck.robots.registry import arm_of
from lyapcheck.search.controlled_arm import ControlledArm
from lyapcheck.simulate.integrate import MAX_STEPS, Compiled, Trajectory, integrate, with_extremes
from lyapcheck.simulate.results import LEAST_ENERGY, torque_limits
from lyapcheck.simulate.task import gains_for
from lyapcheck.tracking.reference import Reference
from lyapcheck.tracking.request import BAND, POINTS, TrackingRequest, request_for
from lyapcheck.tracking.run import (
    Promise,
    TrackingFailed,
    TrackingMotion,
    TrackingRun,
    bound_of,
    broken,
    energies,
    indices_of,
)
from lyapcheck.tracking.torque import TrackingForm, torque_bounds, tracking_form

if TYPE_CHECKING:
    from lyapcheck.control.gains import GainSet
    from lyapcheck.robots import RobotModel
    from lyapcheck.simulate.task import Gains


# --- The loop that (21) closes as one differentiable graph, with the reference as its input.


@dataclass(frozen=True)
class TrackingLoop:
    """The state y = (e, w, S, W) of a run and its rate; inputs are q_d, q̇_d and q̈_d one after the other.

    e = q_d − q and w = q̇ − q̇_d = −ė. S' = ‖e‖², and W' = q̇ᵀ(τ − B q̇) is the power that reaches the arm, so
    that its energy ½ q̇ᵀM q̇ + P(q) must change by W: τ of (21) moves the arm (1) as the error system says.
    """

    n: int
    state: Any
    """(2n + 2,) SX."""
    reference: Any
    """(3n,) SX."""
    rate: Any
    """(2n + 2,) SX."""
    torque: Any
    """(n,) SX, τ of (21)."""
    energy: Any
    """SX, of the arm."""

    def compiled_rate(self) -> Compiled:
        """(y, reference) ↦ ẏ."""
        return Compiled(ca.Function("rate", self._inputs, [ca.densify(self.rate)]))

    def compiled_jacobian(self) -> Compiled:
        """(y, reference) ↦ ∂ẏ/∂y."""
        jacobian = ca.densify(ca.jacobian(self.rate, self.state))
        return Compiled(ca.Function("jacobian", self._inputs, [jacobian]))

    def signals(self) -> Any:
        """The CasADi function (y, reference) ↦ (τ, energy)."""
        return ca.Function("signals", self._inputs, [self.torque, self.energy])

    @property
    def _inputs(self) -> list[Any]:
        return [self.state, self.reference]


def tracking_loop(gains: Gains, model: RobotModel) -> TrackingLoop:
    """The graph of the error system of (21) on one arm, uncertain parameters at their nominal values.

    M(q) ẇ = K_p h(e) − K_v h(w) − B w − C(q, q̇) w with q = q_d − e, q̇ = q̇_d + w, and
    τ = K_p h(e) + K_v h(ė) + M(q) q̈_d + C(q, q̇) q̇_d + g(q) + B q̇_d.

    References: (1), (21) of ``reyes2019family``.
    """
    from lyapcheck.robots import graph

    n = model.n
    state, reference = ca.SX.sym("y", 2 * n + 2), ca.SX.sym("r", 3 * n)
    e, w = state[:n], state[n : 2 * n]
    goal, speed, desired_acceleration = reference[:n], reference[n : 2 * n], reference[2 * n :]
    q, velocity = goal - e, speed + w
    mass, coriolis = graph.mass(model, q), graph.coriolis(model, q, velocity)
    friction, gravity = graph.viscous(model), graph.gravity(model, q)
    feedback = ca.DM(gains.kp) * gains.family.casadi(e).h - ca.DM(gains.kv) * gains.family.casadi(w).h
    acceleration = graph.solve(mass, feedback - friction @ w - coriolis @ w)
    torque = feedback + mass @ desired_acceleration + coriolis @ speed + gravity + friction @ speed
    power = ca.dot(velocity, torque - friction @ velocity)
    rate = ca.vertcat(-w, acceleration, ca.dot(e, e), power)
    energy = ca.dot(velocity, mass @ velocity) / 2 + graph.potential(model, q)
    return TrackingLoop(n, state, reference, rate, torque, energy)


# --- A tracking run made ready: loop, start, promises; its integration, and the run of its samples.


EASIER = 100.0
"""How much less accurate the work W may be: it is a check, and only it feels the kinks of a recorded q̈_d."""

SHARE = Fraction(1, 2)
"""ε₀ as a share of the largest one for which Θ' is positive definite: there the form is singular."""


class Prepared:
    """One controller, arm, reference and request, and all that is computed of them once.

    Args:
        gain_set: the controller.
        model: the arm.
        reference: q_d(t).
        asked: a request that is known to be possible.
    """

    def __init__(
        self, gain_set: GainSet, model: RobotModel, reference: Reference, asked: TrackingRequest
    ) -> None:
        self.gains = gains_for(gain_set, model.n)
        self.model, self.controlled = model, ControlledArm(gain_set, model)
        self.reference, self.asked = reference, asked
        self.loop: TrackingLoop = tracking_loop(self.gains, model)
        self.suprema = reference.suprema()
        self.form: TrackingForm | None = tracking_form(self.controlled, self.suprema.speed)
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
        torque = torque_bounds(self.controlled, self.suprema, *start)
        return Promise(self.suprema, eps0, largest, falls, torque, reason)

    def twice(self, tolerance: float, max_steps: int, progress: Progress) -> tuple[Trajectory, Trajectory]:
        """The integration, and again ten times tighter."""
        rate, jacobian, T = self.loop.compiled_rate(), self.loop.compiled_jacobian(), self.asked.T
        t = np.linspace(0.0, T, self.asked.points)
        y0 = np.array([*self.e0, *self.w0, 0.0, 0.0])
        easy = np.array([1.0] * (y0.size - 1) + [EASIER])

        def once(tolerance: float, done: float) -> Trajectory:
            return integrate(
                lambda time, y: rate(y, self._at(time)),
                lambda time, y: jacobian(y, self._at(time)),
                y0,
                t,
                tolerance * easy,
                max_steps=max_steps,
                on_time=lambda time: progress(done + 0.5 * time / T, ""),
            )

        return once(tolerance, 0.0), once(tolerance / 10, 0.5)

    def _at(self, time: float) -> Array:
        return self.reference.at(np.array([time])).ravel()

    def watched(self, path: Trajectory) -> Array:
        """(N, 2n) what has a limit or is an index: τ and e."""
        inputs = path.y.T, self.reference.at(path.t).reshape(len(path.t), -1).T
        tau = np.array(self.loop.signals().map(path.t.size)(*inputs)[0]).T
        return np.hstack((tau, path.y[:, : self.controlled.n]))

    def run(self, path: Trajectory, accuracy: float) -> TrackingRun:
        """Everything that can be computed from the samples of a path."""
        n, model = self.controlled.n, self.model
        goal = self.reference.at(path.t)
        inputs = (path.y.T, goal.reshape(len(path.t), -1).T)
        tau, energy = (np.array(x) for x in self.loop.signals().map(path.t.size)(*inputs))
        e, w = path.y[:, :n], path.y[:, n : 2 * n]
        motion = TrackingMotion(path.t, goal[:, 0] - e, e, w, tau.T, goal[:, 0], goal[:, 1], goal[:, 2])
        V, dV = energies(self.controlled, self.gains, self.promise.eps0, motion)
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
            without_dry_friction=model.dry,
            breach=broken(self.controlled, model.torque_limit, self.promise, motion, V, dV, bound),
        )


def _imbalance(energy: Array, work: Array) -> float:
    """The largest |E(t) − E(0) − W(t)|, relative to the largest change of energy or work of the run."""
    change = energy - energy[0]
    scale = max(float(np.max(np.abs(change))), float(np.max(np.abs(work))), LEAST_ENERGY)
    return float(np.max(np.abs(change - work))) / scale


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
