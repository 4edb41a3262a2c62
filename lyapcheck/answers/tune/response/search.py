"""Gains that meet what is asked best: one joint at a time proposes, the whole arm decides, the gate confirms.

The programs of the single joints give a first set; then gains of the joint that is worst are moved as long as
the worst of all motions on the whole arm gets better. Counts, not clocks, end the search.

One joint is an optimal-control program in CasADi.

    J ë + b ė + k_v h(ė) + k_p h(e) = 0,   e(0) = the step,   by the implicit midpoint rule on t = T s

    minimise  ϑ + μ T + ν σ     over k_p, k_v, T, ϑ, σ and the motion
    with      −e/e(0) ≤ ϑ · overshoot;   |e| ≤ 2 % of the step + σ for s ≥ 1;   T ≤ ϑ · settling time
              |k_p h(e) − k_v h(w)| + k_g ≤ ϑ · share · τmax;   k_p h(ϑ · rest error) ≥ f
              k_p + k_v ≤ (10p),   k_v ≤ (19) where that is to hold

Its answer is a proposal: the whole arm is tried with it.
"""

from __future__ import annotations

import math
from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from fractions import Fraction
from typing import TYPE_CHECKING, Any

import casadi as ca
import numpy as np

from lyapcheck._types import Progress, silent
from lyapcheck.answers.tune.response.trial import BY_19, Trial, Trials, Wishes, tried
from lyapcheck.control.conditions import gamma_of
from lyapcheck.control.gains import GainSet
from lyapcheck.control.judgement import dry_friction
from lyapcheck.control.limits import gravity_bounds
from lyapcheck.control.threshold import scaled
from lyapcheck.family import Family, named
from lyapcheck.robots.dynamics import FEW_JOINTS
from lyapcheck.robots.numeric import NumericModel
from lyapcheck.simulate.results import SETTLING_BAND

if TYPE_CHECKING:
    from lyapcheck.control.limits import Limits
    from lyapcheck.robots import RobotModel

STEPS, PER_SETTLING = 240, 100
"""Steps of the rule, and how many of them make T."""
HURRY = 1e-3
"""μ, 1/s: of gains that are as good the quicker ones are taken."""
FAR = 100.0
"""ν: what it costs not to settle."""
LONGEST = 20.0
"""s"""
LEAST = 1e-4
"""N·m"""
OPTIONS: dict[str, Any] = {
    "ipopt.print_level": 0,
    "ipopt.sb": "yes",
    "print_time": False,
    "ipopt.max_iter": 120,
    "ipopt.tol": 1e-6,
}
MOST_TRIES, FEWER_TRIES = 36, 16
"""Sets that are tried for up to three joints, and for more."""
FACTORS = (1.3, 1.14, 1.06, 1.03)
"""By which gains are moved, the next where the one before helps no more."""
POSTURES = 21
"""On the straight way of each task, for the inertia and gravity that a joint feels there."""
Gains = tuple[tuple[float, float], ...]


@dataclass(frozen=True)
class Joint:
    """One joint: ``inertia`` kg·m², ``friction`` N·m·s/rad, ``dry`` and ``gravity`` N·m, ``step`` rad.

    ``torque`` is the motor's limit; ``sum_limit`` and ``kv_limit`` bound k_p + k_v and k_v, N·m.
    """

    inertia: float
    friction: float
    dry: float
    gravity: float
    step: float
    torque: float
    sum_limit: float
    kv_limit: float


def proposal(joint: Joint, family: Family, wishes: Wishes) -> tuple[float, float]:
    """k_p and k_v in N·m; critically damped ones, as far as that goes, where the solver finds none."""
    start = _first(joint)
    step = max(abs(joint.step), math.radians(5.0))
    solver, (lower, upper), (low, high) = _program(joint, family, wishes, step)
    e, w, T = _motion(joint, family, start, step)
    guess = [*np.log(start), math.log(T), 2.0, 0.1, *e[1:], *w[1:]]
    result = np.array(solver(x0=guess, lbx=lower, ubx=upper, lbg=low, ubg=high)["x"]).ravel()
    kp, kv = np.exp(result[:2])  # of an iteration that was cut short as well: the whole arm decides
    return (float(kp), float(kv)) if np.isfinite(kp + kv) else start


