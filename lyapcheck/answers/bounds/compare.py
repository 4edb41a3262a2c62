"""The certified bounds of one gain set for one task, and the simulated motion."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from lyapcheck._types import Array, Progress
from lyapcheck.answers.bounds.kept import kept_bounds
from lyapcheck.search.controlled_arm import ControlledArm
from lyapcheck.simulate.disturbed import disturbed

if TYPE_CHECKING:
    from lyapcheck.control.gains import GainSet
    from lyapcheck.robots import RobotModel
    from lyapcheck.search.decay_results import DisturbanceBound, SettlingBound
    from lyapcheck.simulate.task import Task


JUST_INSIDE = 0.95
"""Where a run starts, beside the certified bound of rest: simulated friction lets a joint creep."""
LONGER, LONGEST = 6.0, 200.0
"""A run that has not settled is made so many times as long, up to so many seconds."""


@dataclass(frozen=True)
class Comparison:
    """Bounds, certified, and what was seen in one run, in floating point.

    Args:
        gains: the gain set.
        joints: names of the arm's joints, base first.
        settling: the time bound.
        disturbance: what a disturbance leaves.
        task: the motion that was simulated.
        simulated_time: s, from when on every |e_i| ≤ δ within the run; none if it was not reached.
        simulated_for: s, how long that run was.
        simulated_rest: rad, the largest |e_i| at the end of two runs with dry friction alone, twice as long:
            of the task, and of one let go just inside the certified bound of rest.
        simulated_errors: rad, the largest |e_i| over the last tenth of the run with the disturbance.
        assumptions: what is taken for granted about the arm.
    """

    gains: GainSet
    joints: tuple[str, ...]
    settling: SettlingBound
    disturbance: DisturbanceBound
    task: Task
    simulated_time: float | None
    simulated_for: float
    simulated_errors: tuple[float, ...]
    simulated_rest: tuple[float, ...]
    assumptions: tuple[str, ...]

    @property
    def certified(self) -> bool:
        """Whether both bounds are."""
        return self.settling.time is not None and self.disturbance.level is not None


def compare(
    gain_set: GainSet,
    model: RobotModel,
    task: Task,
    delta: float,
    torque: Sequence[float] = (),
    dry: Sequence[float] | None = None,
    *,
    max_boxes: int,
    jobs: int = 1,
    on_progress: Progress | None = None,
) -> Comparison:
    """The bounds of a task and the run.

    Args:
        gain_set: the controller, of a bounded family.
        model: the arm.
        task: start, goal and duration of the run.
        delta: δ, rad.
        torque: (n,) bounds of a torque of any sign, N·m; the run has it constant and positive.
        dry: (n,) bounds of dry friction, N·m; what is known of the arm if missing.
        max_boxes: the budget of each attempt at a proof.
        jobs: processes for the checker.
        on_progress: told the share done.
    """
    progress = on_progress or (lambda fraction, note: None)
    controlled = ControlledArm(gain_set, model)
    friction = coulomb(model) if dry is None else tuple(dry)
    settling, left = kept_bounds(
        controlled,
        task.step,
        task.w0,
        delta,
        torque,
        friction,
        max_boxes=max_boxes,
        jobs=jobs,
        on_progress=lambda f, note: progress(0.9 * f, note),
    )
    progress(0.9, "simulation")
    duration = task.T
    calm = disturbed(gain_set, model, task.q_d, task.q0, task.w0, duration)
    while inside_from(calm.t, calm.e, delta) is None and _longer(settling, duration):
        duration *= LONGER
        calm = disturbed(gain_set, model, task.q_d, task.q0, task.w0, duration)
    pushed = disturbed(gain_set, model, task.q_d, task.q0, task.w0, task.T, torque=list(torque), dry=friction)
    let_go = [goal - JUST_INSIDE * float(x or 0) for goal, x in zip(task.q_d, left.rest, strict=True)]
    runs = [(let_go, None), (task.q0, task.w0)]
    ends = (disturbed(gain_set, model, task.q_d, *start, T=2 * task.T, dry=friction).e[-1] for start in runs)
    return Comparison(
        gains=gain_set,
        joints=model.joints,
        settling=settling,
        disturbance=left,
        task=task,
        simulated_for=duration,
        simulated_time=inside_from(calm.t, calm.e, delta),
        simulated_errors=last_errors(pushed.e),
        simulated_rest=tuple(np.max(np.abs(list(ends)), axis=0).tolist()),
        assumptions=model.assumptions,
    )


def _longer(settling: SettlingBound, duration: float) -> bool:
    """Whether a run should be longer, to be compared with the certified time."""
    return settling.time is not None and duration * LONGER <= min(LONGEST, LONGER * float(settling.time))


def coulomb(model: RobotModel) -> tuple[float, ...]:
    """Dry friction of the arm, N·m; 0 where nothing is known."""
    return tuple(0.0 if number is None else float(number.value) for number in model.coulomb)


def inside_from(t: Array, e: Array, delta: float) -> float | None:
    """The first sample from which on every |e_i| ≤ δ."""
    outside = np.flatnonzero(np.abs(e).max(axis=1) > delta)
    if outside.size == 0:
        return float(t[0])
    last = int(outside[-1])
    return float(t[last + 1]) if last + 1 < t.size else None


def last_errors(e: Array) -> tuple[float, ...]:
    """The largest |e_i| over the last tenth of a run."""
    tail = e[-math.ceil(len(e) / 10) :]
    return tuple(float(x) for x in np.abs(tail).max(axis=0))
