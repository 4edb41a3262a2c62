"""A tracking run made ready: loop, start, promises; its integration, and the run of its samples."""

from __future__ import annotations

from fractions import Fraction
from typing import TYPE_CHECKING

import numpy as np

from lyapcheck._types import Array, Progress
from lyapcheck.search.controlled_arm import ControlledArm
from lyapcheck.simulate.gains import gains_for
from lyapcheck.simulate.integrate import Trajectory, integrate
from lyapcheck.simulate.monitor import torque_limits
from lyapcheck.simulate.results import LEAST_ENERGY
from lyapcheck.tracking.form import TrackingForm, tracking_form
from lyapcheck.tracking.loop import TrackingLoop, tracking_loop
from lyapcheck.tracking.reference import Reference
from lyapcheck.tracking.request import TrackingRequest
from lyapcheck.tracking.results import bound_of, broken, energies, indices_of
from lyapcheck.tracking.run import Promise, TrackingMotion, TrackingRun
from lyapcheck.tracking.torque import torque_bounds

if TYPE_CHECKING:
    from lyapcheck.control.gains import GainSet
    from lyapcheck.robots import RobotModel


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
