"""Gains tried on the whole arm: each motion of the closed loop (11), held against what was asked."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass, replace
from fractions import Fraction
from functools import cached_property
from itertools import product
from typing import TYPE_CHECKING, Any

import numpy as np

from lyapcheck.answers.gate.friction import rest_errors
from lyapcheck.errors import InputError, Problem
from lyapcheck.search.controlled_arm import ControlledArm
from lyapcheck.simulate import results as indices
from lyapcheck.simulate.bench import Bench
from lyapcheck.simulate.many import Runs, simulate_many
from lyapcheck.simulate.run import Run, SimulationFailed
from lyapcheck.simulate.task import LONGEST, motor_limits
from lyapcheck.simulate.trial import experiment

if TYPE_CHECKING:
    from lyapcheck._types import Array
    from lyapcheck.control.gains import GainSet
    from lyapcheck.control.sampling import LoopRecord
    from lyapcheck.robots import RobotModel
    from lyapcheck.simulate.task import Task

NAMES = {
    "overshoot": ("overshoot", "overshoot ≤ {} %"),
    "settle": ("settling time", "settled (2 %) within {} s"),
    "peak_share": ("peak torque", "≤ {} of each torque limit"),
    "rest_error": ("rest error", "dry friction leaves ≤ {}°"),
}
"""The wishes in words, and what is asked."""
BY_19, BY_PROOF = "19", "proof"
MOST = 1e6
"""Per cent, s and degrees; who asks for more asks for nothing."""
WAYS = (BY_19, BY_PROOF)
"""How stability is to be shown: by (19), or by a proof for the arm that does without."""
TOLERANCE = 1e-7
POINTS = 41
LONGER, SHORTEST = 4.0, 3.0
"""Times the settling time that is asked for, and s: how long a motion is watched at least."""
FLAT = 8.0
"""So many times as long where h is flat at the goal: what it brings late would not be seen."""
MOST_AS_RUN = 12
"""Runs as a computer has them, of all motions on all arms: each takes seconds."""
MOST_WATCHED = 8_000
"""Steps of the integrator: a stiff motion that took as many is not watched for longer."""
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
        said = ((NAMES[name][1], str(value).removesuffix(".0")) for name, value in self.given.items())
        return "; ".join(form.format(value) for form, value in said)


@dataclass(frozen=True)
class Trials:
    """What gains are tried on: motions from rest to rest, and how stability is to be shown."""

    wishes: Wishes
    tasks: tuple[Task, ...]
    ways: tuple[str, ...] = WAYS
    digits: int = 3
    quantile: float = 1.0
    """The share of motions that counts, joint by joint: 1 is the worst of them."""

    def worst(self, values: Array) -> Array:
        """The worst (n,) of the share of motions (R, n) that counts."""
        return np.asarray(np.sort(values, axis=0)[math.ceil(self.quantile * len(values)) - 1])


@dataclass(frozen=True, eq=False)
class Trial:
    """The worst of some motions, (n,) each: per cent, s, share of the motor's limit, degrees.

    ``settled`` is infinite for a joint that does not settle in the ``T`` seconds of the motion. ``late`` is
    the largest error of the last quarter, as a share of the step. ``kept``: the energy that is left after T
    keeps every joint where it is; else what comes later is not known.
    """

    wishes: Wishes
    overshoot: Array
    settled: Array
    share: Array
    late: Array
    rest: Array
    T: float
    kept: bool
    steps: int = 0
    """Of the integrator, of all motions together."""
    as_run: int = 0
    """Runs as a computer has it."""
    unrest: str = ""
    """What a run as a computer has it shows against the gains."""

    @cached_property
    def ratios(self) -> dict[str, Array]:
        """What was seen over what was asked, by wish, (n,); 1 where it is just met."""
        seen = {
            "overshoot": self.overshoot,
            "settle": np.where(np.isinf(self.settled), self.T * (1.0 + self.late), self.settled),
            "peak_share": self.share,
            "rest_error": self.rest,
        }
        with np.errstate(over="ignore"):
            return {name: np.minimum(seen[name] / asked, NEVER) for name, asked in self.wishes.given.items()}

    @property
    def by_joint(self) -> Array:
        """The largest ratio of each joint, (n,)."""
        return np.asarray(np.max([*self.ratios.values()], axis=0))

    @property
    def worst(self) -> float:
        """The largest ratio: at most 1 where all is met."""
        return float(np.max(self.by_joint))


def tried(gains: GainSet, models: Sequence[RobotModel], bench: Trials, *, exact: bool = False) -> Trial:
    """The worst of all motions on all arms.

    Args:
        gains: the controller.
        models: the arm at one or several values of what is uncertain, with its torque limits.
        bench: what is asked, and motions from rest, each watched for `LONGER` than the settling time of it.
        exact: watch on until k_pi U(e_i) of an e_i at the edge of what is asked is above the energy that is
            left: as E falls, it stays within.

    Soundness: floating point; of the motions and arms that are given, and no others.
    """
    for doubling in range(DOUBLINGS + 1 if exact else 1):
        (trial,) = tried_all([gains], models, bench, 2**doubling)
        if trial.kept or trial.steps > MOST_WATCHED:
            break
    return trial


def tried_all(
    sets: Sequence[GainSet], models: Sequence[RobotModel], bench: Trials, longer: float = 1.0
) -> list[Trial]:
    """Each of many gain sets of one member, see `tried`; ``longer``: so many times as long."""
    wishes = bench.wishes
    T = max(LONGER * (wishes.settle or 0.0), SHORTEST) * (FLAT if (sets[0].m or 1) > 1 else 1.0) * longer
    T = min(T, LONGEST)
    arms, each, tasks = zip(*product(models, sets, bench.tasks), strict=True)
    goals, starts = (np.array([getattr(task, end) for task in tasks]) for end in ("q_d", "q0"))
    # arms that differ in assumed friction alone go together: few runs take as long a step as hundreds
    runs = simulate_many(each, arms, goals, starts, T, points=POINTS, tolerance=TOLERANCE, motions=True)
    assert runs.q is not None
    assert runs.V is not None
    done, errors = runs.complete[:, None], goals[:, None] - runs.q[:, 3 * POINTS // 4 :]
    limits = np.array([motor_limits(model) for model in arms])
    seen = _seen(runs, np.abs(goals - starts), errors, limits)
    lost = (NEVER * MOST, math.inf, NEVER, NEVER)
    columns = [np.where(done, values, worst) for values, worst in zip(seen, lost, strict=True)]
    edge = min(indices.SETTLING_BAND, math.inf if wishes.overshoot is None else wishes.overshoot / 100)
    known = [ControlledArm(one, models[0]) for one in each]
    held = known[0].family.potential(indices.bands(goals - starts, edge)) * [gains.kp for gains in known]
    kept = done & (runs.V[:, -1:] < held.min(axis=1, keepdims=True))

    def of_each(values: Array) -> Array:
        """Runs by set: (sets, models and tasks, …)."""
        shape = (len(models), len(sets), len(bench.tasks), -1)
        return values.reshape(shape).swapaxes(0, 1).reshape(len(sets), len(models) * len(bench.tasks), -1)

    steps = int(runs.steps.reshape(len(models), -1).max(axis=1).sum())
    result = []
    for one, safe, *values in zip(sets, *map(of_each, (kept, *columns)), strict=True):
        rest = np.max([[*map(_degrees_above, rest_errors(one, model))] for model in models], axis=0)
        over, time, torque, end = map(bench.worst, values)
        result.append(Trial(wishes, over, time, torque, end, rest, T, bool(np.all(safe)), steps))
    return result


def as_run(gains: GainSet, models: Sequence[RobotModel], bench: Trials, record: LoopRecord) -> Trial:
    """The worst of motions as a computer runs them, see `tried`; without dry friction and load.

    Of more than `MOST_AS_RUN` motions on arms some are run, and what (11) does in all of them counts as well.
    """
    (trial,), loop = tried_all([gains], models, bench), Bench.of(replace(record, **_KNOWN))
    every = [*product(models, bench.tasks)]
    chosen = every[:: math.ceil(len(every) / MOST_AS_RUN)]
    rows, unrest = [], ""
    for model, task in chosen:
        free = replace(model, coulomb=(None,) * model.n)
        try:
            run = experiment(gains, free, task.q_d, task.q0, T=trial.T, bench=loop)
        except SimulationFailed as failure:
            return replace(trial, unrest=failure.reason, kept=False, as_run=len(chosen))
        errors = run.e[3 * len(run.t) // 4 :]
        rows.append(_seen(run, np.abs(run.e[0]), errors, np.array(motor_limits(model))))
        unrest = unrest or ("" if run.unrest is None else run.unrest.sentence)
    seen = [bench.worst(np.array(column)) for column in zip(*rows, strict=True)]
    if len(chosen) < len(every):
        ideal = (trial.overshoot, trial.settled, trial.share, trial.late)
        seen = [np.maximum(*pair) for pair in zip(seen, ideal, strict=True)]
    over, time, torque, end = seen
    kept, count = not unrest, len(chosen)
    return Trial(bench.wishes, over, time, torque, end, trial.rest, trial.T, kept, 0, count, unrest)


_KNOWN: dict[str, Any] = {"unknown_payload": Fraction(0), "gravity_error": Fraction(0)}


def _seen(runs: Runs | Run, step: Array, errors: Array, limits: Array) -> tuple[Array, ...]:
    """Overshoot, settling time, share of torque and late error (…, n), from late errors (…, samples, n)."""
    still = step < indices.LEAST_STEP
    return (
        np.nan_to_num(runs.overshoot),
        np.where(still, 0.0, np.nan_to_num(runs.settling, nan=np.inf)),
        runs.peak_torque / limits,
        np.abs(errors).max(axis=-2) / np.where(still, 1.0, step),
    )


def _degrees_above(error: Fraction | None) -> float:
    """An error in degrees, rounded up to a double."""
    if error is None:
        return math.inf
    return math.nextafter(math.degrees(math.nextafter(float(error), math.inf)), math.inf) if error else 0.0
