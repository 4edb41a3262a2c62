"""The certified bounds of one gain set for one task, and the simulated motion."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass
from fractions import Fraction
from typing import TYPE_CHECKING, Any

import numpy as np

from lyapcheck._types import Array, Progress, part, silent
from lyapcheck.robots.vary import corners, only_varied
from lyapcheck.search.controlled_arm import ControlledArm
from lyapcheck.search.decay.bounds import disturbance_bound, settling_bound
from lyapcheck.simulate.disturbed import disturbed

if TYPE_CHECKING:
    from lyapcheck.control.gains import GainSet
    from lyapcheck.robots import RobotModel
    from lyapcheck.robots.vary import Vary
    from lyapcheck.search.decay.results import DisturbanceBound, SettlingBound
    from lyapcheck.simulate.task import Task

    Varied = tuple[RobotModel, Sequence[Vary]]
    """An arm with ranges, and which."""

JUST_INSIDE = 0.95
"""Where a run starts, beside the certified bound of rest: simulated friction lets a joint creep."""
LONGER, LONGEST = 6.0, 200.0
"""A run that has not settled is made so many times as long, up to so many seconds."""


@dataclass(frozen=True)
class BoundsComparison:
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
        varies: the ranges over which the bounds hold, as typed; of runs at all their corners the worst
            counts.
        unvaried: the same at nominal numbers, where something varies.
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
    varies: tuple[str, ...] = ()
    unvaried: BoundsComparison | None = None

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
    varied: Varied | None = None,
    on_progress: Progress | None = None,
) -> BoundsComparison:
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
        varied: the arm with ranges, and what varies; the bounds are asked over them as well.
        on_progress: receives the share done.
    """
    progress = on_progress or silent
    unvaried, controlled, arms = None, ControlledArm(gain_set, model), [model]
    controlled.require_friction()
    if varied is not None:
        unvaried = compare(
            gain_set,
            model,
            task,
            delta,
            torque,
            dry,
            max_boxes=max_boxes,
            jobs=jobs,
            on_progress=part(progress, 0, 0.4),
        )
        ranged = only_varied(*varied)
        controlled = ControlledArm(gain_set, ranged, ranges=True)
        controlled.require_friction()
        arms = [arm for _, arm in corners(*varied)]
    friction = tuple(dry) if dry is not None else coulomb(model) if varied is None else most_coulomb(ranged)
    share = part(progress, 0, 0.9) if varied is None else part(progress, 0.4, 0.8)
    start = controlled, task.step, task.w0
    budget: dict[str, Any] = {"max_boxes": max_boxes, "jobs": jobs}
    settling = settling_bound(*start, delta, on_progress=part(share, 0, 0.5), **budget)
    left = disturbance_bound(*start, torque, friction, on_progress=part(share, 0.5, 1), **budget)
    runs = []
    for index, arm in enumerate(arms):
        progress(0.9 if varied is None else 0.8 + 0.2 * index / len(arms), "simulation")
        held = coulomb(arm) if dry is None else tuple(dry)
        runs.append(_Runs.of(gain_set, arm, task, delta, torque, held, settling, left))
    times = [run.time for run in runs]
    return BoundsComparison(
        gains=gain_set,
        joints=model.joints,
        settling=settling,
        disturbance=left,
        task=task,
        simulated_for=max(run.duration for run in runs),
        simulated_time=None if None in times else max(time for time in times if time is not None),
        simulated_errors=tuple(np.max([run.errors for run in runs], axis=0).tolist()),
        simulated_rest=tuple(np.max([run.rest for run in runs], axis=0).tolist()),
        assumptions=model.assumptions,
        varies=() if varied is None else tuple(one.text for one in varied[1]),
        unvaried=unvaried,
    )


@dataclass(frozen=True)
class _Runs:
    """What runs of one arm show: see `BoundsComparison`."""

    time: float | None
    duration: float
    errors: tuple[float, ...]
    rest: tuple[float, ...]

    @classmethod
    def of(
        cls,
        gain_set: GainSet,
        model: RobotModel,
        task: Task,
        delta: float,
        torque: Sequence[float],
        dry: Sequence[float],
        settling: SettlingBound,
        left: DisturbanceBound,
    ) -> _Runs:
        """The task undisturbed, long enough to be compared; disturbed; and two motions that friction ends."""
        goal = task.q_d
        duration = task.T
        calm = disturbed(gain_set, model, goal, task.q0, task.w0, duration)
        while inside_from(calm.t, calm.e, delta) is None and _longer(settling, duration):
            duration *= LONGER
            calm = disturbed(gain_set, model, goal, task.q0, task.w0, duration)
        pushed = disturbed(gain_set, model, goal, task.q0, task.w0, task.T, torque=list(torque), dry=dry)
        let_go = [x - JUST_INSIDE * float(e or 0) for x, e in zip(goal, left.rest, strict=True)]
        ends = [
            disturbed(gain_set, model, goal, q0, w0, 2 * task.T, dry=dry).e[-1]
            for q0, w0 in ((let_go, None), (task.q0, task.w0))
        ]
        rest = tuple(np.max(np.abs(ends), axis=0).tolist())
        return cls(inside_from(calm.t, calm.e, delta), duration, last_errors(pushed.e), rest)


def _longer(settling: SettlingBound, duration: float) -> bool:
    """Whether a run should be longer, to be compared with the certified time."""
    return settling.time is not None and duration * LONGER <= min(LONGEST, LONGER * float(settling.time))


def coulomb(model: RobotModel) -> tuple[float, ...]:
    """Dry friction of the arm, N·m; 0 where nothing is known."""
    return tuple(0.0 if number is None else float(number.value) for number in model.coulomb)


def most_coulomb(model: RobotModel) -> tuple[Fraction, ...]:
    """The most that it may be in its ranges."""
    return tuple(Fraction(0) if number is None else number.bounds[1] for number in model.coulomb)


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
