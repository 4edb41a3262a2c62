"""The reference simulation: the closed loop (11) as written, with nothing of the bench."""

from __future__ import annotations

import math
from abc import ABC, abstractmethod
from collections.abc import Callable, Sequence
from dataclasses import replace
from pathlib import Path
from typing import TYPE_CHECKING, Any, ClassVar, Generic, TypeVar

import casadi as ca
import numpy as np

from lyapcheck._types import Array, Progress, silent
from lyapcheck.control.gains import one_gain_set
from lyapcheck.lyapunov import graph
from lyapcheck.lyapunov.along import solve_definite
from lyapcheck.lyapunov.graph import at_symbols
from lyapcheck.robots import arm_of
from lyapcheck.simulate.breach import (
    beyond_bounds,
    beyond_limits,
    beyond_norm,
    first_breach,
    noise_of,
    rise_of_rate,
    rise_of_V,
)
from lyapcheck.simulate.integrate import MAX_STEPS, Compiled, Trajectory, integrate, with_extremes
from lyapcheck.simulate.results import imbalance, l2_of, motion_of, observe
from lyapcheck.simulate.run import Breach, Motion, PromiseBroken, Run, SimulationFailed
from lyapcheck.simulate.task import Setup, set_up

if TYPE_CHECKING:
    from lyapcheck.control.gains import GainSet
    from lyapcheck.robots import ArmLike


Moved = TypeVar("Moved", bound=Motion)


class Course(ABC, Generic[Moved]):
    """One controller on one arm, and where it is to go: (11), or (21) for a goal that moves, as a graph.

    M(q) ẇ = K_p h(e) − K_v h(w) − B w − C(q, q̇) w, with e = q_d − q and w = q̇ − q̇_d, uncertain parameters at
    their nominal values. The state y holds q and w, or e and w along a reference, n each, then an energy D
    or W and S with S' = ‖e‖²: these ride along so that the account of energy and the L2 index are as accurate
    as the motion itself. For a goal at rest D is the energy that damping has taken, D' = wᵀBw + wᵀK_v h(w),
    and E = ½wᵀMw + Σ k_pi U(e_i), so that E' = −D'. For one that moves W' = q̇ᵀ(τ − B q̇) is the power that
    reaches the arm, so that its energy ½ q̇ᵀM q̇ + P(q) must change by W: τ of (21) moves the arm (1) as the
    error system says.

    Args:
        setup: controller, arm and task.
        y0: (2n,) the state at the start, without what rides along.
        points: samples of the run.
        moving: whether the goal moves.

    Attributes:
        state: (2n + 2,) SX, y.
        target: SX, q_d, or q_d, q̇_d and q̈_d.
        rate: (2n + 2,) SX, ẏ.
        torque: (n,) SX, τ.
        energy: SX, what the account of energy is of.

    References: (1), (6), (11), (21) of ``reyes2019family``.
    """

    of_extremes: ClassVar[tuple[str, ...]] = ("indices",)
    """Fields of the run that are computed with what lies between its samples."""
    easier: ClassVar[float] = 1.0
    """How much less accurate the energy that rides along may be."""

    def __init__(self, setup: Setup, y0: Sequence[float], points: int, moving: bool = False) -> None:
        self.setup, self.points, self.y0 = setup, points, np.array([*y0, 0.0, 0.0])
        controlled = setup.controlled
        self.n = n = controlled.n
        self.state = state = ca.SX.sym("y", 2 * n + 2)
        self.target = goal = ca.SX.sym("goal", 3 * n if moving else n)
        first, w, other = state[:n], state[n : 2 * n], goal[:n] - state[:n]
        q, e = (other, first) if moving else (first, other)
        of: dict[str, Any] = {"speed": goal[n : 2 * n], "acceleration_d": goal[2 * n :]} if moving else {}
        gains = ca.DM(controlled.kp), ca.DM(controlled.kv), controlled.family.casadi
        at = at_symbols(setup.model, q, e, w, *gains, **of)
        self.torque, velocity = ca.vertcat(*at.torque()), ca.vertcat(*at.velocity)
        change, self.energy = at.damping(), at.value(0.0)
        if moving:
            change = ca.dot(velocity, self.torque - ca.DM(at.viscous) * velocity)
            self.energy = ca.bilin(graph.matrix(at.mass), velocity, velocity) / 2 + at.arm.potential()
        self.rate = ca.vertcat(-w if moving else w, *at.acceleration(), change, ca.dot(e, e))

    @abstractmethod
    def goal(self, t: Array) -> Array:
        """(N, k) the goal at times (N,) in s."""

    def at(self, time: float) -> Array:
        """(k,) the same at one time."""
        row: Array = self.goal(np.array([time]))[0]
        return row

    @abstractmethod
    def run(self, path: Trajectory, accuracy: float) -> Moved:
        """Everything that can be computed from the samples of a path."""

    @staticmethod
    @abstractmethod
    def breaches(setup: Setup, run: Moved) -> Sequence[Breach | None]:
        """Where a run first breaks each promise."""

    @abstractmethod
    def watched(self, path: Trajectory) -> Array:
        """(N, k) what has a limit or is an index."""

    def signals(self, path: Trajectory) -> tuple[Array, Array]:
        """τ (N, n) in N·m and the energy (N,) in J of a path."""
        both = ca.Function("signals", [self.state, self.target], [self.torque, self.energy])
        tau, energy = both.map(path.t.size)(path.y.T, self.goal(path.t).T)
        return np.array(tau).T, np.array(energy)[0]

    def once(
        self, tolerance: float, max_steps: int = MAX_STEPS, on_time: Callable[[float], None] | None = None
    ) -> Trajectory:
        """The motion at its samples, or as many of them as were reached."""
        y, goal, right = self.state, self.target, ca.densify(self.rate)
        rate = Compiled(ca.Function("rate", [y, goal], [right]))
        jacobian = Compiled(ca.Function("jacobian", [y, goal], [ca.densify(ca.jacobian(right, y))]))
        weights = np.ones(self.y0.size)
        weights[-2] = self.easier
        return integrate(
            lambda time, y: rate(y, self.at(time)),
            lambda time, y: jacobian(y, self.at(time)),
            self.y0,
            np.linspace(0.0, self.setup.task.T, self.points),
            tolerance * weights,
            max_steps=max_steps,
            on_time=on_time,
        )

    def moved(self, tolerance: float, max_steps: int, stop: bool, progress: Progress) -> Moved:
        """The run, integrated again ten times tighter, with the first promise that it broke.

        Raises:
            SimulationFailed: the integrator gave up; carries what was reached.
            PromiseBroken: a promise was broken, and ``stop``; carries the run up to that state.
        """
        T = self.setup.task.T
        rough = self.once(tolerance, max_steps, lambda time: progress(0.5 * time / T, ""))
        fine = self.once(tolerance / 10, max_steps, lambda time: progress(0.5 + 0.5 * time / T, ""))
        failure, title = fine.failure or rough.failure, self.setup.title
        accuracy = math.nan if failure else float(np.max(np.abs(fine.y - rough.y)[:, :-2]))
        with np.errstate(over="ignore", invalid="ignore"):  # gains beyond all sense end as inf, not as noise
            every = with_extremes(fine, self.watched)
            seen = self.run(every, accuracy)
            breach = first_breach(self.breaches(self.setup, seen))
            if breach is not None and stop:
                fine = fine.until(breach.t)
                seen = self.run(every.until(breach.t), accuracy)
            known = {name: getattr(seen, name) for name in self.of_extremes}
            run = replace(self.run(fine, accuracy), **known, breach=breach)
        if breach is not None and stop:
            raise PromiseBroken(f"{title}: {breach.sentence}", run, breach)
        if failure is not None:
            raise SimulationFailed(f"{title}: {failure}", run)
        return run


