"""Gains that meet what is asked best: drawn about the best so far, and tried on the whole arm.

It starts from a rule of thumb: k_p + k_v = 98 % of (10i), with damping ratio 0.9 at the largest inertia on
the way. Each round draws gains about the best set, and about the set that has of each joint its best so far.
Counts, not clocks, end it; hundreds of motions at once cost little more than one.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass
from fractions import Fraction
from functools import cached_property
from typing import TYPE_CHECKING

import numpy as np

from lyapcheck._types import Array, Progress, silent
from lyapcheck.answers.tune.response.trial import BY_19, Trial, Trials, tried, tried_all
from lyapcheck.control.conditions import gamma_of
from lyapcheck.control.gains import GainSet
from lyapcheck.control.threshold import scaled
from lyapcheck.robots.numeric import NumericModel

if TYPE_CHECKING:
    from lyapcheck.control.limits import Limits
    from lyapcheck.robots import RobotModel

SHARE, DAMPING, FLOOR = 0.98, 0.9, 0.05
"""Of (10i), of the first set; the damping ratio of it, and what k_v alone gives every joint at least."""
SPREADS = (0.5, 0.4, 0.3, 0.2, 0.15, 0.1, 0.07, 0.05, 0.03, 0.02)
"""Of the logarithms of the gains, round by round."""
MOTIONS, SETS = 640, (12, 64)
"""Motions of a round, and the fewest and most sets that share them."""
POSTURES = 21
"""On the straight way of each task, for the inertia that a joint feels there."""


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
        sums = [scaled((torque or Fraction(0)) - gravity, 1, gamma) for torque, gravity in rows]
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

    def run(self, progress: Progress = silent) -> Found:
        """The best set that was tried; the rule of thumb is among them."""
        rng, bench = np.random.default_rng(0), self.bench
        few, many = SETS
        count = min(max(MOTIONS // (len(bench.tasks) * len(self.models)), few), many)
        combined = best = self.first()
        tries: list[tuple[tuple[float, ...], Array, Array]] = []
        for k, spread in enumerate(SPREADS):
            about = np.where(np.arange(count)[:, None, None] % 2, best, combined)
            drawn = about + spread * rng.standard_normal(about.shape)
            sets = [combined, *drawn[1:]]
            trials = tried_all(list(map(self.set_of, sets)), self.models, bench)
            ratios = [np.max([*trial.ratios(bench.wishes).values()], axis=0) for trial in trials]
            tries += [(_score(ratio), ratio, logs) for ratio, logs in zip(ratios, sets, strict=True)]
            best = min(tries, key=lambda one: one[0])[2]
            picked = np.argmin([ratio for _, ratio, _ in tries], axis=0)
            combined = np.array([tries[one][2][i] for i, one in enumerate(picked)])
            progress((k + 1) / len(SPREADS), "")
        gains = self.set_of(best)
        return Found(gains, tried(gains, self.models, bench, exact=True), len(tries))

    def first(self) -> Array:
        """The logarithms of k_p and k_v (n, 2) by the rule of thumb."""
        most, J = SHARE * self._largest, self._inertia
        friction = np.array([float(b.value) for b in self.models[0].viscous])
        half = DAMPING * np.sqrt(J)
        root = np.sqrt(half * half + most + friction) - half  # of k_p + 2 ζ √(J k_p) = most + b
        kp = np.minimum(root * root, most)
        return np.asarray(
            np.log(np.stack([kp, np.maximum(2 * half * np.sqrt(kp) - friction, float(self.unit))], axis=1))
        )

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

    @cached_property
    def _largest(self) -> Array:
        return np.array(self.most_sum) * float(self.unit)

    @cached_property
    def _inertia(self) -> Array:
        """(n,) kg·m²: the largest M_ii on the way of the tasks."""
        ways = np.vstack([np.linspace(task.q0, task.q_d, POSTURES) for task in self.bench.tasks])
        mass = NumericModel(self.models[0]).mass(ways)
        return np.asarray(np.diagonal(mass, axis1=1, axis2=2).max(axis=0))


def _score(ratio: Array) -> tuple[float, ...]:
    """The worst first; ratios that are close count as the same, so that others may get better."""
    return (round(float(np.max(ratio)), 3), float(np.sum(np.square(ratio))))
