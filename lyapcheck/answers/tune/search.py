"""Gains for a wanted response: drawn about the best so far, tried on the whole arm, confirmed by the gate.

It starts from a rule of thumb: k_p + k_v = 98 % of (10i), with damping ratio 0.9 at the largest inertia on
the way. Each round draws gains about the best set, and about the set that has of each joint its best so far.
Counts, not clocks, end it; hundreds of motions at once cost little more than one.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass, replace
from fractions import Fraction
from functools import cached_property
from operator import itemgetter
from typing import NamedTuple

import numpy as np

from lyapcheck._types import Array, Progress, part, silent
from lyapcheck.answers.gate import GateResult, gate
from lyapcheck.answers.gate.stability import LASALLE, SCALAR
from lyapcheck.answers.tune.bench import IN_WORDS, BenchTuning, Candidate
from lyapcheck.answers.tune.targets import arms_over, impossible, limits_with, unknown
from lyapcheck.answers.tune.trial import BY_19, BY_PROOF, Trial, Trials, as_run, tried, tried_all
from lyapcheck.control.gains import Bounds, GainFile, GainSet
from lyapcheck.control.judgement import ACCEPTED
from lyapcheck.control.limits import Limits, limits_of
from lyapcheck.control.sampling import LoopRecord, record_of
from lyapcheck.control.threshold import scaled
from lyapcheck.family.base import named
from lyapcheck.files.loop import NOTHING, LoopEntry
from lyapcheck.robots import ArmLike, RobotModel
from lyapcheck.robots.fields import Vary
from lyapcheck.robots.numeric import NumericModel
from lyapcheck.robots.vary import at_values, corners, outside

SHARE, DAMPING, FLOOR = 0.98, 0.9, 0.05
"""Of (10i), of the first set; the damping ratio of it, and what k_v alone gives every joint at least."""
SPREADS, BETTER, NARROWER = (0.5, 0.02), 0.99, 0.75
"""Of the logarithms of the gains, first and last; narrower where the worst does not come below this share."""
MOST_STEPS = 25_000
"""Of the integrator, all rounds together: an arm that is stiff has fewer rounds."""
BRIEFLY = 0.4
"""So much of the time of `tried` a motion is watched while searching."""
MOTIONS, SETS = 640, (12, 64)
"""Motions of a round, and the fewest and most sets that share them."""
SHARES_OF_DAMPING = (0.5, 0.25, 0.1)
"""Of J/(T (1 + d)), which k_v must stay below in the loop of a computer, one after the other."""
POSTURES = 21
"""On the straight way of each task, for the inertia that a joint feels there."""


class _Try(NamedTuple):
    """Logarithms of gains (n, 2), and what they do."""

    score: tuple[float, float]
    """The worst first; ratios that are close count as the same, so that others may get better."""
    logs: Array
    trial: Trial


@dataclass(eq=False)
class Search:
    """The gains of one member of the family, with one way to show stability.

    Args:
        bench: what is asked.
        models: the arm, nominal first, then at other values of what is uncertain.
        limits: of the arm; torque limits and friction are known.
        m: the member.
        way: ``19`` or ``proof``.
        record: how a computer runs them; without a period at an infinite rate.
    """

    bench: Trials
    models: Sequence[RobotModel]
    limits: Limits
    m: int
    way: str
    record: LoopRecord | None = None

    def __post_init__(self) -> None:
        limits, digits, gamma = self.limits, self.bench.digits, named("hyperbolic", self.m).gamma
        self.unit = Fraction(1, 10**digits)
        self.most_sum = [scaled(room or Fraction(0), 1, gamma).most_units(digits) for room in limits.room]
        self.most_kv = [most - 1 for most in self.most_sum]
        self.by_19 = 0  # what no k_v is
        if self.way == BY_19 and limits.viscous_min is not None:
            self.by_19 = scaled(limits.viscous_min, limits.n, gamma).most_units(digits)
            self.most_kv = [min(most, self.by_19) for most in self.most_kv]

    @property
    def possible(self) -> bool:
        """Whether there are gains at all."""
        return min(self.most_kv) >= 1

    def run(self, progress: Progress = silent) -> Candidate:
        """The best set that was tried; where a computer cannot run it, that with less k_v."""
        if self.record is None or self.record.period is None:
            return self._best(progress)
        for share in SHARES_OF_DAMPING:
            most = share * self._lightest / (float(self.record.period) * (1 + self.record.delay))
            units = np.maximum(most / float(self.unit), 1.0).astype(int).tolist()
            self.most_kv = [min(pair) for pair in zip(self.most_kv, units, strict=True)]
            found = self._best(progress)
            trial = as_run(found.gains, self.models, self.bench, self.record)
            if not trial.unrest:
                break
        return replace(found, trial=trial)

    def _best(self, progress: Progress) -> Candidate:
        """The best set that was tried with (11); the rule of thumb is among them."""
        rng, (few, many), (spread, least) = np.random.default_rng(0), SETS, SPREADS
        count = min(max(MOTIONS // (len(self.bench.tasks) * len(self.models)), few), many)
        combined = self.first()
        tries = self._try([combined, self._damped(combined)])
        best, steps = min(tries, key=itemgetter(0)), 0
        while spread > least and steps < MOST_STEPS:
            about = np.where(np.arange(count)[:, None, None] % 2, best.logs, combined)
            drawn = about + spread * rng.standard_normal(about.shape)
            now = self._try([combined, *drawn[1:]])
            tries += now
            steps += max(one.trial.steps for one in now)
            last, best = best, min(tries, key=itemgetter(0))
            spread *= 1.0 if best.score[0] < BETTER * last.score[0] else NARROWER
            picked = np.argmin([one.trial.by_joint for one in tries], axis=0)
            combined = np.array([tries[k].logs[i] for i, k in enumerate(picked)])
            narrow = math.log(SPREADS[0] / spread) / math.log(SPREADS[0] / least)
            progress(min(max(steps / MOST_STEPS, narrow), 1.0), "")  # a round may take more than is left
        gains = self.set_of(best.logs)
        trial = tried(gains, self.models, self.bench, exact=True)
        return Candidate(gains, trial, self.way, self._held(gains), len(tries))

    def _try(self, logs: Sequence[Array]) -> list[_Try]:
        trials = tried_all([self.set_of(one) for one in logs], self.models, self.bench, BRIEFLY)
        scores = [(round(one.worst, 3), float(np.sum(np.square(one.by_joint)))) for one in trials]
        return [*map(_Try, scores, logs, trials)]

    def first(self) -> Array:
        """The logarithms of k_p and k_v (n, 2) by the rule of thumb."""
        most, J = SHARE * (np.array(self.most_sum) * float(self.unit)), self._inertia
        half = DAMPING * np.sqrt(J)
        root = np.sqrt(half * half + most + self._friction) - half  # of k_p + 2 ζ √(J k_p) = most + b
        kp = np.minimum(root * root, most)
        kv = np.maximum(2 * half * np.sqrt(kp) - self._friction, float(self.unit))
        return np.asarray(np.log(np.stack([kp, kv], axis=1)))

    def _damped(self, logs: Array) -> Array:
        """The same k_v as far as they may be, with k_p small enough for the damping ratio."""
        kp, kv = np.exp(logs).T
        kv = np.minimum(kv, np.array(self.most_kv) * float(self.unit))
        most = ((kv + self._friction) / (2 * DAMPING)) ** 2 / self._inertia
        return np.asarray(np.log(np.stack([np.minimum(kp, most), kv], axis=1)))

    def set_of(self, logs: Array) -> GainSet:
        """Gains as decimals within (10i), and (19) where it is to hold; k_v damps without friction too."""
        kp, kv, unit = [], [], float(self.unit)
        rows = zip(np.exp(logs), self._inertia, self.most_sum, self.most_kv, strict=True)
        for (stiff, damp), J, most, most_kv in rows:
            least = max(1, math.ceil(2 * FLOOR * math.sqrt(J * min(stiff, most * unit)) / unit))
            v = min(max(round(damp / unit), least), most_kv)
            kp.append(min(max(round(stiff / unit), 1), most - v) * self.unit)
            kv.append(v * self.unit)
        name = f"tau_m{self.m}" + ("" if self.way == BY_19 else "_proof")
        return GainSet(name, self.m, tuple(kp), tuple(kv))

    def _held(self, gains: GainSet) -> tuple[str, ...]:
        """Per joint the conditions that keep its gains from being larger."""
        result = []
        for kp, kv, most in zip(gains.kp, gains.kv, self.most_sum, strict=True):
            rules = (("(10i)", kp + kv == most * self.unit), ("(19)", kv == self.by_19 * self.unit))
            result.append(", ".join(rule for rule, reached in rules if reached))
        return tuple(result)

    @cached_property
    def _friction(self) -> Array:
        return np.array([float(b.value) for b in self.models[0].viscous])

    @cached_property
    def _inertia(self) -> Array:
        """(n,) kg·m²: the largest M_ii on the way of the tasks."""
        return np.asarray(np.diagonal(self._mass, axis1=1, axis2=2).max(axis=0))

    @cached_property
    def _lightest(self) -> Array:
        """(n,) kg·m²: the least that a joint feels there while the others are free."""
        return np.asarray(1 / np.diagonal(np.linalg.inv(self._mass), axis1=1, axis2=2).max(axis=0))

    @cached_property
    def _mass(self) -> Array:
        ways = np.vstack([np.linspace(task.q0, task.q_d, POSTURES) for task in self.bench.tasks])
        return NumericModel(self.models[0]).mass(ways)


# --- The best for each member and way to show stability, as the gate accepts them.


CONDITIONS = {BY_19: ("19",), BY_PROOF: (SCALAR, LASALLE)}
"""What shows stability beside (10i), by the way that is asked for; the first that the gate accepts counts."""


def tune_for(
    robot: ArmLike,
    bench: Trials,
    members: Sequence[int] = (1,),
    bounds: Bounds | None = None,
    varies: tuple[Vary, ...] = (),
    loop: LoopEntry = NOTHING,
    on_progress: Progress | None = None,
) -> BenchTuning:
    """The gains that meet what is asked best, for each member and way to show stability.

    Args:
        robot: an arm, its name or the path of its file.
        bench: what is asked, of which motions, and how stability may be shown.
        members: m of each gain set.
        bounds: limits to take instead of the arm's.
        varies: ranges of the arm's numbers; the worst of motions at their ends counts, limits hold for all.
        loop: how a computer runs the gains, before what the arm file says of it.
        on_progress: receives the fraction done.

    Raises:
        InputError: the arm cannot be used.

    Soundness: each set is accepted by the gate, with (10i) and the condition it names. What motions show is
        floating point, and that no better gains exist is not proved.

    References: (6), (10), (11), (19) of reyes2019family.
    """
    model, ranged = arms_over(robot, varies)
    name, limits, given = model.address, limits_with(ranged, bounds), bounds or Bounds()
    given = replace(given, gravity=given.gravity and limits.gravity)
    known = {name: limits_of(ranged)}
    arms, tried_on = _arms(model, ranged)
    arms = tuple(arm.with_motors(given.torque) for arm in arms)  # of whose limits shares are told
    record = record_of(loop, NOTHING, model.loop)
    jobs = [(m, way) for m in dict.fromkeys(members) for way in bench.ways]
    sets: list[Candidate] = []
    reasons = [*unknown(limits), *(text for text in impossible(limits) if "gravity" in text)]
    for done, (m, way) in enumerate([] if reasons else jobs):
        note = f"m = {m}, {IN_WORDS[way]}"
        told = part(on_progress or silent, done / len(jobs), (done + 1) / len(jobs), note)
        search = Search(bench, arms, limits, m, way, record)
        if not search.possible:
            why = "(10i) leaves no room for gains with so few decimal places; raise --digits"
            if way == BY_19:
                why = "(19) admits no k_v with so few decimal places; raise --digits"
            if way == BY_19 and not limits.viscous_min:
                why = "(19) admits no k_v without viscous friction; stability by proof does without it"
            reasons.append(f"m = {m}: {why}")
            continue
        found = search.run(told)
        judged = accepted(found.gains, way, name, given, known, loop)
        gains = judged.gains if judged.verdict == ACCEPTED else found.gains
        sets.append(replace(found, gains=gains, judged=judged))
    missing = tuple(dict.fromkeys((*limits.gravity_notes, *reasons)))
    shown = limits.assumptions, tried_on, given, ranged.varies, loop
    return BenchTuning(name, model, bench, tuple(sets), missing, *shown)


def _arms(model: RobotModel, ranged: RobotModel) -> tuple[tuple[RobotModel, ...], str]:
    """The arms that gains are tried on, and what these are; empty for the arm of the file alone.

    Without ranges: also the ends of what is assumed, all together; viscous friction that is assumed
    without a range may be down to a tenth.
    """
    if not ranged.varies:
        low, high = {}, {}
        for key, number in model.numbers.items():
            if number.assumed and (number.ranged or key.endswith("_viscous")):
                low[key], high[key] = number.bounds if number.ranged else (number.value / 10, number.value)
        arms = [at_values(model, values) for values in (low, high) if values]
        return (model, *arms), "the arm of the file and both ends of its assumed numbers" if arms else ""
    text, tried = corners(ranged)
    ends = tuple(arm for _, arm in tried)
    if outside(model, ranged):
        return ends, f"{text}; the values of the file lie outside"
    return (model, *ends), f"the nominal arm and {text}"


def accepted(
    gains: GainSet,
    way: str,
    robot: str,
    bounds: Bounds | None,
    arms: dict[str, Limits] | None,
    loop: LoopEntry,
) -> GateResult:
    """The set as the gate accepts it, with the conditions by which it does; else as it does not."""
    for condition in CONDITIONS[way]:
        named = replace(gains, condition=("10i", condition))
        file = GainFile("tuned gains", None, (named,), bounds or Bounds(), loop=loop)
        (result,) = gate(file, robot, arms=arms)
        if result.verdict == ACCEPTED:
            break
    return result
