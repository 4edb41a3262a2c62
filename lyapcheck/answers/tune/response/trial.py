"""Gains tried on the whole arm: each motion of the closed loop (11), held against what was asked."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass, replace
from fractions import Fraction
from typing import TYPE_CHECKING, Any

import numpy as np

from lyapcheck.answers.gate.friction import rest_errors
from lyapcheck.errors import InputError, Problem
from lyapcheck.output.digits import at_most
from lyapcheck.search.controlled_arm import ControlledArm
from lyapcheck.simulate import results as indices
from lyapcheck.simulate.closed_loop import SetPoint
from lyapcheck.simulate.integrate import with_extremes
from lyapcheck.simulate.results import torque_limits
from lyapcheck.simulate.task import Setup, gains_for

if TYPE_CHECKING:
    from lyapcheck._types import Array
    from lyapcheck.control.gains import GainSet
    from lyapcheck.robots import RobotModel
    from lyapcheck.simulate.task import Task

NAMES = {
    "overshoot": "overshoot",
    "settle": "settling time",
    "peak_share": "peak torque",
    "rest_error": "rest error",
}
"""The wishes in words."""
BY_19, BY_PROOF = "19", "proof"
MOST = 1e6
"""Per cent, s and degrees; who asks for more asks for nothing."""
WAYS = (BY_19, BY_PROOF)
"""How stability is to be shown: by (19), or by a proof for the arm that does without."""
TOLERANCE = 1e-7
POINTS = 401
LONGER, SHORTEST = 4.0, 3.0
"""Times the settling time that is asked for, and s: how long a motion is watched at least."""
FLAT = 8.0
"""So many times as long where h is flat at the goal: what it brings late would not be seen."""
DOUBLINGS = 6
"""Of that time, until the energy that is left keeps every joint within its band for good."""
NEVER = 1e3
"""The ratio of what no time or gain reaches."""


@dataclass(frozen=True)
class Wishes:
    """Upper bounds that hold for every joint and every motion; ``None`` where nothing is asked.

    Args:
        overshoot: per cent of the joint's step.
        settle: s until the joint stays within 2 % of its step.
        peak_share: of the motor's torque limit, in (0, 1].
        rest_error: degrees from the goal at which dry friction may hold the joint.
    """

    overshoot: float | None = None
    settle: float | None = None
    peak_share: float | None = None
    rest_error: float | None = None

    def __post_init__(self) -> None:
        problems = []
        for name, value in self.given.items():
            top = 1.0 if name == "peak_share" else MOST
            if not 0 < value <= top:
                rule = f"must be above 0, up to {top:g}"
                option = "--" + name.replace("_", "-")
                problems.append(Problem("argument", None, option, f"{value:g}", rule, "correct the value"))
        if problems:
            raise InputError(problems)

    @property
    def given(self) -> dict[str, float]:
        """What is asked, by name."""
        result = {name: getattr(self, name) for name in NAMES}
        return {name: value for name, value in result.items() if value is not None}

    def text(self) -> str:
        """What is asked, in one line."""
        forms = {
            "overshoot": "overshoot ≤ {} %",
            "settle": "settled (2 %) within {} s",
            "peak_share": "≤ {} of each torque limit",
            "rest_error": "dry friction leaves ≤ {}°",
        }
        return "; ".join(forms[name].format(at_most(value, 6)) for name, value in self.given.items())


@dataclass(frozen=True)
class Trials:
    """What gains are tried on: motions from rest to rest, and how stability is to be shown."""

    wishes: Wishes
    tasks: tuple[Task, ...]
    ways: tuple[str, ...] = WAYS
    digits: int = 3


@dataclass(frozen=True, eq=False)
class Trial:
    """The worst of some motions, (n,) each: per cent, s, share of the motor's limit, degrees.

    NaN where there is no such number: ``settled`` of a joint that does not settle in the ``T`` seconds of the
    motion. ``late`` is the largest error of the last quarter, as a share of the step. ``kept``: the energy
    that is left after T keeps every joint where it is; else what comes later is not known.
    """

    overshoot: Array
    settled: Array
    share: Array
    rest: Array
    late: Array
    T: float
    kept: bool

    def ratios(self, wishes: Wishes) -> dict[str, Array]:
        """What was seen over what was asked, by wish, (n,); 1 where it is just met."""
        seen = {
            "overshoot": np.nan_to_num(self.overshoot, nan=0.0),
            "settle": np.where(np.isnan(self.settled), self.T * (1.0 + self.late), self.settled),
            "peak_share": np.nan_to_num(self.share, nan=0.0),
            "rest_error": self.rest,
        }
        with np.errstate(over="ignore"):
            return {name: np.minimum(seen[name] / asked, NEVER) for name, asked in wishes.given.items()}

    def worst(self, wishes: Wishes) -> float:
        """The largest ratio: at most 1 where all is met."""
        return max(float(np.max(x)) for x in self.ratios(wishes).values())


def tried(
    gains: GainSet,
    models: Sequence[RobotModel],
    tasks: Sequence[Task],
    wishes: Wishes,
    *,
    exact: bool = False,
) -> Trial:
    """The worst of all motions on all arms.

    Args:
        gains: the controller.
        models: the arm at one or several values of what is uncertain.
        tasks: motions from rest; each is watched for `LONGER` than the settling time that is asked for.
        wishes: what is asked.
        exact: look for extremes between the integrator's steps too, and watch on until k_pi U(e_i) of an e_i
            at the edge of what is asked is above the energy that is left: as E falls, it stays within.

    Soundness: floating point; of the motions and arms that are given, and no others.
    """
    T, kept = max(LONGER * (wishes.settle or 0.0), SHORTEST) * (FLAT if (gains.m or 1) > 1 else 1.0), False
    edge = min(indices.SETTLING_BAND, math.inf if wishes.overshoot is None else wishes.overshoot / 100)
    for doubling in range(DOUBLINGS + 1 if exact else 1):
        runs = [_one(gains, model, task, T * 2**doubling, exact, edge) for model in models for task in tasks]
        kept = all(run[4] for run in runs)
        if kept:
            break
    T *= 2**doubling
    with np.errstate(invalid="ignore"):
        overshoot, share, late = (np.fmax.reduce([run[k] for run in runs]) for k in (0, 2, 3))
        settled = np.maximum.reduce([run[1] for run in runs])  # NaN where one of them does not settle
    rest = np.max([[*map(_degrees_above, rest_errors(gains, model))] for model in models], axis=0)
    return Trial(overshoot, settled, share, rest, late, T, kept)


def _degrees_above(error: Fraction | None) -> float:
    """An error in degrees, rounded up to a double."""
    if error is None:
        return math.inf
    return math.nextafter(math.degrees(math.nextafter(float(error), math.inf)), math.inf) if error else 0.0


def _one(
    gain_set: GainSet, model: RobotModel, task: Task, T: float, exact: bool, edge: float
) -> tuple[Any, ...]:
    n, goal, gains = model.n, np.array(task.q_d), gains_for(gain_set, model.n)
    setup = Setup(gains, model, replace(task, T=T), 0.0, ControlledArm(gain_set, model))
    course = SetPoint(setup, POINTS)
    path = course.once(TOLERANCE)
    if exact:
        path = with_extremes(path, lambda some: np.hstack((course.signals(some)[0], some.y[:, :n])))
    else:
        path = path.at(np.unique(np.concatenate((path.t, path.steps))))
    tau, energy = course.signals(path)
    e = goal - path.y[:, :n]
    settled = indices.settling_times(path.t, e) if path.failure is None else np.full(n, np.nan)
    still = np.abs(e[0]) < indices.LEAST_STEP
    settled[still] = 0.0
    late = np.max(np.abs(e[path.t >= 0.75 * path.t[-1]]), axis=0) / np.where(still, 1.0, np.abs(e[0]))
    limits = np.array([np.nan if most is None else most for most in torque_limits(model)])
    kept = path.failure is None and energy[-1] < np.min(
        gains.kp * gains.family.potential(indices.bands(e[0], edge))
    )
    return indices.overshoots(e), settled, np.max(np.abs(tau), axis=0) / limits, late, kept
