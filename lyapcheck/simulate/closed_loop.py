"""The reference simulation: the closed loop (11) as written, with nothing of the bench."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass, replace
from pathlib import Path
from typing import TYPE_CHECKING, Any

import casadi as ca
import numpy as np

from lyapcheck._types import Array, Progress, silent
from lyapcheck.control.gains import one_gain_set
from lyapcheck.lyapunov.graph import at_symbols
from lyapcheck.lyapunov.numeric import LyapunovNumeric
from lyapcheck.robots.registry import arm_of
from lyapcheck.simulate.breach import (
    Breach,
    Watched,
    bound_monitor,
    fall_monitor,
    first_breach,
    joint_monitor,
    limit_monitor,
    rate_monitor,
)
from lyapcheck.simulate.integrate import MAX_STEPS, Compiled, Trajectory, integrate, with_extremes
from lyapcheck.simulate.results import LEAST_ENERGY, Motion, noise_of, run_of
from lyapcheck.simulate.run import PromiseBroken, Run, SimulationFailed
from lyapcheck.simulate.task import Gains, Setup, set_up

if TYPE_CHECKING:
    from lyapcheck.control.gains import GainSet
    from lyapcheck.robots import RobotModel


# --- The closed loop (11) as one differentiable graph, and as compiled functions of it.


@dataclass(frozen=True)
class LoopDynamics:
    """The state y = (q, w, D, S) of a run and its rate, with q_d as a parameter.

    D is the energy that damping has taken, D' = wᵀBw + wᵀK_v h(w), and S' = ‖e‖²: both ride along so that
    the energy balance and the L2 index are as accurate as the motion itself.
    """

    n: int
    state: Any
    """(2n + 2,) SX."""
    goal: Any
    """(n,) SX, q_d."""
    rate: Any
    """(2n + 2,) SX, ẏ along (11)."""
    torque: Any
    """(n,) SX, τ of (6)."""
    energy: Any
    """SX, E = ½wᵀMw + Σ k_pi U(e_i), so that E' = −D'."""

    def compiled_rate(self) -> Compiled:
        """(y, q_d) ↦ ẏ."""
        return Compiled(ca.Function("rate", [self.state, self.goal], [ca.densify(self.rate)]))

    def compiled_jacobian(self) -> Compiled:
        """(y, q_d) ↦ ∂ẏ/∂y."""
        jacobian = ca.densify(ca.jacobian(self.rate, self.state))
        return Compiled(ca.Function("jacobian", [self.state, self.goal], [jacobian]))

    def signals(self) -> Any:
        """The CasADi function (y, q_d) ↦ (τ, E)."""
        return ca.Function("signals", [self.state, self.goal], [self.torque, self.energy])


def closed_loop(gains: Gains, model: RobotModel) -> LoopDynamics:
    """The graph of (11) for one controller on one arm, uncertain parameters at their nominal values.

    M(q) ẇ = K_p h(e) − K_v h(w) − B w − C(q, w) w, with e = q_d − q.

    References: (6), (11) of ``reyes2019family``.
    """
    n = model.n
    state, goal = ca.SX.sym("y", 2 * n + 2), ca.SX.sym("q_d", n)
    q, w = state[:n], state[n : 2 * n]
    e, gain = goal - q, (ca.DM(gains.kp), ca.DM(gains.kv))
    at = at_symbols(model, q, e, w, *gain, gains.family.casadi)
    rate = ca.vertcat(w, *at.acceleration(), at.damping(), ca.dot(e, e))
    return LoopDynamics(n, state, goal, rate, ca.vertcat(*at.torque()), at.value(0.0))


TOLERANCE = 1e-11
"""Relative tolerance of the first integration; the one handed back is ten times tighter."""

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
    """Move an arm under (6), or under PD with gravity compensation, along the closed loop (11).

    ė = −w, M(q) ẇ = K_p h(e) − K_v h(w) − B w − C(q, w) w. The integration is done twice, the second
    time ten times tighter; the second is handed back and their difference is its ``accuracy``.

    Args:
        gain_set: the controller, of any family, or the path of a gain file with one gain set.
        model: the arm, its name or its file; uncertain parameters are at their nominal values.
        q_d: (n,) goal in rad.
        q0: (n,) start in rad; home if missing.
        w0: (n,) initial rates in rad/s; rest if missing.
        T: seconds.
        eps0: the ε₀ of V; 0 if missing, and then V is the energy.
        points: samples handed back, evenly spaced, both ends included. Indices, promises and breaches are
            of the integrator's dense output, extremes between samples included.
        tolerance: relative tolerance of the first integration.
        max_steps: a budget for each integration.
        stop: end the run at the first state that breaks a promise: dV/dt ≤ 0, the bound (9), a motor's limit.
        on_progress: receives the fraction done.

    Raises:
        InputError: a task the arm cannot be given.
        SimulationFailed: the integrator gave up; carries what was reached.
        PromiseBroken: a promise was broken; carries the run up to that state.

    Soundness: floating point throughout: evidence, never a proof. ``accuracy`` is an estimate. A ``breach``
        that is ``confirmed`` is proved in balls, as a statement about its state.

    References: (6), (11), (12), (20) of ``reyes2019family``.
    """
    gain_set, model = one_gain_set(gain_set), arm_of(model)
    setup = set_up(gain_set, model, q_d, q0, w0, T=T, eps0=eps0, points=points)
    loop = closed_loop(setup.gains, model)
    rough, fine = _twice(
        loop, setup, points, tolerance, max_steps=max_steps, on_progress=on_progress or silent
    )
    failure = fine.failure or rough.failure
    accuracy = math.nan if failure else _difference(rough, fine, model.n)
    with np.errstate(over="ignore", invalid="ignore"):  # gains beyond all sense end as inf, not as noise
        every = with_extremes(fine, lambda path: _watched(loop, setup, path))
        seen = _reference(loop, setup, every, accuracy)
        breach = _broken(setup, seen)
        if breach is not None and stop:
            fine = fine.until(breach.t)
            seen = _reference(loop, setup, every.until(breach.t), accuracy)
        run = _reference(loop, setup, fine, accuracy)
        run = replace(run, indices=seen.indices, promises=seen.promises, breach=breach)
    if breach is not None and stop:
        raise PromiseBroken(f"{setup.title}: {breach.sentence}", run, breach)
    if failure is not None:
        raise SimulationFailed(f"{setup.title}: {failure}", run)
    return run


def _watched(loop: LoopDynamics, setup: Setup, path: Trajectory) -> Array:
    """(N, 2n + 1) what has a limit or is an index: τ, ‖τ‖² and e; and dV/dt where V is not the energy."""
    n, goal = loop.n, np.array(setup.task.q_d)
    tau = np.array(loop.signals().map(path.t.size)(path.y.T, goal)[0]).T
    q, w = path.y[:, :n], path.y[:, n : 2 * n]
    columns = [tau, np.sum(tau * tau, axis=1, keepdims=True), goal - q]
    if setup.eps0:
        gains = setup.gains
        certificate = LyapunovNumeric(setup.model, gains.family, gains.kp, gains.kv, setup.eps0)
        columns.append(certificate.rate(q, goal - q, w)[:, None])
    return np.hstack(columns)


def _broken(setup: Setup, run: Run) -> Breach | None:
    """The first promise that the samples break."""
    signals = (run.t, run.q, run.e, run.w, run.tau, run.V, run.dV)
    watched = Watched(setup.controlled, setup.eps0, *signals, noise=noise_of(run.V))
    bound = bound_monitor("the bound (9)", run.promises.torque_bound)
    joints = joint_monitor("its bound from (9)", run.promises.joint_bounds)
    return first_breach(
        watched, (rate_monitor, fall_monitor, limit_monitor(setup.model.torque_limit), joints, bound)
    )


def _twice(
    loop: LoopDynamics, setup: Setup, points: int, tolerance: float, *, max_steps: int, on_progress: Progress
) -> tuple[Trajectory, Trajectory]:
    rate, jacobian, task = loop.compiled_rate(), loop.compiled_jacobian(), setup.task
    goal, t = np.array(task.q_d), np.linspace(0.0, task.T, points)
    y0 = np.array([*task.q0, *task.w0, 0.0, 0.0])

    def once(tolerance: float, done: float) -> Trajectory:
        return integrate(
            lambda _, y: rate(y, goal),
            lambda _, y: jacobian(y, goal),
            y0,
            t,
            tolerance,
            max_steps=max_steps,
            on_time=lambda time: on_progress(done + 0.5 * time / task.T, ""),
        )

    return once(tolerance, 0.0), once(tolerance / 10, 0.5)


def _difference(rough: Trajectory, fine: Trajectory, n: int) -> float:
    """The largest change of q or w between two solutions."""
    return float(np.max(np.abs(fine.y - rough.y)[:, : 2 * n]))


def _reference(loop: LoopDynamics, setup: Setup, path: Trajectory, accuracy: float) -> Run:
    n, y = loop.n, path.y
    tau, energy = (np.array(x) for x in loop.signals().map(y.shape[0])(y.T, np.array(setup.task.q_d)))
    return run_of(
        setup,
        Motion("reference", path.t, y[:, :n], y[:, n : 2 * n], tau.T),
        accuracy=accuracy,
        energy_balance=_imbalance(energy[0], y[:, 2 * n]),
        L2=math.degrees(math.sqrt(max(y[-1, -1], 0.0) / path.t[-1])) if path.t[-1] > 0 else math.nan,
        complete=path.failure is None,
    )


def _imbalance(energy: Array, dissipated: Array) -> float:
    """The largest |E(t) + D(t) − E(0)|, relative to the largest energy of the run."""
    scale = max(float(np.max(np.abs(energy))), float(np.max(np.abs(dissipated))), LEAST_ENERGY)
    return float(np.max(np.abs(energy + dissipated - energy[0]))) / scale
