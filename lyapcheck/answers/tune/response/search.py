"""Gains that meet what is asked best: one joint at a time proposes, the whole arm decides, the gate confirms.

The programs of the single joints give a first set; then gains of the joint that is worst are moved as long as
the worst of all motions on the whole arm gets better. Counts, not clocks, end the search.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass
from fractions import Fraction
from typing import TYPE_CHECKING

import numpy as np

from lyapcheck.answers.tune.response.one_joint import Joint, proposal
from lyapcheck.answers.tune.response.trial import Trial, tried
from lyapcheck.answers.tune.response.wishes import BY_19, Trials
from lyapcheck.control.arm_limits import gravity_bounds
from lyapcheck.control.conditions import gamma_of
from lyapcheck.control.gains import GainSet
from lyapcheck.control.resting import dry_friction
from lyapcheck.control.threshold import scaled
from lyapcheck.family import named
from lyapcheck.robots.dynamics import FEW_JOINTS
from lyapcheck.robots.numeric import NumericModel

if TYPE_CHECKING:
    from lyapcheck.control.limits import Limits
    from lyapcheck.robots import RobotModel

MOST_TRIES, FEWER_TRIES = 36, 16
"""Sets that are tried for up to three joints, and for more."""
FACTORS = (1.3, 1.14, 1.06, 1.03)
"""By which gains are moved, the next where the one before helps no more."""
POSTURES = 21
"""On the straight way of each task, for the inertia and gravity that a joint feels there."""

Gains = tuple[tuple[float, float], ...]


@dataclass(frozen=True, eq=False)
class Found:
    """A gain set with what it does on the whole arm."""

    gains: GainSet
    trial: Trial
    tries: int


class Search:
    """The gains of one member of the family, with one way to show stability.

    Args:
        bench: what is asked.
        models: the arm, nominal first, then at other values of what is uncertain.
        limits: of the arm; torque limits and friction are known.
        m: the member.
        way: ``19`` or ``proof``.
    """

    def __init__(self, bench: Trials, models: Sequence[RobotModel], limits: Limits, m: int, way: str) -> None:
        self.bench, self.models, self.limits, self.m, self.way = bench, models, limits, m, way
        n, unit = limits.n, Fraction(1, 10**bench.digits)
        ones = (Fraction(1),) * n
        gamma = gamma_of(GainSet("γ", m, ones, ones))
        rows = zip(limits.torque, limits.gravity, strict=True)
        sums = [scaled((torque or Fraction(0)) - gravity, n, gamma) for torque, gravity in rows]
        self.unit = unit
        self.most_sum = [one.most_units(bench.digits) for one in sums]
        self.most_kv = [most - 1 for most in self.most_sum]
        if way == BY_19 and limits.viscous_min is not None:
            by_19 = scaled(limits.viscous_min, n, gamma).most_units(bench.digits)
            self.most_kv = [min(most, by_19) for most in self.most_kv]

    @property
    def possible(self) -> bool:
        """Whether there are gains at all."""
        return min(self.most_kv) >= 1

    def run(self, on_try: Callable[[float], None] = lambda share: None) -> Found:
        """The best set that was tried."""
        best, score = self._first()
        tries, level, most = 1, 0, MOST_TRIES if self.limits.n <= FEW_JOINTS else FEWER_TRIES
        while tries < most and level < len(FACTORS):
            improved = False
            for moved in self._moves(best, FACTORS[level]):
                tries += 1
                on_try(tries / most)
                trial = self._tried(moved)
                if self._score(trial) < score:
                    best, score, improved = Found(self.set_of(moved), trial, tries), self._score(trial), True
                    break
                if tries >= most:
                    break
            level += not improved
        exact = tried(best.gains, self.models, self.bench.tasks, self.bench.wishes, exact=True)
        return Found(best.gains, exact, tries)

    def _first(self) -> tuple[Found, tuple[float, ...]]:
        family = named("hyperbolic", self.m)
        joints = self._joints()
        starts = [
            tuple(proposal(joint, family, self.bench.wishes) for joint in joints),
            tuple((0.9 * joint.sum_limit, min(joint.kv_limit, 0.3 * joint.sum_limit)) for joint in joints),
        ]
        trials = [(start, self._tried(start)) for start in starts]
        start, trial = min(trials, key=lambda each: self._score(each[1]))
        return Found(self.set_of(start), trial, 1), self._score(trial)

    def _moves(self, best: Found, factor: float) -> Iterator[Gains]:
        """The gains with those of one joint moved, worst joints first."""
        wishes = self.bench.wishes
        ratios = np.max(list(best.trial.ratios(wishes).values()), axis=0)
        now = tuple((float(p), float(v)) for p, v in zip(best.gains.kp, best.gains.kv, strict=True))
        for i in np.argsort(-ratios, kind="stable")[: max(2, len(now) // 2)].tolist():
            for up, down in ((1, 0), (0, 1), (-1, 0), (0, -1), (1, 1), (-1, -1)):
                kp, kv = now[i]
                yield (*now[:i], (kp * factor**up, kv * factor**down), *now[i + 1 :])

    def _tried(self, gains: Gains) -> Trial:
        return tried(self.set_of(gains), self.models, self.bench.tasks, self.bench.wishes)

    def _score(self, trial: Trial) -> tuple[float, ...]:
        """The worst first; ratios that are close count as the same, so that others may get better."""
        result = np.max(list(trial.ratios(self.bench.wishes).values()), axis=0)
        return (round(float(np.max(result)), 3), float(np.sum(np.square(result))))

    def set_of(self, gains: Gains) -> GainSet:
        """Gains as decimals within (10p), and (19) where it is to hold."""
        kp, kv = [], []
        for (stiff, damp), most, most_kv in zip(gains, self.most_sum, self.most_kv, strict=True):
            v = min(max(round(damp / float(self.unit)), 1), most_kv)
            p = min(max(round(stiff / float(self.unit)), 1), most - v)
            kp.append(p * self.unit)
            kv.append(v * self.unit)
        name = f"tau_m{self.m}" + ("" if self.way == BY_19 else "_proof")
        return GainSet(name, self.m, tuple(kp), tuple(kv))

    def _joints(self) -> list[Joint]:
        """What each joint feels by itself on the way of the tasks."""
        model, limits = self.models[0], self.limits
        ways = [np.linspace(task.q0, task.q_d, POSTURES) for task in self.bench.tasks]
        mass = np.max(
            [np.diagonal(m, axis1=1, axis2=2) for m in map(NumericModel(model).mass, ways)], axis=(0, 1)
        )
        steps = np.max([np.abs(task.step) for task in self.bench.tasks], axis=0)
        dry = [max(float(f) for f in each) for each in zip(*map(dry_friction, self.models), strict=True)]
        weights, unit = gravity_bounds(model), float(self.unit)
        return [
            Joint(
                inertia=float(mass[i]),
                friction=float(model.viscous[i].value),
                dry=dry[i],
                gravity=float(weights[i]),
                step=float(steps[i]),
                torque=math.inf if torque is None else float(torque),
                sum_limit=self.most_sum[i] * unit,
                kv_limit=self.most_kv[i] * unit,
            )
            for i, torque in enumerate(limits.torque)
        ]
