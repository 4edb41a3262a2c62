"""Many runs from random starts: how the indices of one controller are distributed."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

from lyapcheck._types import Array, Progress
from lyapcheck.lyapunov.numeric import LyapunovNumeric
from lyapcheck.simulate.breach import LEAST_ENERGY, V_NOISE
from lyapcheck.simulate.closed_loop import simulate
from lyapcheck.simulate.many import Runs, simulate_many
from lyapcheck.simulate.results import torque_limits
from lyapcheck.simulate.run import Breach
from lyapcheck.simulate.task import Gains, Task, gains_for

if TYPE_CHECKING:
    from lyapcheck.control.gains import GainSet
    from lyapcheck.robots import RobotModel


MOST_RUNS = 100_000
"""Runs of one gain set; so many of the paper's arm take about ten seconds."""

SHARES = (0.0, 0.05, 0.5, 0.95, 1.0)
"""The quantiles that are shown."""


@dataclass(frozen=True)
class Starts:
    """Starts drawn evenly from a box of joint angles."""

    count: int
    spread: float
    """rad, half the side of the box."""
    seed: int

    def around(self, q0: Sequence[float]) -> Array:
        """(count, n) angles in rad about a posture; the same for the same seed."""
        rng = np.random.default_rng(self.seed)
        return np.array(q0) + rng.uniform(-self.spread, self.spread, (self.count, len(q0)))

    def motions(self, q0: Sequence[float]) -> tuple[Array, Array]:
        """(count, n) starts as `around`, and goals a quarter to all of the spread towards the middle."""
        starts, rng = self.around(q0), np.random.default_rng([self.seed, 1])
        step = self.spread * rng.uniform(0.25, 1.0, starts.shape)
        return starts, starts - np.copysign(step, starts - np.array(q0))


@dataclass(frozen=True, eq=False)
class Sweep:
    """The runs of one gain set from random starts."""

    gains: Gains
    robot: str
    joints: tuple[str, ...]
    task: Task
    """Of which q0 is the middle of the starts."""
    starts: Starts
    q0: Array
    """(R, n) rad"""
    runs: Runs
    eps0: float
    risen: NDArray[np.bool_]
    """(R,) whether V rose by more than the run's own error."""
    beyond: NDArray[np.bool_]
    """(R,) whether a torque left its motor's limit."""
    notes: tuple[str, ...]
    breach: Breach | None
    """What the first run that broke a promise says when it is run alone."""
    without_dry_friction: bool = False
    """Whether the arm file gives dry friction that the run leaves out."""

    @property
    def name(self) -> str:
        """The name of the gain set."""
        return self.gains.name

    @property
    def finished(self) -> int:
        """How many runs reached their end."""
        return int(np.count_nonzero(self.runs.complete))


def sweep(
    gain_set: GainSet,
    model: RobotModel,
    task: Task,
    starts: Starts,
    *,
    eps0: float = 0.0,
    on_progress: Progress | None = None,
) -> Sweep:
    """Run one controller from random starts.

    Args:
        gain_set: the controller.
        model: the arm; uncertain parameters at their nominal values.
        task: goal, initial rates and duration; the starts lie about its q0.
        starts: how many, how far, and the seed.
        eps0: the ε₀ of V.
        on_progress: receives the fraction done.

    Soundness: floating point throughout; a finite number of runs says nothing of the others.
    """
    q0 = starts.around(task.q0)
    rates = np.array(task.w0)
    runs = simulate_many(
        gain_set, model, task.q_d, q0, task.T, w0=rates, eps0=eps0, points=2, on_progress=on_progress
    )
    gains = gains_for(gain_set, model.n)
    numeric = LyapunovNumeric(model, gains.family, gains.kp, gains.kv, eps0)
    first = numeric.V(q0, np.array(task.q_d) - q0, np.array(task.w0))
    limits = np.array([np.inf if most is None else most for most in torque_limits(model)])
    result = Sweep(
        gains=gains,
        robot=model.name,
        joints=model.joints,
        task=task,
        starts=starts,
        q0=q0,
        runs=runs,
        eps0=eps0,
        risen=runs.V_rise > V_NOISE * np.maximum(first, LEAST_ENERGY),
        beyond=np.any(runs.peak_torque > limits, axis=1),
        notes=model.assumptions,
        breach=None,
        without_dry_friction=model.dry,
    )
    return _explained(result, gain_set, model)


def _explained(result: Sweep, gain_set: GainSet, model: RobotModel) -> Sweep:
    """The same with the breach of the first run that broke a promise, from running it alone."""
    broken = np.flatnonzero((result.risen | result.beyond) & result.runs.complete)
    if not broken.size:
        return result
    start, task = result.q0[broken[0]].tolist(), result.task
    run = simulate(gain_set, model, task.q_d, start, task.w0, task.T, eps0=result.eps0, stop=False)
    return replace(result, breach=run.breach)


def quantiles(values: Array) -> list[float]:
    """The `SHARES` of the numbers that are there; NaN where there are none."""
    known = values[np.isfinite(values)]
    return [float(x) for x in np.quantile(known, SHARES)] if known.size else [float("nan")] * len(SHARES)
