"""How far from their goal gain sets let an arm rest under dry friction: proved, beside simulated motions."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace
from fractions import Fraction
from math import ceil
from typing import TYPE_CHECKING

import numpy as np

from lyapcheck._types import Array, Progress, silent
from lyapcheck.answers.gate.friction import promised_errors, promised_rest
from lyapcheck.answers.running.holds import HoldsCheck, holds_checks
from lyapcheck.check.judgement import LARGEST
from lyapcheck.control.judgement import (
    ACCEPTED,
    DEGREES,
    REJECTED,
    Room,
    stalls,
)
from lyapcheck.control.limits import model_limits
from lyapcheck.control.sampling import UNSAID, exact_only
from lyapcheck.errors import argument_error
from lyapcheck.family import named
from lyapcheck.files.decimals import decimal_text
from lyapcheck.robots.vary import corners
from lyapcheck.simulate.closed_loop import SetPoint
from lyapcheck.simulate.task import set_up

if TYPE_CHECKING:
    from lyapcheck.control.conditions import Check
    from lyapcheck.control.gains import GainSet
    from lyapcheck.control.sampling import LoopRecord
    from lyapcheck.promise import Promise
    from lyapcheck.robots import RobotModel
    from lyapcheck.simulate.task import Task

UNIT = Fraction(1, 10**6)
"""Of angles that are printed, degrees."""
POINTS, TOLERANCE = 1001, 1e-8
"""Samples of a run, and its relative tolerance."""
JUST_INSIDE = 0.95
"""Where a run starts, next to the proved bound of rest: simulated friction lets a joint creep."""


@dataclass(frozen=True)
class BoundsComparison:
    """Bounds at rest, proved, and what was seen in runs with dry friction, in floating point.

    Args:
        gains: the gain set.
        model: the arm.
        dry: N·m, the most that dry friction of each joint may be; none where nothing is known of it.
        promise: of the errors at rest, as they are printed; none where there are none.
        reason: why a joint has no bound; empty where all have one.
        task: the motion that was simulated.
        delta: δ, rad.
        simulated_time: s, from when on every |e_i| ≤ δ within the run; none if it was not reached.
        simulated_largest: rad, the largest |e_i| of the run.
        simulated_rest: rad, the largest |e_i| at the end of two runs: of the task, and of one let go just
            inside the bound of rest.
        varies: the ranges over which the bounds hold, as typed.
        corners: at which of their corners runs were made; the worst of them counts.
        unknown: what gravity that the controller does not know makes of them, where a record says so.
        sampled: whether a record has a rate, which runs leave out.
        exact_only: that the bounds leave out the encoder of a record, in words; empty without one.
    """

    gains: GainSet
    model: RobotModel
    dry: tuple[Fraction | None, ...]
    promise: Promise | None
    reason: str
    task: Task
    delta: float
    simulated_time: float | None
    simulated_largest: tuple[float, ...]
    simulated_rest: tuple[float, ...]
    varies: tuple[str, ...] = ()
    corners: str = ""
    unknown: tuple[Check, ...] = ()
    sampled: bool = False
    exact_only: str = ""

    def __repr__(self) -> str:
        return f"<BoundsComparison: {self.gains.name} on {self.model.name}>"

    @property
    def joints(self) -> tuple[str, ...]:
        """Names of the joints, base first."""
        return self.model.joints

    @property
    def rest(self) -> tuple[Fraction | None, ...]:
        """rad, |e_i| at every state of rest; none for a joint without a bound."""
        return promised_errors(self.promise, len(self.joints))

    @property
    def rest_degrees(self) -> tuple[Fraction | None, ...]:
        """The same in degrees."""
        return tuple(None if error is None else error * DEGREES for error in self.rest)

    @property
    def proved(self) -> bool:
        """Whether each joint has a bound, whatever gravity is unknown."""
        return None not in self.rest and all(check.verdict == ACCEPTED for check in self.unknown)

    @property
    def falls(self) -> bool:
        """Whether a joint is refuted to hold the gravity that the controller does not know."""
        return any(check.verdict == REJECTED for check in self.unknown)

    @property
    def unknown_degrees(self) -> tuple[Fraction | None, ...]:
        """Errors at rest with what is unknown as well; those of dry friction where that is nothing."""
        if any(check.joint is None for check in self.unknown):  # of no joint it is known what is asked
            return (None,) * len(self.joints)
        result = list(self.rest_degrees)
        for check in self.unknown:
            if isinstance(check, HoldsCheck) and check.joint is not None:
                known = None if self.dry[check.joint] is None else check.error  # else without the friction
                result[check.joint] = None if known is None else known * DEGREES
        return tuple(result)


def compare(
    gain_set: GainSet,
    model: RobotModel,
    task: Task,
    delta: float,
    dry: Sequence[Fraction] | None = None,
    *,
    motors: Sequence[Fraction] | None = None,
    varied: RobotModel | None = None,
    record: LoopRecord | None = None,
    on_progress: Progress | None = None,
) -> BoundsComparison:
    """The bounds at rest and the run.

    Args:
        gain_set: the controller, of a bounded family.
        model: the arm.
        task: start, goal and duration of the run.
        delta: δ, rad.
        dry: (n,) bounds of dry friction, N·m; if missing the upper ends of what is known of the arm.
        motors: (n,) torque limits in place of the arm's, N·m.
        varied: the arm with ranges; the bounds are asked over them as well.
        record: what the controller does not know of gravity; runs know all of it, at infinite rate.
        on_progress: receives the share done.

    Raises:
        InputError: an unbounded h.
    """
    progress = on_progress or silent
    if not named(gain_set.family, gain_set.m).bounded:
        rule = f"{gain_set.name} has an unbounded h, of which no error at rest is judged"
        raise argument_error("gains", gain_set.name, rule, "choose gains of a bounded family")
    whole = model if varied is None else varied
    tried, arms = ("", (("", model),)) if varied is None else corners(varied)
    known_most = (None if number is None else number.bounds[1] for number in whole.coulomb)
    most = tuple(known_most if dry is None else dry)
    limits = model_limits(whole)
    room = (limits if motors is None else replace(limits, torque=tuple(motors))).room
    # at rest no joint asks anything of another: one of unknown friction has no bound, and the others have
    supposed = [Fraction(LARGEST) if f is None else f for f in most]
    promise, reason = promised_rest(gain_set, supposed, room, lambda angle: ceil(angle / UNIT) * UNIT)
    errors = promised_errors(promise, model.n)
    runs = []
    for index, (_, arm) in enumerate(arms):
        progress(index / len(arms), "simulation")
        runs.append(_run(gain_set, arm, task, delta, dry, errors))
    times, largest, last = zip(*runs, strict=True)
    loop, own = record or UNSAID, None if None in most else supposed
    return BoundsComparison(
        gains=gain_set,
        model=model,
        dry=most,
        promise=promise,
        reason=reason or _reason(gain_set, model.joints, most, errors, room),
        task=task,
        delta=delta,
        simulated_time=None if None in times else max(times),
        simulated_largest=tuple(np.max(largest, axis=0).tolist()),
        simulated_rest=tuple(np.max(last, axis=0).tolist()),
        varies=() if varied is None else tuple(one.text for one in varied.varies),
        corners=tried,
        unknown=() if loop.knows_gravity else holds_checks(gain_set, whole, loop, room, own),
        sampled=loop.period is not None,
        exact_only=exact_only(loop),
    )


def _reason(
    gains: GainSet,
    joints: tuple[str, ...],
    dry: tuple[Fraction | None, ...],
    errors: tuple[Fraction | None, ...],
    room: Room,
) -> str:
    """Why joints have no bound, and what to do."""
    unknown = [joint for joint, f in zip(joints, dry, strict=True) if f is None]
    if unknown:
        return (
            f"nothing is known of the dry friction of {', '.join(unknown)}; give --friction, or state it as "
            "coulomb in the arm file"
        )
    loads = zip(joints, dry, room, strict=True)
    stalled = [joint for joint, f, most in loads if f is not None and stalls(f, most)]
    if stalled:
        names = ", ".join(stalled)
        return f"gravity and dry friction may hold {names} anywhere, with its motor at its limit"
    rows = zip(joints, gains.kp, dry, errors, strict=True)
    weak = [
        f"k_p = {decimal_text(k)} N·m of {joint} does not exceed its dry friction of {decimal_text(f)} N·m"
        for joint, k, f, e in rows
        if e is None and f is not None and f >= k
    ]
    if weak:
        return f"{'; '.join(weak)}: raise k_p"
    return "" if None not in errors else "h at the bounds does not decide it; raise k_p"


def _run(
    gain_set: GainSet,
    model: RobotModel,
    task: Task,
    delta: float,
    dry: Sequence[Fraction] | None,
    errors: Sequence[Fraction | None],
) -> tuple[float | None, Array, Array]:
    """Time, largest and last errors of the task, and the last of a motion let go just inside the bound."""
    known = [0.0 if number is None else float(number.value) for number in model.coulomb]
    friction = known if dry is None else [float(f) for f in dry]
    let_go = [x - JUST_INSIDE * float(e or 0) for x, e in zip(task.q_d, errors, strict=True)]
    starts = ((task.q0, task.w0), (let_go, None))
    setups = (set_up(gain_set, model, task.q_d, q0, w0, T=task.T, eps0=None) for q0, w0 in starts)
    paths = [SetPoint(one, POINTS, friction).once(TOLERANCE) for one in setups]
    e, other = (np.abs(np.array(task.q_d) - path.y[:, : model.n]) for path in paths)
    return inside_from(paths[0].t, e, delta), e.max(axis=0), np.maximum(e[-1], other[-1])


def inside_from(t: Array, e: Array, delta: float) -> float | None:
    """The first sample from which on every |e_i| ≤ δ."""
    outside = np.flatnonzero(np.abs(e).max(axis=1) > delta)
    if outside.size == 0:
        return float(t[0])
    last = int(outside[-1])
    return float(t[last + 1]) if last + 1 < t.size else None
