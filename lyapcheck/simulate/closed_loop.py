"""The reference simulation: the closed loop (11) as written, with nothing of the bench."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace
from pathlib import Path
from typing import TYPE_CHECKING

import casadi as ca
import numpy as np

from lyapcheck._types import Array, Progress, silent
from lyapcheck.control.gains import one_gain_set
from lyapcheck.lyapunov.graph import at_symbols
from lyapcheck.lyapunov.numeric import LyapunovNumeric
from lyapcheck.robots import graph
from lyapcheck.robots.registry import arm_of
from lyapcheck.simulate.breach import (
    Monitor,
    bound_monitor,
    fall_monitor,
    joint_monitor,
    limit_monitor,
    noise_of,
    rate_monitor,
)
from lyapcheck.simulate.course import Course, Loop
from lyapcheck.simulate.integrate import MAX_STEPS, Trajectory
from lyapcheck.simulate.results import imbalance, l2_of, motion_of, observe
from lyapcheck.simulate.run import Run
from lyapcheck.simulate.task import Gains, Setup, set_up

if TYPE_CHECKING:
    from lyapcheck.control.gains import GainSet
    from lyapcheck.robots import RobotModel


def closed_loop(gains: Gains, model: RobotModel) -> Loop:
    """The graph of (11) for one controller on one arm, uncertain parameters at their nominal values.

    M(q) ẇ = K_p h(e) − K_v h(w) − B w − C(q, w) w, with e = q_d − q. D is the energy that damping has taken,
    D' = wᵀBw + wᵀK_v h(w), and E = ½wᵀMw + Σ k_pi U(e_i), so that E' = −D'.

    References: (6), (11) of ``reyes2019family``.
    """
    n = model.n
    state, goal = ca.SX.sym("y", 2 * n + 2), ca.SX.sym("q_d", n)
    q, w = state[:n], state[n : 2 * n]
    e, gain = goal - q, (ca.DM(gains.kp), ca.DM(gains.kv))
    at = at_symbols(model, q, e, w, *gain, gains.family.casadi)
    rate = ca.vertcat(w, *at.acceleration(), at.damping(), ca.dot(e, e))
    return Loop(n, state, goal, rate, ca.vertcat(*at.torque()), at.value(0.0))


TOLERANCE = 1e-11
"""Relative tolerance of the first integration; the one handed back is ten times tighter."""

CREEP = 1e-3
"""rad/s: dry friction is f tanh(w/creep), so that a joint that should stick creeps."""

POINTS = 2001
"""Samples of a run: every 2.5 ms of the paper's five seconds."""


def simulate(
    gain_set: GainSet | str | Path,
    model: RobotModel | str | Path,
    q_d: Sequence[float],
    q0: Sequence[float] | None = None,
    w0: Sequence[float] | None = None,
    T: float = 5.0,
    *,
    eps0: float | None = None,
    points: int = POINTS,
    tolerance: float = TOLERANCE,
    max_steps: int = MAX_STEPS,
    stop: bool = True,
    on_progress: Progress | None = None,
) -> Run:
    """Simulate an arm under (6), or under PD with gravity compensation, by the closed loop (11).

    ė = −w, M(q) ẇ = K_p h(e) − K_v h(w) − B w − C(q, w) w. The integration is done twice, the second
    time ten times tighter. The second run is returned, and the difference is its ``accuracy``.

    Args:
        gain_set: the controller, of any family, or the path of a gain file with one gain set.
        model: the arm, its name or its file; uncertain parameters have nominal values.
        q_d: (n,) goal in rad.
        q0: (n,) start in rad. Default: 0.
        w0: (n,) initial velocities in rad/s. Default: 0.
        T: seconds.
        eps0: the ε₀ of V. Default: 0, and V is the energy.
        points: number of returned samples, evenly spaced with both ends. Indices and violations use the
            integrator's dense output between samples.
        tolerance: relative tolerance of the first integration.
        max_steps: a budget for each integration.
        stop: end the run at the first state that violates dV/dt ≤ 0, the bound (9) or a motor limit.
        on_progress: receives the fraction done.

    Raises:
        InputError: a task the arm cannot be given.
        SimulationFailed: the integrator stopped. The error has the run so far.
        PromiseBroken: a bound was violated. The error has the run up to that state.

    Soundness: floating point throughout, which is evidence and never a proof. ``accuracy`` is an estimate.
        A ``breach`` that is ``confirmed`` is proved in balls, as a statement about its state.

    References: (6), (11), (12), (20) of ``reyes2019family``.
    """
    gain_set, model = one_gain_set(gain_set), arm_of(model)
    setup = set_up(gain_set, model, q_d, q0, w0, T=T, eps0=eps0, points=points)
    return SetPoint(setup, points).moved(tolerance, max_steps, stop, on_progress or silent)


class SetPoint(Course[Run]):
    """The way to a set point; ``dry``: against dry friction f tanh(w/creep) of so many N·m a joint."""

    of_extremes = ("indices", "promises")

    def __init__(self, setup: Setup, points: int, dry: Sequence[float] = ()) -> None:
        loop = closed_loop(setup.gains, setup.model)
        if dry:
            q, w = loop.state[: loop.n], loop.state[loop.n : 2 * loop.n]
            slowed = graph.solve(graph.mass(setup.model, q), -ca.DM(list(dry)) * ca.tanh(w / CREEP))
            loop = replace(loop, rate=loop.rate + ca.vertcat(ca.SX.zeros(loop.n), slowed, 0, 0))
        self._still = np.array(setup.task.q_d)
        super().__init__(setup, loop, [*setup.task.q0, *setup.task.w0], points)

    def goal(self, t: Array) -> Array:
        """See `Course.goal`."""
        return np.tile(self._still, (t.size, 1))

    def at(self, time: float) -> Array:
        """See `Course.at`; asked for at every step, and always the same."""
        return self._still

    def run(self, path: Trajectory, accuracy: float) -> Run:
        """See `Course.run`."""
        n, setup, t, y = self.loop.n, self.setup, path.t, path.y
        tau, energy = self.signals(path)
        L2, whole, q = l2_of(y[-1, -1], t[-1]), path.failure is None, y[:, :n]
        fields = motion_of(setup, "reference", t, self.goal(t) - q, q, y[:, n:-2], tau, L2=L2, complete=whole)
        V = fields["V"]
        return Run(
            **fields,
            accuracy=accuracy,
            promises=observe(t, V, tau, setup.gains, setup.model, noise=noise_of(V)),
            energy_balance=imbalance(energy + y[:, -2] - energy[0], energy, y[:, -2]),
        )

    @staticmethod
    def monitors(run: Run) -> Sequence[Monitor]:
        """See `Course.monitors`."""
        bound = bound_monitor("the bound (9)", run.promises.torque_bound)
        joints = joint_monitor("its bound from (9)", run.promises.joint_bounds)
        return rate_monitor, fall_monitor, limit_monitor, joints, bound

    def watched(self, path: Trajectory) -> Array:
        """τ, ‖τ‖² and e; and dV/dt where V is not the energy."""
        n, setup = self.loop.n, self.setup
        tau, q, w = self.signals(path)[0], path.y[:, :n], path.y[:, n:-2]
        e = self.goal(path.t) - q
        columns = [tau, np.sum(tau * tau, axis=1, keepdims=True), e]
        if setup.eps0:
            gains = setup.gains
            certificate = LyapunovNumeric(setup.model, gains.family, gains.kp, gains.kv, setup.eps0)
            columns.append(certificate.rate(q, e, w)[:, None])
        return np.hstack(columns)
