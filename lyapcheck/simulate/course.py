"""What all simulations by the equations have in common: a graph, its integration, its run."""

from __future__ import annotations

import math
from abc import ABC, abstractmethod
from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace
from typing import Any, ClassVar, Generic, TypeVar

import casadi as ca
import numpy as np

from lyapcheck._types import Array, Progress
from lyapcheck.simulate.breach import Monitor, first_breach
from lyapcheck.simulate.integrate import MAX_STEPS, Compiled, Trajectory, integrate, with_extremes
from lyapcheck.simulate.run import Motion, PromiseBroken, SimulationFailed
from lyapcheck.simulate.task import Setup

Moved = TypeVar("Moved", bound=Motion)


@dataclass(frozen=True)
class Loop:
    """The state y of a run and its rate, with the goal as a parameter: q_d, or q_d, q̇_d and q̈_d.

    y holds position and rate, n each, then an energy D or W and S with S' = ‖e‖²: these ride along so that
    the account of energy and the L2 index are as accurate as the motion itself.
    """

    n: int
    state: Any
    """(2n + 2,) SX."""
    goal: Any
    """(n,) or (3n,) SX."""
    rate: Any
    """(2n + 2,) SX."""
    torque: Any
    """(n,) SX, τ."""
    energy: Any
    """SX, what the account of energy is of."""

    def compiled_rate(self) -> Compiled:
        """(y, goal) ↦ ẏ."""
        return Compiled(ca.Function("rate", [self.state, self.goal], [ca.densify(self.rate)]))

    def compiled_jacobian(self) -> Compiled:
        """(y, goal) ↦ ∂ẏ/∂y."""
        jacobian = ca.densify(ca.jacobian(self.rate, self.state))
        return Compiled(ca.Function("jacobian", [self.state, self.goal], [jacobian]))

    def signals(self) -> Any:
        """The CasADi function (y, goal) ↦ (τ, energy)."""
        return ca.Function("signals", [self.state, self.goal], [self.torque, self.energy])


class Course(ABC, Generic[Moved]):
    """One controller on one arm, and where it is to go.

    Args:
        setup: controller, arm and task.
        loop: what moves.
        y0: (2n,) position and rate at the start, as the loop has them.
        points: samples of the run.
    """

    of_extremes: ClassVar[tuple[str, ...]] = ("indices",)
    """Fields of the run that are computed with what lies between its samples."""
    easier: ClassVar[float] = 1.0
    """How much less accurate the energy that rides along may be."""

    def __init__(self, setup: Setup, loop: Loop, y0: Sequence[float], points: int) -> None:
        self.setup, self.loop, self.points = setup, loop, points
        self.y0 = np.array([*y0, 0.0, 0.0])

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
    def monitors(run: Moved) -> Sequence[Monitor]:
        """What is promised of a run."""

    @abstractmethod
    def watched(self, path: Trajectory) -> Array:
        """(N, k) what has a limit or is an index."""

    def signals(self, path: Trajectory) -> tuple[Array, Array]:
        """τ (N, n) in N·m and the energy (N,) in J of a path."""
        tau, energy = self.loop.signals().map(path.t.size)(path.y.T, self.goal(path.t).T)
        return np.array(tau).T, np.array(energy)[0]

    def once(
        self, tolerance: float, max_steps: int = MAX_STEPS, on_time: Callable[[float], None] | None = None
    ) -> Trajectory:
        """The motion at its samples, or as many of them as were reached."""
        rate, jacobian = self.loop.compiled_rate(), self.loop.compiled_jacobian()
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
            breach = first_breach(self.setup, seen, self.monitors(seen))
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