TOLERANCE = 1e-11
"""Relative tolerance of the first integration; the one handed back is ten times tighter."""
CREEP = 1e-3
"""rad/s: dry friction is f tanh(w/creep), so that a joint that should stick creeps."""
POINTS = 2001
"""Samples of a run: every 2.5 ms of the paper's five seconds."""


def simulate(
    gain_set: GainSet | str | Path,
    model: ArmLike,
    target_rad: Sequence[float],
    start_rad: Sequence[float] | None = None,
    velocity_rad: Sequence[float] | None = None,
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
        target_rad: (n,) goal in rad.
        start_rad: (n,) start in rad. Default: 0.
        velocity_rad: (n,) initial velocities in rad/s. Default: 0.
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
    setup = set_up(gain_set, model, target_rad, start_rad, velocity_rad, T=T, eps0=eps0, points=points)
    return SetPoint(setup, points).moved(tolerance, max_steps, stop, on_progress or silent)


class SetPoint(Course[Run]):
    """The way to a set point; ``dry``: against dry friction f tanh(w/creep) of so many N·m a joint."""

    of_extremes = ("indices", "promises")

    def __init__(self, setup: Setup, points: int, dry: Sequence[float] = ()) -> None:
        self._still = np.array(setup.task.q_d)
        super().__init__(setup, [*setup.task.q0, *setup.task.w0], points)
        if dry:
            q, w = self.state[: self.n], self.state[self.n : 2 * self.n]
            mass, friction = graph.at_angles(setup.model, q).mass(), -ca.DM(list(dry)) * ca.tanh(w / CREEP)
            slowed = solve_definite(mass, ca.vertsplit(friction))
            self.rate += ca.vertcat(ca.SX.zeros(self.n), *slowed, 0, 0)

    def goal(self, t: Array) -> Array:
        return np.tile(self._still, (t.size, 1))

    def at(self, time: float) -> Array:
        return self._still

    def run(self, path: Trajectory, accuracy: float) -> Run:
        n, setup, t, y = self.n, self.setup, path.t, path.y
        tau, energy = self.signals(path)
        L2, whole, q = l2_of(y[-1, -1], t[-1]), path.failure is None, y[:, :n]
        fields = motion_of(setup, "reference", t, self.goal(t) - q, q, y[:, n:-2], tau, L2=L2, complete=whole)
        V = fields["V"]
        return Run(
            **fields,
            accuracy=accuracy,
            promises=observe(t, V, tau, setup.controlled, noise=noise_of(V)),
            energy_balance=imbalance(energy + y[:, -2] - energy[0], energy, y[:, -2]),
        )

    @staticmethod
    def breaches(setup: Setup, run: Run) -> Sequence[Breach | None]:
        joints = beyond_bounds(run, "its bound from (9)", run.promises.joint_bounds)
        norm = beyond_norm(run, "the bound (9)", run.promises.torque_bound)
        return rise_of_rate(setup, run), rise_of_V(run), beyond_limits(setup, run), joints, norm

    def watched(self, path: Trajectory) -> Array:
        """τ, ‖τ‖² and e; and dV/dt where V is not the energy."""
        n, setup = self.n, self.setup
        tau, q, w = self.signals(path)[0], path.y[:, :n], path.y[:, n:-2]
        e = self.goal(path.t) - q
        columns = [tau, np.sum(tau * tau, axis=1, keepdims=True), e]
        if setup.eps0:
            columns.append(setup.controlled.watched(setup.eps0).rate(q, e, w)[:, None])
        return np.hstack(columns)
