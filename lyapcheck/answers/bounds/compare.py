"""The bounds of the errors at rest of one gain set, and the simulated motion."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from fractions import Fraction
from math import ceil
from typing import TYPE_CHECKING

import numpy as np

from lyapcheck import asked
from lyapcheck._types import Array, Progress, part, silent
from lyapcheck.check.kinds.resting import Resting
from lyapcheck.control.resting import DEGREES
from lyapcheck.errors import argument_error
from lyapcheck.family import named
from lyapcheck.files.decimals import decimal_text
from lyapcheck.promise import Promise, promised
from lyapcheck.robots.vary import corners, corners_text
from lyapcheck.search.rest import resting
from lyapcheck.simulate.disturbed import disturbed

if TYPE_CHECKING:
    from lyapcheck.control.gains import GainSet
    from lyapcheck.control.judgement import JudgedStatement
    from lyapcheck.robots import RobotModel
    from lyapcheck.robots.vary import Vary
    from lyapcheck.simulate.task import Task

    Varied = tuple[RobotModel, Sequence[Vary]]
    """An arm with ranges, and which."""

PLACES = 6
"""Decimals of a degree."""
JUST_INSIDE = 0.95
"""Where a run starts, beside the proved bound of rest: simulated friction lets a joint creep."""


@dataclass(frozen=True)
class BoundsComparison:
    """Bounds at rest, proved, and what was seen in runs with dry friction, in floating point.

    Args:
        gains: the gain set.
        robot: name of the arm.
        joints: names of its joints, base first.
        dry: N·m, the most that dry friction of each joint may be; none where nothing is known of it.
        promise: of the errors at rest, as they are printed; none where there are none.
        reason: why a joint has no bound; empty where all have one.
        task: the motion that was simulated.
        delta: δ, rad.
        simulated_time: s, from when on every |e_i| ≤ δ within the run; none if it was not reached.
        simulated_largest: rad, the largest |e_i| of the run.
        simulated_rest: rad, the largest |e_i| at the end of two runs: of the task, and of one let go just
            inside the bound of rest.
        assumptions: what is taken for granted about the arm.
        varies: the ranges over which the bounds hold, as typed.
        corners: at which of their corners runs were made; the worst of them counts.
        unvaried: the same without these ranges, where something varies.
    """

    gains: GainSet
    robot: str
    joints: tuple[str, ...]
    dry: tuple[Fraction | None, ...]
    promise: Promise | None
    reason: str
    task: Task
    delta: float
    simulated_time: float | None
    simulated_largest: tuple[float, ...]
    simulated_rest: tuple[float, ...]
    assumptions: tuple[str, ...]
    varies: tuple[str, ...] = ()
    corners: str = ""
    unvaried: BoundsComparison | None = None

    @property
    def rest(self) -> tuple[Fraction | None, ...]:
        """rad, |e_i| at every state of rest; none for a joint without a bound."""
        return _errors(self.promise, len(self.joints))

    @property
    def rest_degrees(self) -> tuple[Fraction | None, ...]:
        """The same in degrees."""
        return tuple(None if error is None else error * DEGREES for error in self.rest)

    @property
    def proved(self) -> bool:
        """Whether each joint has a bound."""
        return None not in self.rest


def compare(
    gain_set: GainSet,
    model: RobotModel,
    task: Task,
    delta: float,
    dry: Sequence[Fraction] | None = None,
    *,
    varied: Varied | None = None,
    on_progress: Progress | None = None,
) -> BoundsComparison:
    """The bounds at rest and the run.

    Args:
        gain_set: the controller, of a bounded family.
        model: the arm.
        task: start, goal and duration of the run.
        delta: δ, rad.
        dry: (n,) bounds of dry friction, N·m; if missing the upper ends of what is known of the arm.
        varied: the arm with ranges, and what varies; the bounds are asked over them as well.
        on_progress: receives the share done.

    Raises:
        InputError: an unbounded h.
    """
    progress = on_progress or silent
    if not named(gain_set.family, gain_set.m).bounded:
        rule = f"{gain_set.name} has an unbounded h, of which no error at rest is judged"
        raise argument_error("gains", gain_set.name, rule, "choose gains of a bounded family")
    unvaried = None
    if varied is not None:
        unvaried = compare(gain_set, model, task, delta, dry, on_progress=part(progress, 0, 0.4))
    whole, arms = (model, [model]) if varied is None else (varied[0], [arm for _, arm in corners(*varied)])
    most = _most(whole) if dry is None else tuple(dry)
    known = [f for f in most if f is not None]
    shown = resting(gain_set, known) if len(known) == len(most) else None
    promise, reason = (None, "") if shown is None else _promised(gain_set, known, shown)
    errors = _errors(promise, model.n)
    runs = []
    for index, arm in enumerate(arms):
        progress((0 if varied is None else 0.4) + 0.6 * index / len(arms), "simulation")
        runs.append(_Runs.of(gain_set, arm, task, delta, dry, errors))
    times = [run.time for run in runs]
    return BoundsComparison(
        gains=gain_set,
        robot=model.name,
        joints=model.joints,
        dry=most,
        promise=promise,
        reason=reason or _reason(gain_set, model.joints, most, errors),
        task=task,
        delta=delta,
        simulated_time=None if None in times else max(time for time in times if time is not None),
        simulated_largest=tuple(np.max([run.largest for run in runs], axis=0).tolist()),
        simulated_rest=tuple(np.max([run.rest for run in runs], axis=0).tolist()),
        assumptions=model.assumptions,
        varies=() if varied is None else tuple(one.text for one in varied[1]),
        corners="" if varied is None else corners_text(*varied),
        unvaried=unvaried,
    )


def _promised(gains: GainSet, dry: Sequence[Fraction], shown: JudgedStatement) -> tuple[Promise | None, str]:
    """The promise of what is printed, in degrees and rounded up; or why there is none."""
    assert isinstance(shown.statement, Resting)
    printed = [None if error is None else _rounded_up(error * DEGREES) for error in shown.statement.errors]
    errors = [None if angle is None else angle / DEGREES for angle in printed]
    return promised(asked.resting(gains, dry, errors), shown)


def _errors(promise: Promise | None, n: int) -> tuple[Fraction | None, ...]:
    """rad, what is promised of each joint."""
    if promise is None:
        return (None,) * n
    assert isinstance(promise.asked, Resting)
    return promise.asked.errors


def _rounded_up(value: Fraction) -> Fraction:
    """To so many places as are printed."""
    return Fraction(ceil(value * 10**PLACES), 10**PLACES)


def _most(model: RobotModel) -> tuple[Fraction | None, ...]:
    """Dry friction of each joint at the upper end of its range, N·m."""
    return tuple(None if number is None else number.bounds[1] for number in model.coulomb)


def _reason(
    gains: GainSet,
    joints: tuple[str, ...],
    dry: tuple[Fraction | None, ...],
    errors: tuple[Fraction | None, ...],
) -> str:
    """Why joints have no bound, and what to do."""
    unknown = [joint for joint, f in zip(joints, dry, strict=True) if f is None]
    if unknown:
        return (
            f"nothing is known of the dry friction of {', '.join(unknown)}; give --friction, or state it as "
            "coulomb in the arm file"
        )
    rows = zip(joints, gains.kp, dry, errors, strict=True)
    weak = [
        f"k_p = {decimal_text(k)} N·m of {joint} does not exceed its dry friction of {decimal_text(f)} N·m"
        for joint, k, f, e in rows
        if e is None and f is not None and f >= k
    ]
    if weak:
        return f"{'; '.join(weak)}: raise k_p"
    return "" if None not in errors else "h at the bounds does not decide it; raise k_p"


@dataclass(frozen=True)
class _Runs:
    """What runs of one arm show: see `BoundsComparison`."""

    time: float | None
    largest: tuple[float, ...]
    rest: tuple[float, ...]

    @classmethod
    def of(
        cls,
        gain_set: GainSet,
        model: RobotModel,
        task: Task,
        delta: float,
        dry: Sequence[Fraction] | None,
        errors: Sequence[Fraction | None],
    ) -> _Runs:
        """The task, and a motion let go just inside the bound of rest."""
        known = [0.0 if number is None else float(number.value) for number in model.coulomb]
        friction = known if dry is None else [float(f) for f in dry]
        let_go = [x - JUST_INSIDE * float(e or 0) for x, e in zip(task.q_d, errors, strict=True)]
        run, other = (
            disturbed(gain_set, model, task.q_d, q0, w0, task.T, dry=friction)
            for q0, w0 in ((task.q0, task.w0), (let_go, None))
        )
        ends = np.max(np.abs([run.e[-1], other.e[-1]]), axis=0)
        largest = np.max(np.abs(run.e), axis=0)
        return cls(inside_from(run.t, run.e, delta), tuple(largest.tolist()), tuple(ends.tolist()))


def inside_from(t: Array, e: Array, delta: float) -> float | None:
    """The first sample from which on every |e_i| ≤ δ."""
    outside = np.flatnonzero(np.abs(e).max(axis=1) > delta)
    if outside.size == 0:
        return float(t[0])
    last = int(outside[-1])
    return float(t[last + 1]) if last + 1 < t.size else None