def _first(joint: Joint) -> tuple[float, float]:
    kp = 0.5 * joint.sum_limit
    kv = min(
        max(2 * math.sqrt(joint.inertia * kp) - joint.friction, LEAST), joint.kv_limit, 0.4 * joint.sum_limit
    )
    return kp, kv


def _program(joint: Joint, family: Family, wishes: Wishes, step: float) -> tuple[Any, Any, Any]:
    gains, T, theta, slack = (
        ca.SX.sym(name, size) for name, size in (("k", 2), ("T", 1), ("ϑ", 1), ("σ", 1))
    )
    e, w = ca.SX.sym("e", STEPS), ca.SX.sym("w", STEPS)
    kp, kv, time = ca.exp(gains[0]), ca.exp(gains[1]), ca.exp(T)
    before_e, before_w = ca.vertcat(step, e[:-1]), ca.vertcat(0, w[:-1])
    middle_e, middle_w, dt = (before_e + e) / 2, (before_w + w) / 2, time / PER_SETTLING

    def h(x: Any) -> Any:
        return family.casadi(x).h

    torque = kp * h(middle_e) - kv * h(middle_w)
    rows: list[tuple[Any, float, float]] = [
        (e - before_e + dt * middle_w, 0.0, 0.0),
        (joint.inertia * (w - before_w) - dt * (torque - joint.friction * middle_w), 0.0, 0.0),
        (e[PER_SETTLING:] / step - slack, -math.inf, SETTLING_BAND),
        (e[PER_SETTLING:] / step + slack, -SETTLING_BAND, math.inf),
        ((kp + kv) / joint.sum_limit, 0.0, 1.0),
        (kv / joint.kv_limit, 0.0, 1.0),
    ]
    if wishes.overshoot is not None:
        rows.append((-e / step - theta * wishes.overshoot / 100, -math.inf, 0.0))
    if wishes.settle is not None:
        rows.append((time - theta * wishes.settle, -math.inf, 0.0))
    if wishes.peak_share is not None and math.isfinite(joint.torque):
        most = theta * wishes.peak_share * joint.torque - joint.gravity
        rows += [((s * torque - most) / joint.torque, -math.inf, 0.0) for s in (1, -1)]
    if wishes.rest_error is not None and joint.dry:
        held = kp * h(theta * math.radians(wishes.rest_error))
        rows.append((held / joint.dry, 1.0, math.inf))
    x = ca.vertcat(gains, T, theta, slack, e, w)
    nlp = {"x": x, "f": theta + HURRY * time + FAR * slack, "g": ca.vertcat(*(row for row, _, _ in rows))}
    sizes = [row.shape[0] for row, _, _ in rows]
    low, high = (
        np.concatenate([np.full(k, row[j]) for k, row in zip(sizes, rows, strict=True)]) for j in (1, 2)
    )
    edge = [math.log(LEAST), math.log(LEAST), math.log(1e-3), 1e-2, 0.0]
    top = [math.log(joint.sum_limit), math.log(joint.kv_limit), math.log(LONGEST), 1e3, 2.0]
    free = [math.inf] * (2 * STEPS)
    bounds = [*edge, *(-x for x in free)], [*top, *free]
    return ca.nlpsol("tune", "ipopt", nlp, OPTIONS), bounds, (low, high)


def _motion(
    joint: Joint, family: Family, gains: tuple[float, float], step: float
) -> tuple[np.ndarray[Any, Any], np.ndarray[Any, Any], float]:
    """The motion with some gains on the program's grid, T being when it is over."""
    from scipy.integrate import solve_ivp

    kp, kv = gains

    def rate(_: float, y: Any) -> list[float]:
        net_torque = kp * family.h(y[:1])[0] - kv * family.h(y[1:])[0] - joint.friction * y[1]
        return [-y[1], float(net_torque) / joint.inertia]

    T = 2.0
    t = np.arange(STEPS + 1) * T / PER_SETTLING
    y = solve_ivp(rate, (0.0, float(t[-1])), [step, 0.0], "LSODA", t, rtol=1e-6, atol=1e-8).y
    return y[0], y[1], T


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

    def run(self, progress: Progress = silent) -> Found:
        """The best set that was tried."""
        best, score = self._first()
        tries, level, most = 1, 0, MOST_TRIES if self.limits.n <= FEW_JOINTS else FEWER_TRIES
        while tries < most and level < len(FACTORS):
            improved = False
            for moved in self._moves(best, FACTORS[level]):
                tries += 1
                progress(tries / most, "")
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
