"""Gains of one joint by itself that meet what is asked best: an optimal-control program in CasADi.

    J ë + b ė + k_v h(ė) + k_p h(e) = 0,   e(0) = the step,   by the implicit midpoint rule on t = T s

    minimise  ϑ + μ T + ν σ     over k_p, k_v, T, ϑ, σ and the motion
    with      −e/e(0) ≤ ϑ · overshoot;   |e| ≤ 2 % of the step + σ for s ≥ 1;   T ≤ ϑ · settling time
              |k_p h(e) − k_v h(w)| + k_g ≤ ϑ · share · τmax;   k_p h(ϑ · rest error) ≥ f
              k_p + k_v ≤ (10p),   k_v ≤ (19) where that is to hold

Its answer is a proposal: the whole arm is tried with it.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Any

import casadi as ca
import numpy as np

from lyapcheck.answers.tune.response.wishes import Wishes
from lyapcheck.family import Family
from lyapcheck.simulate.indices import SETTLING_BAND

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
